"""A live game in which a fault halts the robot: its clock, and stops of staff meanwhile."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from tangy_hw.robot_process.stop_latch import StopLatch
from tangy_profiles.health import OK, Reading
from tangy_tui.app.game_commands import Acknowledge, Clear, GoOn, StopRobot
from tangy_tui.app.staff_notes import StaffNote
from tangy_tui.app.workspace import Workspace
from tests.app.test_interruption import Robot


def report(robot: Robot, reading: Reading) -> None:
    """Let a device of the robot report this from now on."""
    state = robot.link.state
    health = tuple(reading if r.device == reading.device else r for r in state.health)
    robot.link.state = replace(state, health=health)


def test_the_time_of_a_halt_counts_once(taught: Path) -> None:
    workspace = Workspace(taught)
    robot = Robot(workspace)
    robot.next(2)
    began = robot.link.time - robot.control.supervision.seconds
    report(robot, Reading("stop_button", 0.0, OK, {"latched": True}))
    robot.next(1)
    assert robot.control.supervision.halted is not None
    clock = list[float]()
    for command in (Acknowledge(), Clear()):
        robot.link.time += 40.0  # staff look for it
        if isinstance(command, Clear):
            report(robot, Reading("stop_button", 0.0, OK))
        robot.control.apply(command)
        clock.append(robot.control.supervision.seconds)
    assert robot.control.supervision.halted is None
    assert clock == pytest.approx([robot.link.time - began - 40.0, robot.link.time - began], abs=2)
    workspace.close()


def test_a_robot_that_staff_let_go_on_during_a_halt_moves_once_the_fault_is_cleared(
    taught: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    workspace, latch = Workspace(taught), StopLatch()
    robot = Robot(workspace)
    monkeypatch.setattr(robot.link, "stop", lambda why, by="staff": latch.hold(why, by))
    monkeypatch.setattr(robot.link, "release", lambda by="": latch.release(by))
    robot.next(2)
    report(robot, Reading("stop_button", 0.0, OK, {"latched": True}))
    robot.next(1)
    told = []
    for command in (StopRobot(), GoOn(), Acknowledge()):
        told += robot.control.apply(command)
        assert latch.why == "emergency-stop"  # letting it go on frees it from no fault
    assert told[:2] == [StaffNote("stopped"), StaffNote("still halted", "Emergency stop pressed")]
    report(robot, Reading("stop_button", 0.0, OK))
    robot.control.apply(Clear())
    assert latch.why == "" and robot.control.phase == "running"
    workspace.close()
