"""What games were played for, who won, when people took part, and when games stood still."""

from __future__ import annotations

from dataclasses import replace
from datetime import UTC, datetime, timedelta
from xml.etree import ElementTree

import pytest

from tangy_profiles.game_records import GameChange, MoveKind
from tangy_profiles.game_rules import GamePlan
from tangy_profiles.game_world import LIVE
from tangy_sim.worlds.world import SimulatedWorld
from tangy_tui.app.game_commands import ChoosePatterns, ComesIn, GoesAway
from tangy_tui.app.scripted_staff import go_on_by_script, scripted_controller
from tangy_tui.app.workspace import Workspace
from tangy_tui.interaction.game_events import Acted
from tangy_tui.learning.policy import Policy
from tangy_tui.monitoring.attention import attention
from tangy_tui.monitoring.fault import Moved
from tangy_tui.monitoring.games import Game, read_games
from tangy_tui.monitoring.pauses import PauseTotal
from tangy_tui.monitoring.played_for import PlayedFor, played_for
from tangy_tui.monitoring.presence import Stay, stays
from tangy_tui.monitoring.replay import Done, GameReplay, Moment, Noted, What
from tangy_tui.monitoring.session import Session, read_session
from tangy_tui.monitoring.standstills import answer_waits, halts, halts_in, interruptions
from tangy_tui.pages.session import session_page
from tangy_tui.text.log import session_lines
from tangy_tui.text.report import GAME_TIME, care_lines, how_long_words
from tangy_tui.text.session_page import CARE
from tangy_tui.text.taking_part import played_for_rows, stay_words, took_part, with_stay
from tangy_tui.text.times import length
from tests.monitoring.conftest import Supervise
from tests.support.games import play

BEGUN = datetime(2026, 3, 1, 10, tzinfo=UTC)
ONE = Game(
    1, "g", 1, BEGUN, "bingo", "p", "d", ("user1", "user2"), 0, 0, 0, BEGUN + timedelta(minutes=9),
    9, None,
)  # fmt: skip


def session_of(workspace: Workspace) -> Session:
    games = read_games(workspace.store)
    activities = {workspace.activity.name: workspace.activity}
    return read_session(workspace.store, games, activities, workspace.names)


def at(minutes: float) -> datetime:
    return BEGUN + timedelta(minutes=minutes)


def moment(minutes: float, what: What, step: int = 1) -> Moment:
    return Moment(60.0 * minutes, step, at(minutes).isoformat(), what)


def moves(*changes: tuple[float, str, str], game: Game = ONE) -> GameReplay:
    """Return a game in which people came and left: minute, what, and who."""
    told = [
        moment(minute, GameChange(game="g", what=what, person=person, steps=1))  # type: ignore[arg-type]
        for minute, what, person in changes
    ]
    return GameReplay(game, staff_changes=told)


@pytest.mark.slow
def test_the_report_tells_who_won_with_each_pattern(workspace: Workspace, learnt: Policy) -> None:
    supervision = workspace.supervision(learnt, 31)
    world, control = supervision.world, scripted_controller(supervision)
    assert isinstance(world, SimulatedWorld)
    world.choose(GamePlan(("line", "x")))
    events = control.begin()
    control.apply(ChoosePatterns(("line", "two lines")))
    while not supervision.over:
        events += go_on_by_script(control, expert=True)
    winners = [
        event.action.target
        for event in events
        if isinstance(event, Acted) and event.action.behaviour.needs and event.outcome.completed
    ]
    session = session_of(workspace)
    (found,) = session.played_for
    assert [one.pattern for one in found] == ["line", "two lines"]
    assert [[*one.winners] for one in found] == [[person] for person in winners]
    told = session.to_json()["games"][0]["played_for"]
    assert [one["winners"] for one in told] == [[person] for person in winners]
    ((_, words),) = played_for_rows(session)
    assert all(session.name(str(person)) in words for person in winners)
    assert words in session_page(session, full=False)
    assert any(words in line for line in session_lines(session, full=False))


