"""What staff break off by ending a game is no fault, and nothing new begins before the end."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from tangy_profiles.errors import TangyError
from tangy_profiles.game_records import FaultDiagnosed
from tangy_profiles.health import OK, Reading
from tangy_tui.app.game_commands import CallAgain, EndGame, GoOn, Pause, StopRobot, TakeOver
from tangy_tui.app.staff_notes import StaffNote
from tangy_tui.app.workspace import Workspace
from tangy_tui.interaction.game_events import Acted, GameEnded
from tangy_tui.learning.verification import Reply, Say, Verified
from tests.app.test_halted_clock import report
from tests.app.test_interruption import Robot


@pytest.fixture
def robot(taught: Path) -> Iterator[Robot]:
    workspace = Workspace(taught)
    yield Robot(workspace)
    workspace.close()


def break_off_a_drive(robot: Robot) -> list[str]:
    """Let staff end the game on Tangy's way to somebody; return the steps until then."""
    robot.next(3)
    robot.link.sign(2)
    robot.link.missed = {"user2"}

    def meanwhile(do: str, time: float) -> None:
        if do == "go":
            robot.control.break_off()

    robot.link.meanwhile = meanwhile
    told = [one for _ in range(4) for one in robot.control.next()]
    return [one.action.behaviour.name for one in told if isinstance(one, Acted)]


def test_no_step_follows_a_drive_that_the_end_of_the_game_broke_off(robot: Robot) -> None:
    assert break_off_a_drive(robot)[-1:] == ["navigate to user"]
    steps = robot.control.supervision.steps
    assert robot.control.next() == []
    robot.control.apply(EndGame())
    game = robot.control.supervision
    assert game.over and game.steps == steps and not game.faults


@pytest.mark.parametrize("command", [CallAgain(), Pause(), TakeOver(), GoOn()])
def test_commands_before_the_end_of_a_game_that_wait_begin_nothing(
    robot: Robot, command: Pause | TakeOver | GoOn | CallAgain
) -> None:
    break_off_a_drive(robot)
    said = len(robot.link.said)
    assert robot.control.apply(command) == [StaffNote("ends")]
    assert robot.control.apply(StopRobot()) == [StaffNote("stopped")]
    robot.control.apply(EndGame())
    assert robot.control.supervision.over and len(robot.link.said) == said


def test_an_answer_that_waits_when_staff_end_the_game_is_not_carried_out(robot: Robot) -> None:
    control = robot.control
    robot.next(2)
    control.apply(TakeOver())
    control.next()
    control.answers.say(Say("tell a joke"))
    yes = control.answers.reply(Reply(yes=True))
    assert isinstance(yes, Verified)
    control.break_off()
    said = len(robot.link.said)
    assert control.answer(yes.behaviour, yes.target) == [StaffNote("ends")]
    assert len(robot.link.said) == said
    control.apply(EndGame())
    assert not control.supervision.faults
    assert not list(robot.workspace.store.events(FaultDiagnosed))


def test_a_game_whose_end_cannot_be_logged_stands_still_until_staff_let_it_go_on(
    robot: Robot, monkeypatch: pytest.MonkeyPatch
) -> None:
    control, full = robot.control, TangyError("The disk is full.")
    robot.next(2)

    def refuse(*, ends: bool) -> None:
        raise full

    with monkeypatch.context() as patch:
        patch.setattr(control.supervision, "leave", refuse)
        assert control.apply(EndGame()) == [StaffNote("cannot", str(full))]
    assert str(control.phase) == "stopped" and control.next() == []
    control.apply(GoOn())
    assert robot.link.told[-1] == "release"
    assert [one for one in control.next() if isinstance(one, Acted)]


def test_a_command_that_the_end_of_the_game_interrupts_says_so(robot: Robot) -> None:
    robot.next(3)
    robot.link.breaks["perform"] = "staff ended the game"
    speaks = threading.Event()
    ask = robot.link.ask

    def asked(do: str, **what: object) -> object:
        if do == "perform" and not speaks.is_set():
            speaks.set()
            robot.control.break_off()
        return ask(do, **what)

    robot.link.ask = asked  # type: ignore[assignment]
    assert robot.control.apply(CallAgain()) == [StaffNote("ends")]


@pytest.mark.parametrize(
    ("before", "why"),
    [
        ("plays", "Staff ended it."),
        ("took over", "Staff ended it."),
        ("asks", "Nobody has shown that. What now?"),
        (
            "halted",
            "Tangy was halted. Emergency stop pressed: Somebody pressed the emergency stop.",
        ),
    ],
)
def test_the_log_says_in_which_state_staff_ended_a_game(
    robot: Robot, before: str, why: str
) -> None:
    control = robot.control
    robot.next(2)
    match before:
        case "took over":
            control.apply(TakeOver())
            control.next()
        case "asks":
            control.supervision.game.ask("Nobody has shown that.", "What now?", "")
        case "halted":
            report(robot, Reading("stop_button", 0.0, OK, {"latched": True}))
            control.next()
    told = control.apply(EndGame())
    assert [one.stopped for one in told if isinstance(one, GameEnded)] == [why]
