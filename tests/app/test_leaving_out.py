"""At the lines, staff go on without a device that blocks, or leave."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from types import SimpleNamespace
from typing import Any, cast

import pytest

from tangy_hw.device_protocols import DeviceFailed
from tangy_profiles.robot import load_robot
from tangy_tui.verbs.live_console import GamesWithoutScreen

WORLD: Any = object()
WHY = "arms: its driver has not started within 27 s."


class Lines:
    """A person at the lines who answers once."""

    typed = True

    def __init__(self, answer: str | None) -> None:
        self._answer = answer
        self.told: list[str] = []
        self.early = SimpleNamespace()

    def write(self, line: str) -> None:
        self.told.append(line)

    def read(self) -> str | None:
        return self._answer

    def meanwhile(self) -> None: ...


def games(lines: Lines | None) -> tuple[GamesWithoutScreen, Any]:
    from tangy_profiles.activity import load_activity

    workspace = SimpleNamespace(robot=load_robot(), activity=load_activity("bingo"))
    given = SimpleNamespace(bench=False, plain_lines=lines is not None, link=None)
    one = object.__new__(GamesWithoutScreen)
    one._given, one._workspace, one._console = (
        cast(Any, given),
        cast(Any, workspace),
        cast(Any, lines),
    )

    @contextmanager
    def opening(stepped: bool, cancellation: object) -> Iterator[Any]:
        if "arms" in workspace.robot.devices:
            raise DeviceFailed("arms", WHY)
        yield WORLD

    return one, opening


def test_staff_at_the_lines_go_on_without_a_device_that_blocks() -> None:
    lines = Lines("yes")
    one, opening = games(lines)
    with one._switched_on(opening) as world:
        assert world is WORLD
    assert WHY in lines.told[0] and "Tangy makes no gestures" in lines.told[0]
    assert lines.told[1] == "Go on without the arms? (y/n)"


@pytest.mark.parametrize("answer", ["no", "", None])
def test_without_a_yes_the_robot_stays_off(answer: str | None) -> None:
    one, opening = games(Lines(answer))
    with pytest.raises(DeviceFailed), one._switched_on(opening):
        pass


def test_without_staff_the_device_is_named_and_nothing_is_left_out() -> None:
    one, opening = games(None)
    with pytest.raises(DeviceFailed, match="arms"), one._switched_on(opening):
        pass
