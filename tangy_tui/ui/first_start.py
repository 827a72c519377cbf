"""The first start: asks for the teacher's name once, and starts the tour for a new teacher."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine
from contextlib import suppress
from typing import TYPE_CHECKING, Any

from tangy_profiles.errors import TangyError
from tangy_profiles.game_world import read_game_world
from tangy_tui.app.on_duty import chosen_duty
from tangy_tui.app.teacher_profile import NOBODY, change_name, read_profile
from tangy_tui.text import old_games as text
from tangy_tui.text.who import TOUR_FOLLOWS, WHO_DETAIL, renamed_teacher

if TYPE_CHECKING:
    from tangy_tui.ui.program import Program


async def first_start(
    program: Program,
    start: Callable[[Program], Coroutine[Any, Any, None]] | None,
    *,
    asks: bool,
) -> None:
    """Ask for the teacher's name if it is unknown, then start.

    A new teacher gets the tour, within a guided game if nobody has taught the activity yet.
    Otherwise the home screen stays: staff may have come to run a game, and are not asked who they
    are if somebody is on duty.
    """
    folder = program.workspace.store.folder
    if asks and not (read_profile(folder).name or (start is None and _is_on_duty(program))):
        leads = start is None and not _is_taught(program)
        detail = f"{WHO_DETAIL}\n{TOUR_FOLLOWS}" if leads else WHO_DETAIL
        program.new_teacher = await ask_name(program, detail, unasked=True) is not None
    if start is not None:
        try:
            await start(program)
        finally:
            program.show_home()
        return
    if asks:
        await ask_about_old_games(program)
    if program.new_teacher and not _is_taught(program):
        program.teach(program.workspace.teaching(program.workspace.teacher, None, guided=True))


def _is_on_duty(program: Program) -> bool:
    """Return whether staff have said who is on duty, for an activity that is taught."""
    with suppress(TangyError):  # the set-up page tells of a mistake in the file
        return bool(chosen_duty(program.workspace.store.folder)) and _is_taught(program)
    return False


def _is_taught(program: Program) -> bool:
    """Return whether the activity has a finished demonstration."""
    from tangy_tui.learning.library import read_library

    workspace = program.workspace
    return bool(read_library(workspace.store, workspace.activity.name).finished)


async def ask_name(
    program: Program, detail: str = WHO_DETAIL, *, unasked: bool = False
) -> str | None:
    """Ask for the teacher's name, and store it; None: it is unchanged.

    Args:
        program: the program.
        detail: what the question tells.
        unasked: ignore keys typed before the question was visible.
    """
    from tangy_tui.ui.dialogs.name import NameDialog

    usual = program.workspace.teacher
    suggested = "" if usual == NOBODY else usual  # the placeholder distinguishes nobody
    name = await program.push_screen_wait(NameDialog(suggested, detail=detail, unasked=unasked))
    return name if name is not None and _keep(program, name) else None


async def change_teacher(program: Program) -> None:
    """Ask for another teacher's name; later demonstrations belong to it."""
    if (name := await ask_name(program)) is not None:
        _tell(program, name)


def rename_teacher(program: Program, name: str) -> None:
    """Store a given teacher's name; later demonstrations belong to it."""
    if _keep(program, name):
        _tell(program, read_profile(program.workspace.store.folder).name)


def _keep(program: Program, name: str) -> bool:
    try:
        change_name(program.workspace.store.folder, name)
    except TangyError as error:
        program.say(str(error), bad=True)
        return False
    return True


def _tell(program: Program, name: str) -> None:
    """Show the new name, and use it for a game without steps so far."""
    from tangy_tui.ui.screens.teach import TeachScreen

    for screen in program.screen_stack:
        if isinstance(screen, TeachScreen):
            screen.teaches_as(name)
            return
    program.say(renamed_teacher(name, name))


async def ask_about_old_games(program: Program) -> None:
    """Ask where they were played; without an answer, ask again at the next start."""
    from tangy_tui.interaction.game_worlds import GameWorlds
    from tangy_tui.ui.dialogs.choose import ChooseDialog, Option

    store = program.workspace.store
    worlds = GameWorlds(store)
    try:
        unasked = await asyncio.to_thread(lambda: worlds.unasked)
        if not unasked:
            return
        ways = (text.SIMULATED, text.BENCH, text.LIVE, text.UNKNOWN)
        dialog = ChooseDialog(text.question(len(unasked)), [Option(*way) for way in ways])
        answer = await program.push_screen_wait(dialog)
        if answer is None:
            return
        worlds.settle(unasked, read_game_world(answer), program.workspace.teacher)
        program.say(text.settled_words(len(unasked), answer))
    except TangyError as error:
        program.say(str(error), bad=True)
