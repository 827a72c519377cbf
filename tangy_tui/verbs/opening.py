"""Opens the workspace of a command, or the application on its screens; does not need Typer."""

from __future__ import annotations

import shlex
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from tangy_profiles.defaults import REGISTERED, USUAL_ROBOT
from tangy_profiles.errors import TangyError
from tangy_profiles.reading import plain
from tangy_tui.text.command_line import more_left_out
from tangy_tui.ui.terminal import terminal_kind

if TYPE_CHECKING:
    from tangy_profiles.store import Store
    from tangy_tui.app.workspace import Workspace

MOST_TOLD = 5
"""The most omitted events that are named one by one."""


@contextmanager
def open_workspace(
    data: Path | None,
    activity: str,
    users: int,
    *,
    write: bool = True,
    robot: str = USUAL_ROBOT,
    room: str = "",
) -> Iterator[Workspace]:
    """Open the workspace of a data folder, print the notices of its store, and close it at the end.

    If an error names a command, the command gets the options of this call.

    Raises:
        TangyError: the folder, the activity, the robot or the room cannot be read.
    """
    from tangy_profiles.errors import StoreBusy
    from tangy_tui.app.workspace import Workspace, data_folder
    from tangy_tui.text.follow_up import follow_up
    from tangy_tui.text.rooms import no_chosen_room

    folder = data_folder(data)
    try:
        workspace = Workspace(
            folder, activity=activity, users=users, write=write, robot=robot, room=room
        )
    except StoreBusy as busy:
        raise StoreBusy(_who_holds(folder) or str(busy)) from None
    try:
        say_notices(workspace.store.notices)
        if workspace.room_problem:
            say_notices([no_chosen_room(workspace.room_problem)])
        if write:
            workspace.door.open()
        yield workspace
    except TangyError as error:
        told = follow_up(str(error), **workspace.call_options)
        if told != str(error):
            error.args = (told,)
        raise
    finally:
        say_aside(workspace.store)
        workspace.close()


def _who_holds(folder: Path) -> str:
    """Tell who runs a game in a data folder; "" if no Tangy there shows one."""
    from tangy_tui.app.watching import Guest
    from tangy_tui.text.watching import busy_words

    guest = Guest(folder)
    try:
        guest.look_first()
        return "" if guest.view is None else busy_words(guest.view, plain(str(folder)))
    finally:
        guest.close()


def open_program(
    data: Path | None = None, *, robot: str = USUAL_ROBOT, ascii_only: bool = False
) -> int:
    """Open the application on its home screen, and return its exit status.

    If another program runs in the same folder, it opens as an onlooker.
    """
    from tangy_profiles.errors import StoreBusy
    from tangy_tui.ui.run import REPORT, run_program

    report = REPORT if data is None else f"{REPORT} --data {shlex.quote(str(data))}"
    try:
        with open_workspace(data, "", REGISTERED, robot=robot) as workspace:
            if robot != USUAL_ROBOT:
                _check_faults(workspace)
            return run_program(workspace, ascii_only=ascii_only, report=report)
    except StoreBusy:
        from tangy_tui.text.watching import RUNNING_HERE

        return watch_program(data, note=RUNNING_HERE, ascii_only=ascii_only)


def _check_faults(workspace: Workspace) -> None:
    """Check the fault rules of a robot's file before any screen opens."""
    from tangy_profiles.fault_file import load_faults

    load_faults(workspace.robot)


def watch_program(
    data: Path | None = None, *, who: str = "", note: str = "", ascii_only: bool = False
) -> int:
    """Open a second console beside another program, and return its exit status."""
    from tangy_tui.app.teacher_profile import login_name
    from tangy_tui.app.workspace import data_folder
    from tangy_tui.ui.run import run_watching

    folder = data_folder(data)
    return run_watching(folder, who=who or login_name(), note=note, ascii_only=ascii_only)


def full_screen() -> bool:
    """Return whether input and output are a terminal that can show screens."""
    return terminal_kind().full_screen


def say_aside(store: Store) -> None:
    """Print the events of the log that were omitted in the last operation."""
    told = [store.aside[seq] for seq in sorted(store.aside)]
    if (more := len(told) - MOST_TOLD) > 0:
        told[MOST_TOLD:] = [more_left_out(more)]
    say_notices(told)


def say_notices(notices: list[str]) -> None:
    """Print each notice as a line on standard error."""
    for notice in notices:
        print(f"tangy: {plain(notice)}", file=sys.stderr)