def test_the_report_tells_what_was_played_for_if_nobody_has_won(
    workspace: Workspace, learnt: Policy
) -> None:
    control = scripted_controller(workspace.supervision(learnt, 31))
    control.begin()
    control.next()
    session = session_of(workspace)
    assert session.played_for == ((PlayedFor("line"),),)  # the activity's own pattern
    ((heading, words),) = played_for_rows(session)
    assert workspace.activity.rules.pattern("line").label in words
    root = ElementTree.fromstring(session_page(session).partition("\n")[2])  # noqa: S314 - our own
    facts = zip(root.iter("dt"), root.iter("dd"), strict=True)
    assert (heading, words) in [(name.text, told.text) for name, told in facts]
    assert played_for(replace(session.replays[0], activity=None)) == ()


def test_a_choice_of_patterns_counts_for_the_win_after_it(workspace: Workspace) -> None:
    chosen = GameChange(game="g", what="patterns chosen", steps=1, patterns=("x", "gone"))
    on = GameChange(game="g", what="played on", steps=1, person="user1")
    replay = GameReplay(
        replace(ONE, patterns=("line",)), [moment(2, on)], activity=workspace.activity,
        staff_changes=[moment(1, chosen)],
    )  # fmt: skip
    assert [one.pattern for one in played_for(replay)] == ["line", "x"]
    early = played_for(replace(replay, moments=[]))  # it ended before
    assert early == (PlayedFor("line"), PlayedFor("x", reached=False))
    other = replace(replay, game=replace(ONE, patterns=("gone",)))  # the activity has changed
    assert played_for(other) == (PlayedFor(""),)


def test_a_stay_lasts_from_coming_to_leaving() -> None:
    late = replace(ONE, people=("user1", "user2", "user3", "user4"), absent=frozenset({"user2"}))
    replay = moves(
        (1, "left", "user1"), (2, "came", "user2"), (3, "left", "user2"), (4, "came", "user1"),
        (5, "joined", "user4"), game=replace(late, joined=("user4",)),
    )  # fmt: skip
    assert stays([replay]) == {
        "user1": (Stay(None, at(1)), Stay(at(4), None)),
        "user2": (Stay(at(2), at(3)),),
        "user3": (Stay(None, None),),
        "user4": (Stay(at(5), None),),
    }


def test_games_in_a_row_are_one_stay() -> None:
    second = replace(ONE, at=at(20), ended=at(30), people=("user1", "user3"))
    found = stays([moves(), moves(game=second)])
    assert found["user1"] == (Stay(None, None),)
    assert found["user2"] == (Stay(None, at(9)),)
    assert found["user3"] == (Stay(at(20), None),)
    broken = replace(ONE, ended=None)  # its last event is its end
    replay = replace(moves(game=broken), moments=[moment(4, Noted("paused", "Ada"))])
    assert stays([replay, moves(game=second)])["user2"] == (Stay(None, at(4)),)


def test_a_person_who_left_is_reported_with_the_times(workspace: Workspace, learnt: Policy) -> None:
    control = scripted_controller(workspace.supervision(learnt, 31))
    control.apply(GoesAway("user2"))
    control.begin()
    control.next()
    for command in (ComesIn("user2"), GoesAway("user3")):
        control.apply(command)
    session = session_of(workspace)
    assert {person: len(each) for person, each in session.stays.items()} == dict.fromkeys(
        (person.id for person in workspace.people), 1
    )
    (second,), (third,) = session.stays["user2"], session.stays["user3"]
    assert second.since is not None and second.until is None
    assert third.since is None and third.until is not None
    for person, stay in (("user2", second), ("user3", third)):
        told = f"{session.name(person)} ({stay_words([stay])})"
        assert with_stay(session, person) == told and told in took_part(session)
        page, lines = session_page(session), list(session_lines(session))
        assert page.count(told) == 2  # who took part, and whom Tangy never went to
        assert sum(told in line for line in lines) == 2
    assert with_stay(session, "user1") == session.name("user1")
    (document,) = [one for one in session.to_json()["people"] if one["id"] == "user2"]
    assert document["present"] == [{"since": second.since.isoformat(), "until": None}]


def test_the_text_report_has_what_to_look_after(workspace: Workspace, supervise: Supervise) -> None:
    play(supervise("base-failed@6", asks=False), expert=False)
    session = session_of(workspace)
    lines = list(session_lines(session, full=False))
    care = lines.index(f"{CARE}:")
    people = care_lines(attention(session.replays).values(), session.name)
    assert people and lines[care + 1 : care + 1 + len(people)] == [f"  {one}" for one in people]
    (fault,) = session.look_after
    assert lines.index(f"  {fault.console}") > care
    assert all(f"    - {step}" in lines for step in fault.advice)


