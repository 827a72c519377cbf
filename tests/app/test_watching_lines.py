"""Looking on by lines: names and labels are there from the first line on."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

from tangy_tui.app.game_commands import AskFor, Pause
from tangy_tui.app.game_view import view_of
from tangy_tui.app.workspace import Workspace
from tangy_tui.console.watching import WatchingLines
from tangy_tui.text.watching import PHASES
from tests.app.test_interruption import Robot


def test_the_first_lines_name_people_and_calls(taught: Path) -> None:
    workspace = Workspace(taught)
    robot = Robot(workspace)
    while not robot.world.called:
        robot.next(1)
    robot.control.apply(AskFor("user3"))
    robot.world.observe()
    label = workspace.activity.deck.label(robot.world.called[-1])
    written: list[str] = []
    lines: Any = WatchingLines(taught, workspace.store, written.append)
    lines.guest = SimpleNamespace(
        look_first=lambda: True, view=view_of(robot.control), look=lambda: False, close=list
    )
    lines.run(ends=lambda: True)
    assert workspace.name("user3") in written[1] and "user3" not in written[1]
    assert label in written[2]
    workspace.close()


def test_a_pause_is_told_once(taught: Path) -> None:
    workspace = Workspace(taught)
    robot = Robot(workspace)
    written: list[str] = []
    lines: Any = WatchingLines(taught, workspace.store, written.append)
    lines.guest = SimpleNamespace(look=lambda: True, view=view_of(robot.control))
    lines.look()
    robot.control.apply(Pause())
    lines.guest.view = view_of(robot.control)
    told = len(written)
    lines.look()
    lines.look()
    assert [line.rpartition(": ")[2] for line in written[told:] if line.startswith("--")] == [
        PHASES["paused"]
    ]
    workspace.close()
