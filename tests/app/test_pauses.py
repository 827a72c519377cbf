"""Pauses of a game: its clock goes on, and screen, log and report tell the same times."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import astuple
from pathlib import Path

import pytest

from tangy_profiles.past_game import PastGame, interrupted_game
from tangy_profiles.scene import Scene
from tangy_profiles.staff_records import StaffAction
from tangy_tui.app.game_commands import (
    GameCommand,
    GiveBack,
    GoOn,
    OneStep,
    Pause,
    StopRobot,
    TakeOver,
)
from tangy_tui.app.game_view import view_of
from tangy_tui.app.workspace import Workspace
from tangy_tui.console.inquiries import Inquiries
from tangy_tui.monitoring.games import read_games
from tangy_tui.monitoring.pauses import PauseClock, PauseTotal
from tangy_tui.monitoring.replay import GameReplay
from tangy_tui.monitoring.session import read_session
from tangy_tui.text.planned_time import time_lines, time_words
from tangy_tui.text.watching import facts
from tests.app.test_interruption import Robot


@pytest.fixture
def workspace(taught: Path) -> Iterator[Workspace]:
    workspace = Workspace(taught)
    yield workspace
    workspace.close()


def reported(workspace: Workspace) -> GameReplay:
    (game,) = read_session(workspace.store, read_games(workspace.store), {}, {}).replays
    return game


def interrupted(workspace: Workspace) -> PastGame:
    past = interrupted_game(workspace.store, workspace.activity.name)
    assert past is not None
    return past


def test_screen_log_and_report_tell_the_same_times_of_a_paused_game(workspace: Workspace) -> None:
    before = Robot(workspace)
    before.next(3)
    before.control.apply(Pause())
    before.link.time += 200.0
    assert before.control.view().paused == pytest.approx(200.0)
    before.control.apply(GoOn())
    played = before.control.view().seconds
    assert before.control.view().paused is None and played > 200
    game = reported(workspace)
    assert astuple(game.staff_pauses) == pytest.approx((1, 200.0, 0))
    assert game.seconds == pytest.approx(played)
    assert interrupted(workspace).seconds == pytest.approx(played)


def test_the_time_between_a_crash_and_the_resume_is_in_no_clock(workspace: Workspace) -> None:
    before = Robot(workspace)
    before.next(3)
    before.control.apply(Pause())
    before.link.time += 200.0
    before.control.apply(GoOn())
    before.next(1)
    played = interrupted(workspace).seconds
    before.link.time += 40.0  # in which nothing was logged

    after = Robot(workspace, interrupted(workspace), on_for=7200.0)
    shown = after.control.view()
    assert shown.seconds == pytest.approx(played) and shown.paused == 0.0
    after.link.time += 50.0
    assert after.control.view().paused == pytest.approx(50.0)
    after.control.apply(GoOn())
    after.next(1)
    ended = after.control.view().seconds
    assert ended == pytest.approx(after.control.supervision.game.log.seconds)
    assert interrupted(workspace).seconds == pytest.approx(ended)
    game = reported(workspace)
    assert game.seconds == pytest.approx(ended)
    assert astuple(game.staff_pauses) == pytest.approx((2, 250.0, 0))


def test_a_stop_and_single_steps_count_as_pauses(workspace: Workspace) -> None:
    robot = Robot(workspace)
    robot.next(3)
    robot.control.apply(StopRobot())
    robot.link.time += 30.0
    robot.control.apply(GoOn())
    assert astuple(reported(workspace).staff_pauses) == pytest.approx((1, 30.0, 1))
    robot.control.apply(OneStep())
    robot.link.time += 20.0
    robot.control.apply(Pause())
    robot.link.time += 5.0
    assert robot.control.view().paused == pytest.approx(25.0)
    robot.control.apply(GoOn())
    assert astuple(reported(workspace).staff_pauses) == pytest.approx((2, 55.0, 1))


@pytest.mark.parametrize(
    ("stops", "named", "logged"),
    [
        (["", ""], "", ["Ada"]),
        (["hall", ""], "hall", ["hall"]),
        (["", "hall"], "hall", ["Ada", "hall"]),
        (["hall", "office"], "office", ["hall", "office"]),
    ],
)
def test_a_stop_is_named_by_the_last_onlooker_who_stopped_and_logged_at_each_console(
    workspace: Workspace, stops: list[str], named: str, logged: list[str]
) -> None:
    robot = Robot(workspace)
    robot.next(3)
    for by in stops:
        robot.control.apply(StopRobot(by))
        assert robot.control.view().paused is not None
    assert robot.control.stopped_by == named
    acts = [event.record for event in workspace.store.events(StaffAction)]
    assert [act.by for act in acts if act.did == "stopped"] == logged
    robot.control.apply(GoOn())
    robot.control.apply(StopRobot())
    assert robot.control.stopped_by == ""


@pytest.mark.parametrize(
    "instead",
    [[GoOn()], [Pause(), GoOn()], [StopRobot(), GoOn()], [TakeOver(), GiveBack()]],
)
def test_a_single_step_that_staff_did_not_wait_for_pauses_no_game_later(
    workspace: Workspace, instead: list[GameCommand]
) -> None:
    robot = Robot(workspace)
    robot.next(2)
    for command in (Pause(), OneStep(), *instead):  # before Tangy's next step
        robot.control.apply(command)
        assert not (robot.control.single and isinstance(command, Pause))  # screens look at it
    called = len(robot.world.called)
    robot.next(3)
    assert robot.control.phase == "running" and len(robot.world.called) == called + 3


def test_a_pause_that_the_log_does_not_end_lasts_until_the_next_step_after_a_resume() -> None:
    pauses = PauseClock()  # as an older version logged it
    pauses.resumed(10.0)
    pauses.step(14.0)
    assert pauses.total(300.0) == PauseTotal(1, 4.0)


def test_a_pause_lasts_until_the_end_of_the_game() -> None:
    pauses = PauseClock()
    pauses.did("paused", 10.0)
    pauses.did("stopped", 20.0)
    assert pauses.total(40.0) == PauseTotal(1, 30.0)


def test_onlookers_see_a_game_that_was_changing_as_they_looked(
    workspace: Workspace, monkeypatch: pytest.MonkeyPatch
) -> None:
    robot = Robot(workspace)
    robot.next(1)
    looks = iter([RuntimeError("changed during iteration"), LookupError()])
    scene = robot.world.scene

    def changing() -> Scene:
        if (error := next(looks, None)) is not None:
            raise error
        return scene()

    monkeypatch.setattr(robot.world, "scene", changing)
    assert view_of(robot.control) is not None


def test_onlookers_and_lines_get_the_time_of_the_pause(workspace: Workspace) -> None:
    robot = Robot(workspace)
    robot.next(1)
    view = view_of(robot.control)
    assert view is not None and view.paused is None
    robot.control.apply(Pause())
    robot.link.time += 200.5
    view = view_of(robot.control)
    assert view is not None and view.paused == 200
    (line,) = Inquiries(robot.control, workspace.name, None, str).lines("where") or []
    assert time_words(view.seconds, None, 200) in line


def test_a_stop_is_told_as_one_and_not_as_a_pause(workspace: Workspace) -> None:
    robot = Robot(workspace)
    robot.next(1)
    robot.control.apply(StopRobot())
    robot.link.time += 7.5
    (line,) = Inquiries(robot.control, workspace.name, None, str).lines("where") or []
    assert "stopped 0:07" in line and "paused" not in line
    assert "stopped 0:07" in time_lines(robot.control)[0]
    view = view_of(robot.control)
    assert view is not None and "stopped 0:07" in str(facts(view)[0])
    robot.control.apply(GoOn())
    robot.control.apply(Pause())
    robot.link.time += 7.5
    assert "paused 0:07" in time_lines(robot.control)[0]


@pytest.mark.parametrize(
    ("before", "meanwhile", "after"),
    [
        ([], [], "running"),
        ([Pause()], [], "paused"),
        ([], [Pause()], "paused"),
        ([Pause()], [GoOn()], "running"),
        ([], [Pause(), GoOn()], "running"),
        ([], [StopRobot()], "stopped"),
        ([], [StopRobot(), GoOn()], "running"),
        ([], [TakeOver(), GiveBack()], "running"),
        ([Pause()], [TakeOver(), GiveBack()], "running"),
        ([OneStep()], [Pause()], "paused"),
    ],
)
def test_the_game_waits_while_staff_drive_and_is_then_as_they_said(
    workspace: Workspace, before: list[GameCommand], meanwhile: list[GameCommand], after: str
) -> None:
    robot = Robot(workspace)
    robot.next(2)
    for command in before:
        robot.control.apply(command)
    called = len(robot.world.called)
    with robot.control.driving():
        robot.next(2)
        for command in meanwhile:
            robot.control.apply(command)
        robot.next(2)
        assert str(robot.control.phase) in ("staff", "stopped")
    assert len(robot.world.called) == called and robot.control.phase == after
    robot.next(2)
    assert (len(robot.world.called) > called) is (after == "running")


@pytest.mark.parametrize("before", [[], [Pause()]])
def test_a_single_step_that_staff_want_while_they_drive_comes_after_it(
    workspace: Workspace, before: list[GameCommand]
) -> None:
    robot = Robot(workspace)
    robot.next(2)
    for command in before:
        robot.control.apply(command)
    called = len(robot.world.called)
    with robot.control.driving():
        robot.control.apply(OneStep())
        robot.next(2)
        assert len(robot.world.called) == called
    robot.next(3)
    assert len(robot.world.called) == called + 1 and robot.control.phase == "paused"


@pytest.mark.parametrize(
    ("before", "meanwhile", "logged"),
    [
        ([], [GoOn()], []),
        ([], [Pause()], ["paused"]),
        ([], [Pause(), GoOn(), GoOn()], ["paused", "went on"]),
        ([Pause()], [Pause(), GoOn()], ["paused", "went on"]),
        ([Pause()], [], ["paused"]),
    ],
)
def test_a_pause_is_logged_once_also_while_staff_drive(
    workspace: Workspace,
    before: list[GameCommand],
    meanwhile: list[GameCommand],
    logged: list[str],
) -> None:
    robot = Robot(workspace)
    robot.next(2)
    for command in before:
        robot.control.apply(command)
    with robot.control.driving():
        for command in meanwhile:
            robot.control.apply(command)
    acts = [event.record.did for event in workspace.store.events(StaffAction)]
    assert [did for did in acts if did in ("paused", "went on")] == logged


def test_the_game_waits_while_staff_drive_and_then_for_what_they_say_next(
    workspace: Workspace,
) -> None:
    robot = Robot(workspace)
    robot.next(2)
    with robot.control.driving():
        robot.control.apply(TakeOver())
        robot.next(2)
        assert robot.control.supervision.question is None
    robot.next(1)
    assert robot.control.phase == "asking"


def test_a_game_that_goes_on_counts_no_longer_as_paused_by_the_program(
    workspace: Workspace,
) -> None:
    control = Robot(workspace).control
    control.apply(Pause(unasked=True))
    assert control.paused_itself  # staff are asked before it goes on
    control.apply(GoOn())
    assert not control.paused_itself
