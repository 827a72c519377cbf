"""Games by a plan of staff: patterns in turn, claims, pace, visits, arrivals and departures."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from tangy_profiles.game_records import GameChange, GameStep
from tangy_profiles.game_rules import GamePlan
from tangy_profiles.past_game import interrupted_game
from tangy_profiles.planned_game import PlannedGame
from tangy_profiles.staff_records import StaffAction
from tangy_profiles.state import FRONT
from tangy_profiles.tracker import Tracker
from tangy_sim.worlds.world import SimulatedWorld
from tangy_tui.app.game_commands import (
    ChangePace,
    ChoosePatterns,
    ClaimCard,
    ComesIn,
    GoesAway,
    LetWin,
    SetPace,
    TakeBackCall,
)
from tangy_tui.app.scripted_staff import go_on_by_script, scripted_controller
from tangy_tui.app.staff_notes import StaffNote
from tangy_tui.app.staff_view import StaffWatch
from tangy_tui.console.inquiries import Inquiries
from tangy_tui.interaction.game_events import Acted, GameChanged, GameEnded
from tangy_tui.monitoring.games import read_games
from tangy_tui.monitoring.session import read_session
from tangy_tui.pages.session import session_page
from tangy_tui.text.changes import changed_words
from tangy_tui.text.control import noted_words
from tangy_tui.text.log import moment_lines, replay_lines, session_lines
from tangy_tui.text.report import changes_lines
from tangy_tui.text.staff_report import staff_rows
from tangy_tui.text.whose_turn import why_now_lines
from tangy_tui.ui.screens.play_view import ViewSource, next_line
from tests.support.planned_games import Planned


def test_a_game_continues_for_each_chosen_pattern(planned: Planned) -> None:
    planned.begin(GamePlan(("line", "two lines", "full card")))
    planned.play()
    ended = planned.events[-1]
    assert isinstance(ended, GameEnded) and ended.stopped is None
    assert planned.changes().count("played on") == 2 and len(planned.celebrated()) == 3
    assert len(planned.world.called_now) > 55  # no card is full much earlier
    assert planned.supervision.faults == []


def test_each_of_several_winners_is_celebrated(planned: Planned) -> None:
    planned.begin(GamePlan(several=True))
    winners = planned.win_twice()
    planned.play()
    assert planned.celebrated()[:2] == [*winners] and planned.supervision.faults == []
    assert planned.changes()[0] == "others first"


def test_a_claim_is_checked_against_the_called_numbers(planned: Planned) -> None:
    planned.begin(GamePlan())
    planned.play(calls=3)
    assert planned.do(ClaimCard(2)) == ["claim wrong"] and planned.do(ClaimCard(5)) == [
        "no such card"
    ]
    planned.begin(GamePlan(("full card",)))
    planned.play(calls=20)
    world = planned.world
    (note,) = planned.control.apply(ChoosePatterns(("line",)))
    assert isinstance(note, StaffNote)
    assert note.about == "the full card, then a line"
    card = world.players["user3"].numbers
    calls = len(world.scene().called)
    world.order[:calls] = [*card[:5], *world.order[5:calls]]
    world.patterns.advance()
    assert planned.do(ClaimCard(3)) == ["claim right", "claimed"]
    planned.play()
    assert planned.celebrated()[-1] == "user3"


@pytest.mark.parametrize(("several", "told"), [(False, "claim late"), (True, "claim right")])
def test_a_second_right_claim_is_late_unless_several_may_win(
    planned: Planned, several: bool, told: str
) -> None:
    planned.begin(GamePlan(("full card",), several=several))
    planned.play(calls=20)
    planned.control.apply(ChoosePatterns(("line",)))
    world = planned.world
    first, second = world.players["user3"].numbers[:5], world.players["user4"].numbers[:5]
    called = tuple(dict.fromkeys((*first, *second)))
    world.order[: len(called)] = called
    world.patterns.advance()
    assert planned.do(ClaimCard(3)) == ["claim right", "claimed"]
    assert planned.do(ClaimCard(4))[0] == told
    assert world.vouched == {"user3", *(("user4",) if several else ())}
    planned.play()
    assert "user3" in planned.celebrated() and ("user4" in planned.celebrated()) is several


def test_after_a_win_staff_read_that_the_game_goes_on(planned: Planned) -> None:
    planned.begin(GamePlan(("line", "full card")))
    while not planned.world.tracker.finished:
        planned.events += go_on_by_script(planned.control, expert=True)
    line = next_line(ViewSource(planned.world, planned.control, str))
    assert planned.world.patterns.left[0].label in line
    assert planned.world.activity.behaviours["valediction"].question not in line
    assert line in why_now_lines(planned.control, str)


def test_cards_in_play_are_those_of_people_who_are_here(planned: Planned) -> None:
    planned.begin(GamePlan())
    planned.play(calls=3)
    planned.do(GoesAway("user2"))
    (note,) = planned.control.apply(ClaimCard(99))
    assert isinstance(note, StaffNote) and note.words == "1, 3, 4"


def test_a_win_is_told_to_nobody_before_it_is_known_whose_it_is(
    planned: Planned, monkeypatch: pytest.MonkeyPatch
) -> None:
    planned.begin(GamePlan())
    planned.play(calls=3)
    said = list[str]()
    monkeypatch.setattr(SimulatedWorld, "known_cards", {"user1": 1})
    numbers = planned.world.players["user3"].numbers
    monkeypatch.setattr(SimulatedWorld, "numbers_on", lambda self, card: numbers)
    monkeypatch.setattr(SimulatedWorld, "holder", lambda self, card: "")
    monkeypatch.setattr(SimulatedWorld, "announce", lambda self, words: said.append(words))
    assert planned.do(ClaimCard(3)) == ["claim wrong"] and len(said) == 1
    monkeypatch.setattr(SimulatedWorld, "wins", lambda self, card: True)
    assert planned.do(ClaimCard(3)) == ["whose card"] and len(said) == 1
    assert planned.do(ClaimCard(3, "user3")) == ["claim right", "claimed"] and len(said) == 2


def test_those_who_may_hold_a_card_are_here_and_have_none(
    planned: Planned, monkeypatch: pytest.MonkeyPatch
) -> None:
    planned.begin(GamePlan())
    planned.play(calls=3)
    planned.do(GoesAway("user2"))
    assert planned.control.plan.may_hold(ClaimCard(3)) == ()  # it is known whose it is
    on = {3: planned.world.numbers_on(3)}.get  # as on the robot, which has to learn cards
    monkeypatch.setattr(SimulatedWorld, "numbers_on", lambda world, card: on(card))
    monkeypatch.setattr(SimulatedWorld, "known_cards", {"user1": 1})
    monkeypatch.setattr(SimulatedWorld, "holder", lambda world, card: "")
    assert planned.control.plan.may_hold(ClaimCard(3)) == ("user3", "user4")
    assert planned.control.plan.may_hold(ClaimCard(3, "user3")) == ()
    assert planned.control.plan.may_hold(ClaimCard(99)) == ()
    monkeypatch.setattr(SimulatedWorld, "known_cards", dict.fromkeys(planned.world.people, 1))
    assert planned.control.plan.may_hold(ClaimCard(3)) == ("user1", "user3", "user4")


@pytest.mark.parametrize("plan", [(), ("line",)])
def test_the_pattern_being_played_does_not_follow_itself(
    planned: Planned, plan: tuple[str, ...]
) -> None:
    planned.begin(GamePlan(plan))
    planned.play(calls=2)
    (note,) = planned.control.apply(ChoosePatterns(("line", "two lines")))
    assert isinstance(note, StaffNote) and note.about == "a line, then two lines"
    planned.do(ChoosePatterns(("line", "two lines")))
    assert [one.name for one in planned.world.patterns.left] == ["two lines"]


def test_what_is_played_now_stays_the_first_wherever_it_is_named(planned: Planned) -> None:
    planned.begin(GamePlan(("full card",)))
    planned.play(calls=2)
    chosen = planned.control.apply(ChoosePatterns(("two lines", "full card")))
    assert chosen == [StaffNote("patterns", "the full card, then two lines", "the full card")]
    assert [one.name for one in planned.world.patterns.left] == ["two lines"]
    chosen = planned.control.apply(ChoosePatterns(("full card", "line")))
    assert chosen == [StaffNote("patterns", "the full card, then a line")]


def test_actions_of_staff_are_reported_with_names_and_pace(planned: Planned) -> None:
    planned.begin(GamePlan())
    planned.play(calls=2)
    for _ in range(3):
        planned.do(ChangePace(-1))
    planned.control.note("asked for", person="user3")
    store = planned.workspace.store
    (replay,) = read_session(store, read_games(store), {}, {}).replays

    def name(person: str) -> str:
        return "Rosa" if person == "user3" else person

    pace = f"set the pace to a call every {planned.world.pace:g} s"
    assert [what for _, _, what in staff_rows([replay], name)] == [
        pace, "asked Tangy to go to Rosa"
    ]  # fmt: skip
    (told,) = moment_lines(replay.moments[-1], True, None, name)
    assert told.casefold().endswith(f"{planned.control.by} asked tangy to go to rosa.")


def test_only_the_log_names_ways_of_asking(planned: Planned) -> None:
    planned.begin(GamePlan())
    planned.play(calls=12)
    store, activity = planned.workspace.store, planned.workspace.activity
    (replay,) = read_session(store, read_games(store), {activity.name: activity}, {}).replays
    told = [line for moment in replay.moments for line in moment_lines(moment, True, activity, str)]
    asked = tuple(f"with {way}" for way in activity.strategies)
    assert any("did it" in line for line in told)
    assert not any(f"({way})" in line for line in told for way in activity.strategies)
    assert not any(way in line for line in told for way in asked)
    logged = "\n".join(replay_lines(replay, activity, str))
    assert any(way in logged for way in asked)


def test_staff_read_what_the_group_hears_about_a_claim(
    planned: Planned, monkeypatch: pytest.MonkeyPatch
) -> None:
    heard = list[str]()
    planned.begin(GamePlan())
    planned.play(calls=4)
    monkeypatch.setattr(planned.world, "announce", heard.append)
    (note,) = planned.control.apply(ClaimCard(2))
    assert isinstance(note, StaffNote) and heard == [note.words]
    assert note.words in noted_words(note, str)


def test_help_has_the_word_that_people_call_out(planned: Planned) -> None:
    planned.begin(GamePlan())
    lines = Inquiries(planned.control, str, None, str).lines("help") or []
    claim = planned.workspace.activity.rules.claim
    (line,) = [line for line in lines if line.startswith(f"  {claim} 17: checks card 17")]
    assert f"; {claim} 17 NAME says" in line


def test_staff_read_who_is_here(planned: Planned) -> None:
    planned.begin(GamePlan(absent=("user2",)))
    lines = Inquiries(planned.control, {"user2": "Emil"}.get, None, str).lines("who is here") or []  # type: ignore[arg-type]
    assert len(lines) == 4 and lines[1].startswith("2. Emil: not here")


def test_staff_read_whose_card_is_whose(planned: Planned) -> None:
    planned.begin(GamePlan())
    name = {"user2": "Emil"}.get
    lines = Inquiries(planned.control, lambda who: name(who, who), None, str).lines("cards")
    assert lines == ["user1 has card 1, Emil has card 2, user3 has card 3, user4 has card 4."]


def test_a_call_that_is_taken_back_returns_and_is_announced(planned: Planned) -> None:
    planned.begin(GamePlan())
    planned.play(calls=4)
    *_, second, last = planned.world.called_now
    label = planned.workspace.activity.deck.label(second)
    assert planned.do(TakeBackCall(label)) == ["call taken back", "taken back"]
    assert second not in planned.world.called_now and last in planned.world.called_now
    assert planned.world.order[-1] == second
    assert all(not p.marked >> p.cell[second] & 1
               for p in planned.world.players.values() if second in p.cell)  # fmt: skip
    assert planned.do(TakeBackCall(label)) == ["not called"]
    (change,) = planned.workspace.store.events(GameChange)
    assert (change.record.what, change.record.number) == ("taken back", second)


def test_the_pace_can_be_changed_within_bounds(planned: Planned) -> None:
    planned.begin(GamePlan())
    planned.play(calls=2)
    assert planned.do(SetPace(10)) == ["pace"]
    before = planned.supervision.world.seconds
    planned.play(calls=4)
    assert planned.supervision.world.seconds - before == pytest.approx(20)
    for _ in range(12):
        planned.do(ChangePace(1))
    assert planned.world.pace == 5
    for _ in range(12):
        planned.do(ChangePace(-1))
    assert planned.world.pace == 60


def test_absent_people_are_not_visited_until_they_return(planned: Planned) -> None:
    planned.begin(GamePlan())
    assert planned.do(GoesAway("user1")) == ["goes"] and planned.do(GoesAway("user1")) == [
        "away before"
    ]
    planned.play(calls=25)
    asked = [a.action.target for a in planned.events if isinstance(a, Acted)]
    assert "user1" not in asked and any(asked)
    assert planned.do(ComesIn("user1")) == ["comes"]
    assert planned.world.tracker.ask("user1")


def test_everybody_is_visited_without_delaying_requests(taught: Path) -> None:
    planned = Planned(taught, users=8)
    planned.begin(GamePlan(("full card",), visits=True))
    planned.play()
    acted = [event for event in planned.events if isinstance(event, Acted)]
    assert {a.action.target for a in acted} >= set(planned.world.people)
    visits = [event for event in planned.events if isinstance(event, GameChanged)]
    assert any(event.what == "visit" for event in visits)
    planned.workspace.close()


def test_a_large_group_shares_time_between_calls_and_requests(
    taught: Path,
) -> None:
    planned = Planned(taught, users=24)
    rule = planned.workspace.activity.rules.calls_first
    assert rule is not None
    planned.begin(GamePlan(("full card",), visits=True, pace=5))
    waiting, longest, world = dict[str, int](), 0, planned.world
    while not planned.supervision.over and len(world.called_now) < 30:
        planned.events += go_on_by_script(planned.control, expert=True)
        assert world.tracker.visits <= rule.visits
        calls = len(world.called_now)
        queue = [person for person in world.tracker.queue if person != world.tracker.place]
        waiting = {person: waiting.get(person, calls) for person in queue}
        longest = max([longest, *(calls - since for since in waiting.values())])
    assert len(world.called_now) == 30 and planned.supervision.faults == []
    assert 0 < longest <= rule.calls * 24 / rule.visits
    assert "calls first" in planned.changes()
    planned.workspace.close()


def test_the_log_and_the_report_include_changes_of_the_game(taught: Path) -> None:
    planned = Planned(taught, users=24)
    planned.begin(GamePlan(("line", "full card"), visits=True, pace=5))
    planned.play(calls=30)
    told = [(one.what, one.person, one.number) for one in planned.events
            if isinstance(one, GameChanged)]  # fmt: skip
    store, activity = planned.workspace.store, planned.workspace.activity
    session = read_session(
        store, read_games(store), {activity.name: activity}, planned.workspace.names
    )
    (replay,) = session.replays
    kept = [(one.what, one.person, one.number) for _, one in replay.changes]
    assert kept == told
    assert "calls first" in {what for what, _, _ in told}
    moments = [m.to_json() for m in replay.moments]
    assert sum(one["kind"] == "change" for one in moments) == len(told)
    lines = "\n".join(replay_lines(replay, activity, session.name))
    unknown = "\n".join(replay_lines(replay, None, session.name))  # its activity is gone
    for change in planned.events:
        if isinstance(change, GameChanged):
            words = changed_words(change, activity, session.name)
            assert words in lines and words in unknown
    summed = changes_lines(session.replays, session.name)
    made = [who for what, who, _ in kept if what == "visit"]
    put_off = [who for what, who, _ in kept if what == "visit put off"]
    for person in {*put_off} - {who for who in made if made.count(who) > put_off.count(who)}:
        assert not any("had not asked" in line and session.name(person) in line for line in summed)
    page, short = session_page(session), list(session_lines(session))
    assert summed and all(line in page and line in short for line in summed)
    calls = {activity.deck.label(number) for number in planned.world.called_now}
    assert len(calls) == 30 and all(f">{call}<" in page for call in calls)
    listed = short[short.index("Numbers that were called:") + 1]
    assert calls == set(listed.strip().split(", "))
    planned.workspace.close()


def test_requests_in_a_small_group_never_wait_for_a_call(planned: Planned) -> None:
    planned.begin(GamePlan(("full card",), visits=True, pace=5))
    planned.play()
    assert "visit" in planned.changes() and "calls first" not in planned.changes()


def test_a_game_with_calls_first_resumes_after_an_interruption(taught: Path) -> None:
    planned = Planned(taught, users=24)
    planned.begin(GamePlan(("full card",), visits=True, pace=5))
    while planned.world.tracker.calls_first < 3:
        planned.events += go_on_by_script(planned.control, expert=True)
    world = planned.world
    stood = (world.tracker.calls_first, world.tracker.state(), list(world.tracker.queue))
    planned.workspace.close()

    again = Planned(taught, users=24)
    past = interrupted_game(again.workspace.store, "bingo")
    assert past is not None
    again.control = scripted_controller(again.supervision, past)
    again.control.begin()
    tracker = again.world.tracker
    assert (tracker.calls_first, tracker.state(), list(tracker.queue)) == stood
    followed = Tracker(again.workspace.activity, again.world.people)  # as a live game does

    def change(one: GameChange) -> None:
        if one.what == "calls first":
            followed.calls_first = one.number
        elif one.what == "visit":
            followed.ask(one.person)
        elif one.what == "visit put off":
            followed.withdraw(one.person)

    past.follow(followed, change)
    assert (followed.calls_first, followed.state()) == stood[:2]
    again.workspace.close()


def test_a_right_claim_waits_for_no_call(taught: Path) -> None:
    planned = Planned(taught, users=24)
    planned.begin(GamePlan(("full card",), pace=5))
    while not planned.world.tracker.calls_first:
        planned.events += go_on_by_script(planned.control, expert=True)
    planned.world.wins = lambda card: True  # type: ignore[method-assign]
    planned.do(ClaimCard(20))
    planned.play(calls=len(planned.world.called_now) + 1)
    assert planned.celebrated() == ["user20"]
    planned.workspace.close()


@pytest.mark.parametrize("calls", [6, 40, 60])
def test_a_resumed_planned_game_equals_an_uninterrupted_one(taught: Path, calls: int) -> None:
    planned = Planned(taught)
    planned.begin(GamePlan(("line", "two lines", "full card"), several=True, visits=True))
    planned.play(calls=4)
    planned.do(TakeBackCall())
    planned.do(GoesAway("user2"))
    planned.play(calls=calls)
    world = planned.world
    stood = (world.tracker.state(), list(world.called_now), list(world.tracker.queue), world.away)
    marked = {p.id: p.marked for p in world.players.values()}
    planned.workspace.close()

    again = Planned(taught)
    past = interrupted_game(again.workspace.store, "bingo")
    assert past is not None
    again.control = scripted_controller(again.supervision, past)
    again.control.begin()
    world = again.world
    state, called, queue, away = stood
    assert (world.tracker.state(), list(world.called_now), list(world.tracker.queue)) == (
        state, called, queue
    )  # fmt: skip
    assert world.away == away and {p.id: p.marked for p in world.players.values()} == marked
    again.play()
    assert isinstance(again.events[-1], GameEnded) and again.events[-1].stopped is None
    again.workspace.close()


@pytest.mark.parametrize("calls", [0, 4])
def test_choices_of_staff_during_a_game_survive_an_interruption(taught: Path, calls: int) -> None:
    planned = Planned(taught)
    planned.begin(GamePlan(absent=("user3",), minutes=40))
    planned.play(calls=calls)
    assert planned.do(LetWin(several=True)) == ["several"]
    assert planned.do(LetWin(visits=True)) == ["visits"]
    notes = [event.record for event in planned.workspace.store.events(StaffAction)]
    assert (notes[-1].did, notes[-1].detail) == ("rules", "visits on")
    assert not any("True" in note.detail for note in notes)
    planned.do(GoesAway("user2"))
    planned.do(ComesIn("user3"))
    assert planned.do(SetPace(12)) == ["pace"]
    planned.play(calls=calls + 2)
    chosen = planned.world.game_plan
    assert chosen == GamePlan(several=True, visits=True, absent=("user2",), pace=12, minutes=40)
    planned.workspace.close()

    again = Planned(taught)
    past = interrupted_game(again.workspace.store, "bingo")
    assert past is not None and past.beginning.plan.minutes == 40
    again.control = scripted_controller(again.supervision, past)
    again.control.begin()
    assert again.world.game_plan == chosen and again.world.away == {"user2"}
    assert again.world.pace == 12
    followed = list[GameChange]()  # as a live game does
    past.follow(Tracker(again.workspace.activity, again.world.people), followed.append)
    assert tuple(followed) == past.changes
    again.workspace.close()


def test_unvisited_people_come_first_also_after_an_interruption(taught: Path) -> None:
    planned = Planned(taught, users=8)
    planned.begin(GamePlan(("full card",)))
    planned.play(calls=15)
    acted = [event for event in planned.events if isinstance(event, Acted)]
    visited = {a.action.target for a in acted if a.outcome.completed} & {*planned.world.people}
    planned.workspace.close()

    again = Planned(taught, users=8)
    past = interrupted_game(again.workspace.store, "bingo")
    assert past is not None and "user1" in visited and len(visited) < 8
    again.control = scripted_controller(again.supervision, past)
    again.control.begin()
    again.do(LetWin(visits=True))
    again.play()
    first = next(e for e in again.events if isinstance(e, GameChanged) and e.what == "visit")
    assert first.person not in visited
    again.workspace.close()


def test_time_and_visits_survive_an_interruption(taught: Path) -> None:
    planned = Planned(taught)
    planned.begin(GamePlan())
    planned.play(calls=15)
    acted = [event for event in planned.events if isinstance(event, Acted)]
    visited = {a.action.target for a in acted if a.outcome.completed} & {*planned.world.people}
    past = interrupted_game(planned.workspace.store, "bingo")
    assert past is not None and visited
    scene, people = planned.world.scene(), planned.world.people
    watch, now = StaffWatch(), 5.0
    watch.resume(now, past, planned.workspace.activity)
    view = watch.look(replace(scene, place=FRONT), people, now, planned.world)
    assert view.seconds == pytest.approx(sum(a.outcome.seconds for a in acted))
    ago = {one.id: one.unvisited for one in view.people if one.unvisited is not None}
    assert set(ago) == visited and all(0 <= one < view.seconds for one in ago.values())
    planned.workspace.close()


def test_a_visit_counts_on_arrival(planned: Planned) -> None:
    planned.begin(GamePlan())
    person = planned.world.people[1]
    scene = replace(planned.world.scene(), place=person)
    watch = StaffWatch()
    assert watch.look(scene, (), 7.0, planned.world).seconds == 0  # before a game
    watch.begin(5.0)

    class OnItsWay(PlannedGame):
        arrived = False
        pace = 0.0
        bound_for = person
        tracker = planned.world.tracker

    (now,) = watch.look(scene, (person,), 6.0, OnItsWay()).people
    assert (now.state, now.unvisited) == ("comes", None)
    OnItsWay.bound_for = ""
    (now,) = watch.look(scene, (person,), 7.0, OnItsWay()).people  # as after an interruption
    assert (now.state, now.unvisited) == ("plays", None)
    (now,) = watch.look(scene, (person,), 8.0, planned.world).people
    assert (now.state, now.unvisited) == ("visited", 0)


def test_a_default_plan_logs_no_changes_of_the_game(planned: Planned) -> None:
    planned.begin(GamePlan())
    planned.play()
    store = planned.workspace.store
    assert not list(store.events(GameChange)) and list(store.events(GameStep))


def all_called(planned: Planned) -> SimulatedWorld:
    """Play until all numbers were called: nobody marks a number, and nobody asks."""
    planned.world.users = replace(planned.world.users, miss=1.0, ask=1e-9)
    planned.begin(GamePlan())
    planned.play(calls=75)
    return planned.world


def visits(planned: Planned) -> list[str]:
    """Return the people visited after the last number."""
    told = [event for event in planned.events if isinstance(event, GameChanged)]
    last = next(n for n, event in enumerate(told) if event.what == "all called")
    return [event.person for event in told[last:] if event.what == "visit"]


def test_every_card_is_checked_after_the_last_number(planned: Planned) -> None:
    world = all_called(planned)
    planned.play()
    assert visits(planned) == [world.people[0]]  # they mark the missed number, and win
    assert planned.celebrated() == [world.people[0]] and planned.supervision.faults == []
    ended = planned.events[-1]
    assert isinstance(ended, GameEnded) and ended.stopped is None
    said = [event.said for event in planned.events if isinstance(event, GameChanged)]
    assert said[0] == world.activity.rules.all_called


def test_a_game_without_a_winner_ends(planned: Planned) -> None:
    world = all_called(planned)
    world.read_card = lambda: None  # type: ignore[method-assign]  # no card can be read
    planned.play()
    assert visits(planned) == list(world.people)
    assert planned.changes()[-1] == "nobody won" and planned.celebrated() == []
    ended = planned.events[-1]
    assert isinstance(ended, GameEnded) and ended.stopped is None
    assert "no-progress" not in [fault.code for fault in planned.supervision.faults]
    store = planned.workspace.store
    session = read_session(
        store, read_games(store), {"bingo": planned.workspace.activity}, planned.workspace.names
    )
    lines = changes_lines(session.replays, session.name)
    assert any("All numbers have been called, and nobody has won." in line for line in lines)


def test_a_call_that_is_taken_back_precedes_the_final_visits(planned: Planned) -> None:
    world = all_called(planned)
    world.read_card = lambda: None  # type: ignore[method-assign]
    while not planned.changes():
        planned.events += go_on_by_script(planned.control, expert=True)
    planned.do(TakeBackCall())
    assert len(world.called_now) == 74
    planned.play()
    assert planned.changes().count("all called") == 2 and len(world.called_now) == 75


def test_the_final_visits_resume_after_an_interruption(taught: Path) -> None:
    planned = Planned(taught)
    world = all_called(planned)
    while "visit" not in planned.changes():
        planned.events += go_on_by_script(planned.control, expert=True)
    stood = (world.tracker.state(), world.visiting)
    planned.workspace.close()
    again = Planned(taught)
    again.world.users = replace(again.world.users, miss=1.0, ask=1e-9)
    past = interrupted_game(again.workspace.store, "bingo")
    assert past is not None
    again.control = scripted_controller(again.supervision, past)
    again.control.begin()
    assert again.world.all_called and (again.world.tracker.state(), again.world.visiting) == stood
    again.play()
    assert "all called" not in again.changes() and again.celebrated() == [world.people[0]]
    again.workspace.close()


def test_each_card_is_checked_once_after_the_last_number(planned: Planned) -> None:
    world = all_called(planned)
    world.read_card = lambda: None  # type: ignore[method-assign]
    while planned.changes().count("visit over") < 2:
        planned.events += go_on_by_script(planned.control, expert=True)
    past = interrupted_game(planned.workspace.store, "bingo")
    assert past is not None
    assert list(past.visited(planned.workspace.activity)) == list(world.people[:2])


def test_no_number_is_called_from_an_empty_deck(taught: Path) -> None:
    planned = Planned(taught, users=8)
    world = all_called(planned)
    world.read_card = lambda: None  # type: ignore[method-assign]
    for person in world.people:
        world.tracker.ask(person)
    planned.play()
    acted = [event for event in planned.events if isinstance(event, Acted)]
    draws = [a for a in acted if a.action.behaviour.calls]
    assert len(draws) == 75 and all(a.outcome.numbers for a in draws)
    assert "calls first" not in planned.changes() and planned.changes()[-1] == "nobody won"
    planned.workspace.close()


def test_each_pattern_has_one_winner_by_default(planned: Planned) -> None:
    planned.world.users = replace(planned.world.users, miss=1.0, ask=1e-9)
    planned.begin(GamePlan(("line", "two lines", "full card")))
    planned.play(calls=75)
    planned.play()
    assert planned.celebrated() == list(planned.world.people[:1]) * 3
    assert visits(planned) == list(planned.world.people[:1]) * 3  # again for each pattern
    change = GameChanged("nobody won", "", 2, (), "")
    assert "nobody else has won" in changed_words(change, None, str)


def test_several_winners_after_the_last_number_are_celebrated(
    planned: Planned,
) -> None:
    planned.world.users = replace(planned.world.users, miss=1.0, ask=1e-9)
    planned.begin(GamePlan(several=True))
    planned.play()
    assert list(dict.fromkeys(planned.celebrated())) == list(planned.world.people)
    ended = planned.events[-1]
    assert isinstance(ended, GameEnded) and ended.stopped is None
    assert planned.supervision.faults == []
