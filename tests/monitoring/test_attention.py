"""The attention for each person in a game, and tables for researchers, from the log alone."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace
from typing import cast, get_args

import pytest

from tangy_profiles.game_records import GameChange, RecoveryEvent
from tangy_profiles.game_world import LIVE, SIMULATED
from tangy_profiles.staff_records import StaffActionKind
from tangy_profiles.state import FRONT, ActivityState, Situation, UserState
from tangy_tui.app.game_commands import ComesIn, GoesAway
from tangy_tui.app.scripted_staff import scripted_controller
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.policy import Policy
from tangy_tui.monitoring.attention import (
    Attention,
    Wait,
    attention,
    attention_by_game,
    attention_in,
    calls_in,
)
from tangy_tui.monitoring.data_tables import HEAD, TABLES
from tangy_tui.monitoring.fault import Fault, Moved
from tangy_tui.monitoring.games import Game, read_games
from tangy_tui.monitoring.house import (
    RobotLog,
    by_month,
    last_session,
    of_world,
    people_over_time,
    read_log,
)
from tangy_tui.monitoring.replay import Done, GameReplay, Moment, Noted, Unclear
from tangy_tui.pages.house import house_page, person_page
from tangy_tui.text.report import attention_lines, care_lines, waited_words
from tangy_tui.text.staff_actions import action_line, action_words, by_staff
from tests.support.games import play

DICTIONARY = Path(__file__).parents[2] / "docs" / "data-dictionary.md"
BEGUN = datetime(2026, 3, 1, 10, tzinfo=UTC)
LENGTH = 10.0  # s of each step


def asked(*over: float, left: float | None = None) -> list[Wait]:
    """Make requests that are over, and one that is not."""
    return [*map(Wait, over), *([] if left is None else [Wait(left, over=False)])]


def state(place: str, asking: Sequence[str] = (), closed: str | None = None) -> ActivityState:
    users = tuple(UserState(id, "-", "AR" if id in asking else "ANR") for id in ("ann", "bob"))
    return ActivityState(0, Situation("-", "ANR", "-"), place, None, users, closed)


def game(**given: object) -> Game:
    one = Game(
        1, "g1", 1, BEGUN, "a", "p", "d", ("ann", "bob"), 0, 0, 0, BEGUN + timedelta(minutes=9),
        9, None,
    )  # fmt: skip
    return replace(one, **given)  # type: ignore[arg-type]


def replay_of(*states: ActivityState, behaviour: str = "b", target: str = "") -> GameReplay:
    """Make a game of ten-second steps from state to state."""
    found = GameReplay(game())
    for number, (before, after) in enumerate(pairwise(states), 1):
        begun = found.seconds
        found.seconds += LENGTH
        done = Done(
            number, begun, found.seconds, before, after, behaviour, target or None, "", True, True,
            "", "", False,
        )  # fmt: skip
        found.moments.append(Moment(found.seconds, number, BEGUN.isoformat(), done))
    return found


ASKS, REST = state(FRONT, ["ann"]), state(FRONT)


@pytest.mark.parametrize(("plays_on", "won"), [(False, 1), (True, 2)])
def test_a_win_that_is_celebrated_again_counts_once(plays_on: bool, won: int) -> None:
    replay = replay_of(*(state(place) for place in ("ann", "ann", "bob", "bob", "ann", "ann")))
    moments = list[Moment]()
    for moment in replay.moments:
        assert isinstance(moment.what, Done)
        moments.append(replace(moment, what=replace(moment.what, wins=moment.what.number % 2 == 1)))
        if plays_on and moment.what.number == 3:
            change = GameChange(game="g1", steps=3, what="played on", person="bob", by="tangy")
            moments.append(replace(moment, what=change))
    ann, bob = attention_in(replace(replay, moments=moments)).values()
    assert (ann.won, bob.won) == (won, 1)


def test_a_request_during_a_step_is_counted() -> None:
    replay = replay_of(state(FRONT), state(FRONT), state("ann", ["ann"]))
    asking = replace(replay.done[1], state=state(FRONT, ["ann"]))
    moments = [replace(m, what=asking) if m.what is replay.done[1] else m for m in replay.moments]
    ann = attention_in(replace(replay, moments=moments))["ann"]
    assert (ann.requests, ann.waits, ann.visits) == (1, [LENGTH], 1)
    unasked = attention_in(replace(replay, moments=moments, unasked={(2, "ann")}))["ann"]
    assert (unasked.requests, unasked.visits) == (0, 1)


def test_a_wait_is_counted_from_when_the_person_asked_if_the_log_has_it() -> None:
    replay = replay_of(REST, ASKS, REST, ASKS, ASKS)
    moments = [
        replace(m, what=replace(m.what, since={"ann": since}))
        for m, since in zip(replay.moments, (4.0, 0.0, 4.0, 4.0), strict=True)
        if isinstance(m.what, Done)
    ]
    ann = attention_in(replace(replay, moments=moments))["ann"]
    assert ann.asked == asked(16.0, left=20.0), "a request anew is not older than its step"


def test_a_wait_ends_on_the_arrival_of_the_robot() -> None:
    replay = replay_of(
        state(FRONT), state(FRONT, ["ann"]), state(FRONT, ["ann"]), state("ann", ["ann"]),
        state(FRONT),
    )  # fmt: skip
    ann, bob = attention_in(replay).values()
    assert (ann.waits, ann.open, ann.visits, ann.last_visit) == ([20.0], [], 1, 30.0)
    assert (bob.requests, bob.visits, bob.waits) == (0, 0, [])


def test_an_unvisited_person_waits_to_the_end() -> None:
    replay = replay_of(state(FRONT), state(FRONT, ["bob"]), state(FRONT, ["bob"]))
    bob = attention_in(replay)["bob"]
    assert (bob.waits, bob.open) == ([], [10.0])


def test_calls_first_does_not_interrupt_a_wait() -> None:
    replay = replay_of(
        state(FRONT), state(FRONT, ["bob"]), state(FRONT), state(FRONT, ["bob"]),
        state("bob", ["bob"]),
    )  # fmt: skip
    before = attention_in(replay)["bob"]
    assert (before.requests, before.waits) == (2, [10.0, 10.0])  # a request anew
    first = GameChange(game="g1", what="calls first", steps=1, number=2)
    moments = [
        replace(m, what=replace(m.what, draws=True)) if isinstance(m.what, Done) else m
        for m in replay.moments
    ]
    moments.insert(1, Moment(LENGTH, 1, BEGUN.isoformat(), first))
    bob = attention_in(replace(replay, moments=moments))["bob"]
    assert (bob.requests, bob.waits, bob.open) == (1, [30.0], [])


def changed(replay: GameReplay, after: int, **given: object) -> GameReplay:
    """Return a game with a change after a step; all its steps are calls."""
    moments = list[Moment]()
    for moment in replay.moments:
        assert isinstance(moment.what, Done)
        moments.append(replace(moment, what=replace(moment.what, draws=True)))
    change = GameChange(game="g1", steps=after, **given)  # type: ignore[arg-type]
    moments.insert(after, Moment(after * LENGTH, after, BEGUN.isoformat(), change))
    return replace(replay, moments=moments)


def test_a_winner_no_longer_waits_when_calls_come_first_afterwards() -> None:
    celebrated = state("ann", ["ann"])
    replay = replay_of(
        state(FRONT), state(FRONT, ["ann"]), celebrated, celebrated, state(FRONT), state(FRONT)
    )
    replay = changed(replay, 3, what="played on", person="ann")
    first = GameChange(game="g1", what="calls first", steps=3, number=4)
    replay.moments.insert(4, Moment(30.0, 3, BEGUN.isoformat(), first))
    ann = attention_in(replay)["ann"]
    assert (ann.waits, ann.open, ann.visits) == ([10.0], [], 1)


def test_a_claim_by_staff_is_no_request_even_if_the_first_drive_fails() -> None:
    replay = replay_of(
        state(FRONT), state(FRONT), state(FRONT, ["ann"]), state("ann", ["ann"]),
        state("ann", ["ann"]),
    )  # fmt: skip
    replay = changed(replay, 1, what="claimed", person="ann", by="Nina")
    asked = attention_in(replay)["ann"]
    replay.unasked.add((2, "ann"))
    claimed = attention_in(replay)["ann"]
    assert (asked.requests, claimed.requests, claimed.visits) == (1, 0, 1)


def test_the_summary_lists_waits_longest_first() -> None:
    ann = Attention("Ann", asked(20.0, 400.0), visits=2, seconds=30.0, won=1)
    bob, cy = Attention("Bob", asked(left=60.0)), Attention("Cy", asked(30.0, left=120.0), visits=1)
    assert attention_lines([ann, bob, cy], str) == [
        "Asked for help:",
        "  Ann twice, waited: 20 s, then 7 min; 2 visits, 30 s in all",
        "  Bob once, waited: 1 min (not reached); never visited",
        "  Cy twice, waited: 30 s, then 2 min (not reached); 1 visit, 0 s in all",
    ]
    assert care_lines([bob, ann, cy], str) == [
        "Tangy never went to Bob.",
        "Still waiting at the end: Cy, 2 min; Bob, 1 min.",
        "Waited long for help: Ann, 7 min.",
    ]


def test_only_who_waits_at_the_end_of_the_session_is_told_as_still_waiting() -> None:
    asking = state(FRONT, ["ann"])
    waits = replay_of(state(FRONT), asking, asking, asking)
    fine = replay_of(state(FRONT), state(FRONT), state("bob", ["bob"]))

    def told(*replays: GameReplay) -> list[str]:
        found = attention(replays).values()
        return [line for line in care_lines(found, str, replays) if "never" not in line]

    assert told(fine, waits) == ["Still waiting at the end: ann, 20 s."]
    vain = "Asked in an earlier game, and Tangy did not come: ann"
    assert told(waits, fine) == told(waits, fine, fine) == [f"{vain}, 20 s."]
    long = replace(waits, seconds=500.0)
    assert told(long, fine) == [f"{vain}, 8 min."]
    came = replay_of(state(FRONT), state(FRONT), state("ann", ["ann"]))
    assert told(waits, came) == []
    assert told(long, came, fine) == ["Waited long for help: ann, 8 min."]


def live(replay: GameReplay, begins: float) -> GameReplay:
    """Return a game of real people that begins some s after 10:00."""
    at = BEGUN + timedelta(seconds=begins)
    ended = at + timedelta(seconds=replay.seconds)
    return replace(replay, game=game(id=f"g{begins:g}", at=at, ended=ended, world=LIVE))


def test_a_request_that_goes_over_into_the_next_game_is_one_wait() -> None:
    first = live(replay_of(REST, ASKS, ASKS, ASKS), 0.0)  # since 10 s
    second = live(replay_of(REST, ASKS, ASKS), 60.0)
    third = live(replay_of(ASKS, ASKS, state("ann", ["ann"]), REST, ASKS, ASKS), 100.0)
    assert attention([first, second])["ann"].asked == asked(left=70.0)
    came = attention([first, second, third])["ann"]
    assert came.asked == asked(110.0, left=10.0)
    assert waited_words(came) == "2 min, then 10 s (not reached)"
    told = care_lines([came], str, [first, second, third])
    assert told == ["Still waiting at the end: ann, 10 s."]
    each = [found["ann"] for found in attention_by_game([first, second, third])]
    assert [one.requests for one in each] == [0, 0, 2]
    assert [one.spans for one in each] == [
        [(10.0, 30.0)],
        [(0.0, 20.0)],
        [(0.0, 20.0), (40.0, 50.0)],
    ]
    log = RobotLog("r", "r", (first, second, third), {}, frozenset(), {})
    (table,) = (one for one in TABLES if one.name == "people")
    rows = [row for row in table.of([log]) if row["person"] == "ann"]
    assert [(row["requests"], row["waits"], row["open_waits"]) for row in rows] == [
        (0, "", ""), (0, "", ""), (2, "110.0", "10.0"),
    ]  # fmt: skip
    (ann,) = (one for one in people_over_time(of_world([log], LIVE)) if one.name == "ann")
    assert ann.sum.asked == came.asked


def test_a_request_goes_over_only_if_the_person_still_asks_soon_after_it() -> None:
    first = live(replay_of(REST, ASKS, ASKS), 0.0)
    lowered = live(replay_of(REST, REST, ASKS, ASKS), 60.0)
    assert attention([first, lowered])["ann"].asked == [Wait(10.0, over=False)] * 2
    later = live(replay_of(REST, ASKS, ASKS), 7200.0)
    assert attention([first, later])["ann"].asked == [Wait(10.0, over=False)] * 2
    apart = [replace(one, game=replace(one.game, world=SIMULATED)) for one in (first, lowered)]
    assert attention(apart)["ann"].requests == 2


def test_waits_that_are_told_alike_are_looked_after_alike() -> None:
    emil, hugo = (Attention(who, asked(wait), visits=1) for who, wait in (("E", 301), ("H", 271)))
    ida = Attention("I", asked(269.0), visits=1)
    assert care_lines([emil, hugo, ida], str) == ["Waited long for help: E and H, 5 min."]


def test_who_asks_as_the_game_ends_is_not_told_as_waiting() -> None:
    ann = Attention("Ann", asked(30.0, left=0.2), visits=1, seconds=5.0)
    assert care_lines([ann], str) == []
    told = attention_lines([ann], str)[-1]
    assert told.endswith("waited: 30 s, then asked as the game ended; 1 visit, 5 s in all")


def test_what_to_look_after_names_a_few_of_many_people_and_counts_the_others() -> None:
    never = [Attention(f"N{n}") for n in range(19)]
    waiting = [Attention(f"W{n}", asked(left=600.0 - 60 * (n // 2)), visits=1) for n in range(9)]
    first, second = care_lines([*never, *waiting], str)
    assert first == "Tangy never went to N0, N1, N2, N3, N4 and 14 others."
    assert second == (
        "Still waiting at the end: W0 and W1, 10 min; W2 and W3, 9 min; W4, 8 min; 4 others."
    )
    assert attention_lines(never, str) == [f"Never visited: {', '.join(one.id for one in never)}."]


def test_a_request_closed_from_the_front_is_no_visit() -> None:
    replay = replay_of(state(FRONT), state(FRONT, ["ann"]), state(FRONT))
    ann = attention_in(replay)["ann"]
    assert (ann.waits, ann.visits) == ([10.0], 0)


def test_a_repeated_request_starts_a_new_wait() -> None:
    replay = replay_of(
        state(FRONT, ["ann"]), state("ann", ["ann"]), state("ann", [], "ann"), state(FRONT),
        state(FRONT, ["ann"]), state("ann", ["ann"]),
    )  # fmt: skip
    ann = attention_in(replay)["ann"]
    assert (len(ann.waits), ann.visits) == (1, 2)


def test_the_drive_to_a_person_is_not_visit_time() -> None:
    there = state("ann", ["ann"])
    replay = replay_of(state(FRONT), there, there, there, state(FRONT), target="ann")
    ann = attention_in(replay)["ann"]
    assert (ann.seconds, ann.helped) == (20.0, {"b": 2})


def test_absent_people_are_not_listed_as_unvisited() -> None:
    replay = replay_of(state(FRONT), state(FRONT, ["ann"]), state("ann", ["ann"]))
    replay.game = game(away=frozenset(("ann", "bob")))
    assert list(attention_in(replay)) == ["ann"], "she was there after all"


def test_the_log_lists_absent_people_of_a_game(workspace: Workspace, learnt: Policy) -> None:
    run = scripted_controller(workspace.supervision(learnt, 5))
    run.apply(GoesAway("user1"))
    run.apply(GoesAway("user2"))
    run.begin()
    run.apply(ComesIn("user1"))
    run.apply(GoesAway("user3"))
    (begun,) = read_games(workspace.store)
    assert begun.away == {"user2"}


def test_what_tangy_hears_is_not_told_as_done_by_staff() -> None:
    rosa = {"user1": "Rosa"}.__getitem__
    heard = Noted("heard", "Ada", person="user1", detail="honey")
    assert action_line(heard, rosa) == "Tangy heard from Rosa: honey."
    told = Noted("told", "Ada", person="user1", detail="honey")
    assert action_line(told, rosa).startswith("Ada told Tangy about Rosa")
    asks = Noted("asked for", "Ada", person="user1")
    assert action_line(asks, rosa) == "Ada asked Tangy to go to Rosa."


@pytest.mark.parametrize("did", get_args(StaffActionKind))
def test_every_action_of_staff_is_a_sentence_about_them(did: StaffActionKind) -> None:
    rosa = {"user1": "Rosa"}.__getitem__
    noted = Noted(did, "Ada", person="user1", detail="7")
    assert action_line(noted, rosa).startswith("Ada ") is by_staff(noted)
    assert not action_line(replace(noted, by=""), rosa).startswith("Ada")
    assert ", by" not in action_line(noted, rosa)


def test_what_the_program_notes_of_itself_is_not_told_as_done_by_staff() -> None:
    assert not by_staff(Noted("robot frozen", "Ada", detail="3.0"))
    assert not by_staff(Noted("card learnt", "tangy", person="user1", detail="7"))


def test_names_replace_ids_next_to_any_punctuation() -> None:
    told = Noted("told", "Ada", person="user1", detail="tired")
    assert action_words(told, {"user1": "Rosa"}.__getitem__) == "Tangy was told about Rosa: tired"
    older = Noted("noted", "Ada", detail="staff told of user1: tired; xuser1 is nobody")
    said = action_words(older, lambda person: {"user1": "Rosa"}.get(person, person))
    assert said == "staff told of Rosa: tired; xuser1 is nobody"


def test_attention_of_several_games_adds_up() -> None:
    one = Attention("ann", asked(1.0), visits=1, seconds=2.0, last_visit=3.0)
    one.add(Attention("ann", asked(left=9.0), visits=2, seconds=3.0, won=1))
    assert (one.requests, one.open, one.visits, one.seconds) == (2, [9.0], 3, 5.0)
    assert (one.won, one.last_visit) == (1, 3.0)


def test_a_call_that_was_taken_back_stays_marked_in_the_list() -> None:
    replay = GameReplay(game())
    for number in (7, 8, 7):
        done = Done(
            1, 0.0, 1.0, state(FRONT), state(FRONT), "b", None, "", True, True, "", "", True,
            (number,),
        )  # fmt: skip
        replay.moments.append(Moment(1.0, 1, "", done))
    replay.moments.append(Moment(1.0, 1, "", Noted("took back", "Ada", taken_back=7)))
    assert [(c.number, c.taken_back) for c in calls_in(replay)] == [
        (7, False), (8, False), (7, True),
    ]  # fmt: skip


def test_a_session_is_the_last_games_of_one_world_without_a_long_pause() -> None:
    games = [
        game(id="long ago", at=BEGUN - timedelta(hours=5), ended=BEGUN - timedelta(hours=4)),
        game(id="first", at=BEGUN),
        game(id="second", at=BEGUN + timedelta(minutes=20), ended=None),
    ]
    assert [one.id for one in last_session(games)] == ["first", "second"]
    live = game(id="other", world="live", at=BEGUN + timedelta(minutes=21))
    assert [one.id for one in last_session([*games, live])] == ["other"]
    assert last_session([]) == []


@pytest.fixture
def data_folder(taught: Path) -> Path:
    """A folder with three demonstrations and a policy learnt from them."""
    return taught


@pytest.fixture
def played(workspace: Workspace, learnt: Policy) -> Workspace:
    """Two games, one with a fault, and a person with a name."""
    with workspace.store.transaction():
        play(workspace.supervision(learnt, 1, asks=True))
        play(workspace.supervision(learnt, 2, asks=True, injections=["arm-failed@9"]))
        workspace.store.rename("user1", "Rosa")
    return workspace


def test_every_column_of_the_tables_is_in_the_dictionary(played: Workspace) -> None:
    text = DICTIONARY.read_text(encoding="utf-8")
    log = read_log(played.store, {}, {"bingo": played.activity})
    for table in TABLES:
        section = text if table.name not in text else text[text.index(f"## {table.name}:") :]
        known = set(re.findall(r"`(\w+)`", section.split("\n## ")[0])) | set(HEAD)
        assert set(table.columns) <= known, table.name
        rows = list(table.of([log]))
        assert rows, table.name
        assert all(set(row) == set(table.columns) for row in rows)
        assert {row["world"] for row in rows} == {"simulated"}


def test_the_tables_contain_no_names(played: Workspace) -> None:
    log = read_log(played.store, {}, {"bingo": played.activity})
    rows = [row for table in TABLES for row in table.of([log])]
    assert not [row for row in rows if "Rosa" in map(str, row.values())]


def test_the_tables_match_the_log(played: Workspace) -> None:
    log = read_log(played.store, {}, {"bingo": played.activity})
    of = {table.name: list(table.of([log])) for table in TABLES}
    assert len(of["games"]) == 2
    assert len(of["people"]) == 2 * len(played.people)
    assert len(of["steps"]) == sum(game.steps for game in read_games(played.store))
    assert len(of["responses"]) == sum(int(row["asked"] or 0) for row in of["people"])


def test_equal_names_in_two_logs_are_one_person(
    played: Workspace,
) -> None:
    log = read_log(played.store, {"user2": "User 2"}, {"bingo": played.activity})
    other = replace(log, robot="another", label="another")
    people = people_over_time(of_world([log, other], "simulated"))
    games = {person.name: len(person.games) for person in people if person.name == "Rosa"}
    assert games == {"Rosa": 4}
    assert [len(p.games) for p in people if p.name == "User 2"] == [2, 2]


def test_the_pages_name_their_world_and_the_excluded_games(played: Workspace) -> None:
    log = read_log(played.store, {}, {"bingo": played.activity})
    people = people_over_time(of_world([log], "simulated"))
    page = house_page([log], "simulated", people, ["live"])
    assert "simulated" in page and "--world live" in page and "Rosa" in page
    rosa = next(person for person in people if person.name == "Rosa")
    assert "simulated" in person_page(rosa, [log], "simulated", [])
    (month,) = by_month(of_world([log], "simulated"))
    assert len(month.games) == 2


def test_the_staff_table_has_all_columns_for_every_action(played: Workspace) -> None:
    log = read_log(played.store, {}, {"bingo": played.activity})
    fault = cast(Fault, SimpleNamespace(id="f1"))
    whats = (
        Noted("paused", "Ada"),
        Unclear("user2", asked_again=True),
        Moved(fault, RecoveryEvent("cleared", 3.0, by="Ada")),
    )
    moments = [Moment(1.0, 1, "2026-03-02T09:00:00+00:00", what) for what in whats]
    table = next(one for one in TABLES if one.name == "staff")
    rows = list(table.of([replace(log, replays=(replace(log.replays[0], moments=moments),))]))
    assert [(row["kind"], row["person"]) for row in rows] == [
        ("note", None),
        ("unclear", "user2"),
        ("move", None),
    ]
    assert all(set(row) == set(table.columns) for row in rows)


@pytest.mark.parametrize("away", [True, False])
def test_a_request_goes_over_into_a_game_without_steps_only_for_who_is_there(away: bool) -> None:
    first, empty = live(replay_of(REST, ASKS, ASKS), 0.0), live(replay_of(REST), 60.0)
    if away:
        empty = replace(empty, game=replace(empty.game, away=frozenset({"ann"})))
    before, then = (
        found.get("ann", Attention("ann")) for found in attention_by_game([first, empty])
    )
    assert (before.requests, then.requests) == ((1, 0) if away else (0, 1))


def test_a_request_that_ends_in_the_first_step_of_the_next_game_goes_over() -> None:
    first, then = live(replay_of(REST, ASKS, ASKS), 0.0), live(replay_of(ASKS, REST, REST), 60.0)
    assert [wait.over for wait in attention([first, then])["ann"].asked] == [True]


def test_a_request_goes_over_to_nobody_who_does_not_play_any_more() -> None:
    first, then = live(replay_of(REST, ASKS, ASKS), 0.0), live(replay_of(ASKS, ASKS), 60.0)
    then = replace(then, game=replace(then.game, people=("bob",)))
    before, after = attention_by_game([first, then])
    assert before["ann"].asked == [Wait(10.0, over=False)] and "ann" not in after


@pytest.mark.parametrize("states", [(REST, ASKS, ASKS), (REST, state("ann"), REST)])
def test_who_was_away_is_listed_if_they_asked_or_were_visited(
    states: tuple[ActivityState, ...],
) -> None:
    replay = replay_of(*states)
    replay.game = game(away=frozenset(("ann", "bob")))
    assert list(attention_in(replay)) == ["ann"]
