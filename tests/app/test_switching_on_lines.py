"""A STOP that is typed while the robot is switched on is heard, and holds."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import pytest

from tangy_hw.cancellation import Cancellation
from tangy_hw.robot_client.live_world import LiveWorld
from tangy_profiles.game_world import LIVE
from tangy_profiles.staff_records import StaffAction
from tangy_tui.app.command_grammar import read_command
from tangy_tui.app.game_commands import GoOn, Joins, StopRobot
from tangy_tui.app.game_controller import GameController
from tangy_tui.app.interruption import find_interrupted
from tangy_tui.app.joining import resume_joined
from tangy_tui.app.set_up import SetUp
from tangy_tui.app.switching_on import switched_on
from tangy_tui.app.workspace import Workspace
from tangy_tui.console.inputs import ReadAhead
from tangy_tui.console.set_up import SetUpLines
from tangy_tui.console.switching_on import SwitchingOnLines
from tests.app.test_joining import SEED, LiveGame
from tests.support.waiting import wait_until


class Typed:
    """Lines that are typed while the robot is switched on."""

    def __init__(self) -> None:
        self.ahead = ReadAhead(lambda: None)
        self.written: list[str] = []
        self.lines = SwitchingOnLines(
            self.ahead, lambda said: read_command(said, str), str, self.written.append
        )

    def takes(self, *lines: str, before: LiveGame | None = None) -> None:
        for line in lines:
            self.ahead.lines.put(line)
        while not self.ahead.lines.empty():
            self.lines.take(None if before is None else before.control)


def test_a_stop_before_the_first_game_holds_and_other_lines_wait_for_the_game() -> None:
    typed = Typed()
    typed.takes("faster", "please stop the robot", "", "go on", "pause", "left Rosa")
    assert typed.lines.stopped and not typed.lines.leaves
    assert list(typed.ahead.early) == ["faster", "pause", "left Rosa"]  # go on is to be typed again
    assert len(typed.written) == 5
    typed.takes("end")
    assert typed.lines.leaves


def test_lines_of_a_script_with_waits_keep_their_order() -> None:
    typed = Typed()
    typed.takes("wait 3", "stop")
    assert not typed.lines.stopped and list(typed.ahead.early) == ["wait 3", "stop"]


def test_the_end_of_the_lines_stays_for_the_game() -> None:
    typed = Typed()
    typed.ahead.lines.put(None)
    typed.lines.take(None)
    assert typed.ahead.lines.get_nowait() is None


@pytest.mark.parametrize(("line", "phase"), [("stop", "stopped"), ("pause", "paused")])
def test_a_game_that_somebody_joins_waits_after_a_stop_or_a_pause(
    taught: Path, line: str, phase: str
) -> None:
    workspace = Workspace(taught)
    before = LiveGame(workspace)
    before.play(3)
    before.told(Joins("Berta"))
    before.control.admit_no_more()
    typed = Typed()
    typed.takes(line, before=before)
    past = resume_joined(workspace, LIVE)
    after = LiveGame(workspace, past, before=before.control)
    assert after.control.phase == phase and "release" not in after.link.told[1:]
    after.control.apply(GoOn())
    assert after.control.phase == "running"
    workspace.close()


def test_lines_are_taken_until_the_robot_is_on() -> None:
    typed = Typed()
    typed.ahead.lines.put("stop")

    def opens(stepped: bool, cancellation: Cancellation) -> Any:
        @contextmanager
        def opened() -> Iterator[bool]:
            wait_until(lambda: typed.lines.stopped)
            yield True

        return opened()

    with switched_on(opens, stepped=False, meanwhile=lambda: typed.lines.take(None)) as heard:
        assert heard


@pytest.mark.parametrize(
    ("lines", "stopped", "begins", "stops"),
    [
        (["begin"], True, True, 1),
        (["end"], True, False, 1),
        ([], False, True, 0),
        (["stop the robot", "perhaps", "begin"], True, True, 2),
        (["go on"], True, True, 1),
    ],
)
def test_a_stop_before_the_game_is_asked_about(
    workspace: Workspace,
    monkeypatch: pytest.MonkeyPatch,
    lines: list[str],
    stopped: bool,
    begins: bool,
    stops: int,
) -> None:
    setup, told, typed = SetUp.of(workspace), list[str](), iter(lines)
    monkeypatch.setattr(setup, "checks", list)
    setup.world = cast(LiveWorld, SimpleNamespace(link=SimpleNamespace(stop=told.append)))
    console = SetUpLines(setup, lambda: next(typed, None), lambda line: None)
    assert console.begins_anyway(stopped=stopped) is begins
    assert len(told) == stops


def test_a_stop_before_a_game_is_resumed_is_in_its_log(taught: Path) -> None:
    workspace = Workspace(taught)
    LiveGame(workspace).play(3)
    workspace.close()  # and kill -9

    workspace = Workspace(taught)
    past = find_interrupted(workspace, LIVE)
    assert past is not None
    game = LiveGame(workspace)  # only for its robot
    supervision = workspace.supervision(game.control.supervision.policy, SEED, world=game.world)
    control = GameController(supervision, "Ada", robot=game.world, past=past)
    control.apply(StopRobot())
    control.begin()
    assert control.phase == "stopped"
    acts = [event.record for event in workspace.store.events(StaffAction)]
    assert [(act.game, act.did) for act in acts] == [(past.beginning.game, "stopped")]
    workspace.close()
