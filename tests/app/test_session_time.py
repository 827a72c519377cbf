"""The planned time is that of the session: every game shows what is left of it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest

from tangy_profiles.errors import TangyError
from tangy_profiles.game_records import GameBeginning
from tangy_profiles.game_rules import GamePlan
from tangy_profiles.past_game import interrupted_game
from tangy_profiles.session_time import SessionTime, session_time
from tangy_profiles.staff_records import StaffAction
from tangy_profiles.store import Store
from tangy_tui.app import planned_time
from tangy_tui.app.game_commands import EndGame, GoOn, Pause, PlanTime
from tangy_tui.app.game_view import view_of
from tangy_tui.app.planned_time import planned_end
from tangy_tui.app.time_grammar import asks_time, read_time
from tangy_tui.app.workspace import Workspace
from tangy_tui.console.inquiries import Inquiries
from tangy_tui.monitoring.games import read_games
from tangy_tui.monitoring.session import read_session
from tangy_tui.text.control import noted_words
from tangy_tui.text.planned_time import end_words, left_words, time_facts, time_lines
from tangy_tui.text.report import how_long_words
from tangy_tui.text.watching import view_lines
from tests.app.test_interruption import Robot
from tests.support.planned_games import Planned

BEGAN = datetime(2026, 3, 2, 9, 22, tzinfo=UTC)
END = BEGAN + timedelta(minutes=40)


class Clock:
    """The clock of a log."""

    def __init__(self) -> None:
        self.now = BEGAN

    def __call__(self) -> datetime:
        return self.now

    def later(self, minutes: float) -> None:
        self.now += timedelta(minutes=minutes)


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def workspace(taught: Path, clock: Clock) -> Iterator[Workspace]:
    workspace = Workspace(taught, now=clock)
    yield workspace
    workspace.close()


def session(workspace: Workspace, minutes: int = 40) -> Robot:
    """Begin the first game of a session."""
    robot = Robot(workspace)  # which begins a game, before the plan
    robot.control.apply(EndGame())
    robot.world.choose(replace(robot.world.game_plan, minutes=minutes))
    robot.control.supervision.game.games = 0
    robot.control.begin()
    return robot


def next_game(robot: Robot) -> None:
    robot.control.apply(EndGame())
    robot.control.begin()


def test_a_later_game_shows_the_end_that_the_session_had(
    workspace: Workspace, clock: Clock
) -> None:
    robot = session(workspace)
    assert robot.control.time.ends == END
    clock.later(13)
    next_game(robot)
    assert robot.control.time.ends == END and robot.control.time.left == 27 * 60
    assert [one.record.minutes for one in workspace.store.events(GameBeginning)][-2:] == [40, 40]
    view = view_of(robot.control)
    assert view is not None and datetime.fromisoformat(view.ends) == END
    assert any("left" in line for line in time_lines(robot.control))
    (where,) = Inquiries(robot.control, workspace.name, None, str).lines("where") or []
    until = end_words(END, clock.now)
    assert f"27:00 left, until {until}" in where
    assert any(until in line for line in view_lines(view, workspace.activity, workspace.name)) or (
        view.world not in ("bench", "live")
    )


def test_pauses_do_not_move_the_end(workspace: Workspace, clock: Clock) -> None:
    robot = session(workspace)
    robot.control.apply(Pause())
    clock.later(10)
    robot.control.apply(GoOn())
    assert robot.control.time.ends == END and robot.control.time.left == 30 * 60


def test_a_resumed_game_keeps_the_end_from_the_log(workspace: Workspace, clock: Clock) -> None:
    robot = session(workspace)
    clock.later(10)
    next_game(robot)
    robot.next(3)
    robot.control.apply(PlanTime(5, more=True))
    robot.control.interrupt()
    clock.later(20)
    past = interrupted_game(workspace.store, workspace.activity.name)
    assert past is not None and past.beginning.number == 2
    again = Robot(workspace, past, on_for=7200.0)
    later = END + timedelta(minutes=5)
    assert again.control.time.ends == later and again.control.time.left == 15 * 60
    next_game(again)
    assert again.control.time.ends == later


def test_another_session_begins_its_own_time(workspace: Workspace, clock: Clock) -> None:
    session(workspace).control.apply(EndGame())
    clock.later(120)
    robot = Robot(workspace)  # of the same seed, as a script may choose it
    first = workspace.store.events(GameBeginning)
    assert [one.record.number for one in first][-1] == 1
    assert robot.control.time.ends is None
    assert robot.control.time.now is not None and robot.control.time.now.begins == clock.now


def test_staff_plan_more_time_in_a_game_after_it_and_between_games(
    workspace: Workspace, clock: Clock
) -> None:
    robot = session(workspace)
    clock.later(50)
    assert robot.control.time.left == -600
    (noted,) = robot.control.apply(PlanTime(20))
    assert noted.kind == "time planned"  # type: ignore[union-attr]
    ends = clock.now + timedelta(minutes=20)
    assert robot.control.time.now == SessionTime(BEGAN, ends)
    read = read_session(workspace.store, read_games(workspace.store), {}, {})
    assert [one.ends for one in read.times] == [None, ends]
    assert how_long_words(read).endswith(f"; planned until {end_words(ends, clock.now)}")
    said = noted_words(noted, workspace.name)  # type: ignore[arg-type]
    assert "(20 minutes from now)" in said
    robot.control.apply(EndGame())
    played = robot.control.view().seconds
    robot.control.apply(PlanTime(10, more=True))
    logged = list(workspace.store.events(StaffAction))[-1].record
    assert logged.did == "time planned" and logged.seconds is None, "the game is over"
    robot.control.begin()
    assert robot.control.time.ends == ends + timedelta(minutes=10) and played >= 0
    robot.control.apply(PlanTime())
    assert robot.control.time.ends is None and robot.control.time.left is None


def test_logs_of_older_programs_count_from_the_first_game(
    workspace: Workspace, clock: Clock
) -> None:
    def begun(game: str, number: int, minutes: int) -> None:
        people = tuple(workspace.names)
        workspace.store.append(
            GameBeginning(
                game=game, number=number, activity="bingo", seed=3, people=people, minutes=minutes
            )
        )

    begun("one", 1, 30)
    clock.later(20)
    begun("two", 2, 30)
    begun("other", 3, 10)
    assert session_time(workspace.store, "other") == session_time(workspace.store, "one")
    people = tuple(workspace.names)
    workspace.store.append(GameBeginning(game="new", number=4, activity="bingo", people=people))
    time = session_time(workspace.store, "new")  # of another run: of its seed, too
    assert time == SessionTime(clock.now, None)
    damaged = StaffAction(game="two", did="time planned", by="", detail="soon")
    time = session_time(workspace.store, "two")
    assert time is not None and time.ends == BEGAN + timedelta(minutes=30)
    assert session_time(workspace.store, "three") is None
    workspace.store.append(damaged)
    time = session_time(workspace.store, "one")
    assert time is not None and time.ends is None


def test_the_panel_tells_since_when_the_time_is_up() -> None:
    now = END + timedelta(minutes=5)
    facts = time_facts(61, END, None, now)
    assert isinstance(facts, tuple)
    full, short = facts
    assert full == f"1:01 so far, time is up since {end_words(END, now)}"
    assert short == "1:01 so far, time is up"
    paused = time_facts(61, END, 12.0, END - timedelta(minutes=5))
    assert paused[-1] == f"paused 0:12, until {end_words(END, now)}"
    assert time_facts(61, END, 12.0, now)[-1] == "paused 0:12, time is up"
    over = left_words(END, now)
    assert "has been over since" in over and "plan 20 minutes" in over
    assert "5 minutes left" in left_words(END, END - timedelta(minutes=5))
    assert left_words(None, now) == ""
    days = END + timedelta(days=2)
    assert end_words(END, days).startswith("2 Mar ")


@pytest.mark.parametrize(
    ("said", "planned"),
    [
        ("plan 20 minutes", PlanTime(20)),
        ("plan 20", PlanTime(20)),
        ("time 30 minutes", PlanTime(30)),
        ("plan for 5 min", PlanTime(5)),
        ("10 more minutes", PlanTime(10, more=True)),
        ("plan 10 more minutes", PlanTime(10, more=True)),
        ("another 15 minutes", PlanTime(15, more=True)),
        ("5 minutes longer", PlanTime(5, more=True)),
        ("plan until 15:40", PlanTime(until=(15, 40))),
        ("play until 9:05", PlanTime(until=(9, 5))),
        ("plan until 23:59", PlanTime(until=(23, 59))),
        ("plan 600 minutes", PlanTime(600)),
        ("plan 1 minute", PlanTime(1)),
        ("no time limit", PlanTime()),
        ("play for two lines", None),
        ("10 minutes", None),
    ],
)
def test_words_plan_the_time(said: str, planned: PlanTime | None) -> None:
    assert read_time(said) == planned


@pytest.mark.parametrize(
    "said",
    ["plan", "plan a picnic", "plan until 24:00", "plan until 9:60", "plan 601 minutes",
     "plan 0 minutes", "another 0 minutes"],
)  # fmt: skip
def test_an_unclear_plan_is_explained(said: str) -> None:
    with pytest.raises(TangyError):
        read_time(said)


def test_a_time_of_day_is_the_next_one_and_never_a_past_one() -> None:
    now = datetime(2026, 3, 2, 23, 50).astimezone()
    ends = planned_end(PlanTime(until=(0, 10)), now, None)
    assert ends is not None and ends - now == timedelta(minutes=20)
    with pytest.raises(TangyError, match="23:50 already"):
        planned_end(PlanTime(until=(23, 40)), now, None)


@pytest.mark.parametrize(
    ("now", "until", "minutes"),
    [((14, 0), (3, 30), 90), ((11, 45), (1, 0), 75), ((9, 30), (10, 15), 45),
     ((14, 0), (15, 30), 90), ((9, 0), (3, 0), 360), ((23, 0), (5, 0), 360)],
)  # fmt: skip
def test_a_time_of_day_may_be_in_the_afternoon(
    now: tuple[int, int], until: tuple[int, int], minutes: int
) -> None:
    then = datetime(2026, 3, 2, *now).astimezone()
    ends = planned_end(PlanTime(until=until), then, None)
    assert ends is not None and ends - then == timedelta(minutes=minutes)


@pytest.mark.parametrize(
    ("now", "until"),
    [
        ((16, 0), (3, 30)),
        ((10, 0), (9, 30)),
        ((14, 0), (0, 10)),
        ((9, 0), (3, 1)),
        ((23, 0), (5, 1)),
        ((10, 0), (10, 0)),
        ((20, 0), (12, 30)),
        ((8, 0), (0, 30)),
    ],
)
def test_a_time_of_day_that_was_is_not_one_of_tomorrow(
    now: tuple[int, int], until: tuple[int, int]
) -> None:
    then = datetime(2026, 3, 2, *now).astimezone()
    with pytest.raises(TangyError, match="already"):
        planned_end(PlanTime(until=until), then, None)


@pytest.mark.parametrize(
    ("before", "ends"),
    [(None, 10), (timedelta(minutes=-50), 10), (timedelta(minutes=5), 15)],
)
def test_more_time_counts_from_the_planned_end_or_from_now_if_that_is_over(
    before: timedelta | None, ends: int
) -> None:
    was = None if before is None else END + before
    assert planned_end(PlanTime(10, more=True), END, was) == END + timedelta(minutes=ends)
    assert planned_end(PlanTime(10), END, was) == END + timedelta(minutes=10)


def test_a_plan_made_while_the_time_is_read_counts(
    workspace: Workspace, monkeypatch: pytest.MonkeyPatch
) -> None:
    time = session(workspace).control.time

    def read(store: Store, game: str) -> SessionTime | None:
        before = session_time(store, game)
        monkeypatch.setattr(planned_time, "session_time", session_time)
        time.end_at(None)  # by another thread
        return before

    time.plan(PlanTime(20))
    monkeypatch.setattr(planned_time, "session_time", read)
    assert time.ends is not None
    assert time.now is not None and time.ends is None


@pytest.mark.parametrize(
    "said",
    ["how long", "how long is left?", "When does it end?", "how much time do we have left", "time",
     "when is the game over", "until when do we play", "how long have we played so far"],
)  # fmt: skip
def test_questions_about_the_time(said: str) -> None:
    assert asks_time(said)


@pytest.mark.parametrize(
    "said", ["how long does Rosa wait", "when is Rosa next", "when", "how long until Rosa's turn"]
)
def test_questions_about_people_are_none_about_the_time(said: str) -> None:
    assert not asks_time(said)


def test_the_plan_of_the_log_is_offered_again(workspace: Workspace) -> None:
    session(workspace)
    first = [one.record for one in workspace.store.events(GameBeginning)]
    assert first[-1].plan == GamePlan(pace=first[-1].pace, minutes=40)


def test_the_time_of_a_simulated_game_cannot_be_planned(planned: Planned) -> None:
    planned.begin(GamePlan())
    assert planned.do(PlanTime(20)) == ["not in a simulation"]
    acts = [event.record.did for event in planned.workspace.store.events(StaffAction)]
    assert "time planned" not in acts
