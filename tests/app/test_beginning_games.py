"""A game that begins while its robot drives to the front, and who waits between two games."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from tangy_profiles.state import ActivityState
from tangy_tui.app.game_commands import AskFor, EndGame, GoesAway
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


def test_who_still_waits_is_shown_between_two_games(robot: Robot) -> None:
    robot.control.begin()
    robot.next(2)
    robot.control.apply(AskFor("user3"))
    robot.control.view()
    robot.control.apply(EndGame())
    robot.link.time += 130.0
    told = {one.id: person_words(one) for one in robot.control.view().people}
    assert told["user3"] == "asks 2 min" and "asks" not in told["user1"]
    robot.control.begin()
    told = {one.id: person_words(one) for one in robot.control.view().people}
    assert told["user3"] == "asks 2 min"


def test_who_was_visited_or_has_left_is_not_shown_as_waiting(robot: Robot) -> None:
    robot.control.begin()
    robot.next(2)
    robot.control.apply(AskFor("user3"))
    robot.next(2)  # Tangy goes there
    robot.link.sign(2)
    robot.control.apply(EndGame())
    robot.world.over = True  # as after the last behaviour
    assert [one.id for one in robot.control.view().people if one.turn] == ["user2"]
    robot.control.apply(GoesAway("user2"))
    assert not [one for one in robot.control.view().people if one.turn]
