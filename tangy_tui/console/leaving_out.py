"""Switches a robot on without a device that does not start, if staff at the lines want that."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, ExitStack, contextmanager
from typing import TYPE_CHECKING, TypeVar

from tangy_hw.device_protocols import DeviceFailed
from tangy_profiles.known_devices import can_be_left_out, left_out
from tangy_tui.app.command_grammar import ANSWERS
from tangy_tui.language.answers import yes_or_no
from tangy_tui.text.missing_devices import go_on_without, without_words

if TYPE_CHECKING:
    from tangy_tui.app.workspace import Workspace

Opened = TypeVar("Opened")


@contextmanager
def on_or_without(
    switch_on: Callable[[], AbstractContextManager[Opened]],
    leaves_out: Callable[[DeviceFailed], bool],
) -> Iterator[Opened]:
    """Switch a robot on, again after each device that is left out.

    Args:
        switch_on: switches it on.
        leaves_out: leaves a device out; returns whether the robot is to be switched on without it.

    Raises:
        DeviceFailed: a device does not start, and is not left out.
    """
    with ExitStack() as on:
        while True:
            try:
                opened = on.enter_context(switch_on())
                break
            except DeviceFailed as error:
                if not leaves_out(error):
                    raise
        yield opened


def leaves_out(
    workspace: Workspace,
    error: DeviceFailed,
    read: Callable[[], str | None],
    write: Callable[[str], object],
) -> bool:
    """Ask staff at the lines whether to go on without a device, and leave it out then."""
    robot = workspace.robot
    if not can_be_left_out(robot, error.device):
        return False
    write(without_words(robot, error.device, workspace.activity, str(error)))
    write(f"{go_on_without(robot, error.device)} (y/n)")
    said = (read() or "").strip().casefold()
    if ANSWERS.get(said, yes_or_no(said)) is not True:
        return False
    workspace.robot = left_out(robot, error.device)
    return True