def test_a_halt_lasts_until_staff_clear_it(workspace: Workspace, supervise: Supervise) -> None:
    play(supervise("laser-disconnected@6"))
    (replay,) = session_of(workspace).replays
    ((begun, over),) = halts_in(replay)
    assert isinstance(begun.what, Moved) and begun.what.move.kind == "halted"
    assert over is not None and isinstance(over.what, Moved) and over.what.move.kind == "cleared"
    assert halts(replay) == PauseTotal(1, over.seconds - begun.seconds)
    still = replace(replay, moments=[begun], seconds=begun.seconds + 60.0)
    assert halts(still) == PauseTotal(1, 60.0)


def test_a_wait_for_staff_ends_with_their_answer_or_the_next_step(
    workspace: Workspace, supervise: Supervise
) -> None:
    play(supervise("laser-disconnected@6"))
    session = session_of(workspace)
    (replay,) = session.replays
    halted = next(one.what for one in replay.moments if isinstance(one.what, Moved))
    step = next(one.what for one in replay.moments if isinstance(one.what, Done))

    def moved(minutes: float, kind: MoveKind) -> Moment:
        return moment(minutes, replace(halted, move=replace(halted.move, kind=kind)))

    asked, taught = moved(1, "teacher asked"), moved(7.5, "taught")
    done = moment(7, replace(step, begun=360.0, over=420.0))
    ways = [
        ([asked, done, taught], 300.0),  # the log has the answer after the step
        ([asked, moved(3, "accepted"), done], 120.0),
        ([asked], 540.0),  # to the end
        ([done], 0.0),
    ]
    for moments, seconds in ways:
        waited = replace(replay, moments=moments, seconds=600.0)
        assert answer_waits(waited) == PauseTotal(int(seconds > 0), seconds)
        told = replace(session, replays=(waited,))
        assert (length(seconds) in how_long_words(told)) == (seconds > 0)
        assert told.to_json()["answer_waits"]["seconds"] == seconds


def test_halts_and_interruptions_are_told_beside_the_pauses(
    workspace: Workspace, supervise: Supervise
) -> None:
    play(supervise())
    session = session_of(workspace)
    plain = how_long_words(session)
    (replay,) = session.replays
    assert GAME_TIME in plain
    game = replace(replay.game, world=LIVE)
    assert GAME_TIME not in how_long_words(replace(session, replays=(replace(replay, game=game),)))
    first = next(n for n, one in enumerate(replay.moments) if one.step == 3)
    before = datetime.fromisoformat(replay.moments[first - 1].at)
    resumed = replace(
        replay.moments[first],
        at=(before + timedelta(minutes=7)).isoformat(),
        what=Noted("resumed", "Ada"),
    )
    moments = [*replay.moments[:first], resumed]
    broken = replace(session, replays=(replace(replay, moments=moments),))
    assert interruptions(broken.replays[0]) == PauseTotal(1, 420.0)
    assert broken.interruptions == PauseTotal(1, 420.0)
    assert broken.seconds == session.seconds  # no part of the time played
    assert how_long_words(broken).startswith(plain) and length(420.0) in how_long_words(broken)
    document = broken.to_json()
    assert document["interruptions"] == document["games"][0]["interruptions"]
    assert document["interruptions"] == {"count": 1, "seconds": 420.0}


def test_the_report_for_staff_has_no_words_of_researchers(
    workspace: Workspace, supervise: Supervise
) -> None:
    play(supervise("laser-disconnected@6"))
    session = session_of(workspace)
    staff, full = ("\n".join(session_lines(session, full=f)) for f in (False, True))
    (game,) = session.games
    for word in (game.id, game.policy, "expected", "step ", "first recovery"):
        assert word in full and word not in staff
    used = {
        strategy
        for person in session.people
        for strategy, one in person.strategies.items()
        if one.used
    }
    assert used
    for strategy in used:
        assert workspace.activity.strategies[strategy] in staff
        assert f"{strategy}:" in full and f"{strategy}:" not in staff
    (fault,) = session.faults
    assert fault.name in staff
