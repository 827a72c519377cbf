"""The first start: who teaches is asked once, before anything else is opened."""

from __future__ import annotations

from collections.abc import Callable, Coroutine
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from tangy_profiles.errors import TangyError
from tangy_tui.app.teacher_profile import read_profile, save_profile
from tangy_tui.text.who import renamed_teacher

if TYPE_CHECKING:
    from tangy_tui.ui.program import Program


async def first_start(
    program: Program,
    start: Callable[[Program], Coroutine[Any, Any, None]] | None,
    *,
    asks: bool,
) -> None:
    """Ask who teaches, where nobody has said so yet, and do what comes first."""
    if asks and not read_profile(program.workspace.store.folder).name:
        await ask_name(program)
    if start is not None:
        await start(program)


async def ask_name(program: Program, *, again: bool = False) -> None:
    """Ask who teaches, and keep the answer."""
    from tangy_tui.ui.dialogs.name import NameDialog

    workspace = program.workspace
    name = await program.push_screen_wait(NameDialog(workspace.teacher))
    if name is None:
        return
    folder = workspace.store.folder
    try:
        save_profile(folder, replace(read_profile(folder), name=name))
    except TangyError as error:
        program.say(str(error), bad=True)
        return
    if again:
        program.say(renamed_teacher(name))
