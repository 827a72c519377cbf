"""A game that begins while its robot drives to the front, and who waits between two games."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from tangy_profiles.state import ActivityState
from tangy_tui.app.game_commands import AskFor, EndGame
from tangy_tui.app.workspace import Workspace
from tangy_tui.text.staff_view import BEGINS, NEXT_BEGINS, OVER, person_words
from tangy_tui.ui.screens.play_view import ViewSource, next_line
from tests.app.test_interruption import Robot


@pytest.fixture
def robot(taught: Path) -> Iterator[Robot]:
    robot = Robot(Workspace(taught), begins=False)
    yield robot
    robot.workspace.close()


def shown(robot: Robot) -> tuple[str, float]:
    line = next_line(ViewSource(robot.world, robot.control, robot.workspace.name))
    return line, robot.control.view().seconds


def test_while_a_game_begins_nothing_of_the_last_one_is_shown(
    robot: Robot, monkeypatch: pytest.MonkeyPatch
) -> None:
    seen, begin = list[tuple[str, float]](), robot.world.begin

    def drives() -> ActivityState:
        robot.link.time += 3.0
        seen.append(shown(robot))
        return begin()

    monkeypatch.setattr(robot.world, "begin", drives)
    robot.control.begin()
    robot.next(4)
    robot.link.time += 60.0
    robot.control.apply(EndGame())
    assert shown(robot)[0].startswith(OVER)
    robot.control.begin()
    assert seen == [(BEGINS, 3.0), (NEXT_BEGINS, 3.0)]
    assert shown(robot)[1] == 0.0
    assert not robot.control.beginning
