"""The choice of another activity on the home screen."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from tangy_profiles.errors import TangyError
from tangy_tui.app.chosen_activity import choosable
from tangy_tui.text.activities import CHOOSE_ACTIVITY, activity_note, chosen_words

if TYPE_CHECKING:
    from tangy_tui.app.workspace import Workspace
    from tangy_tui.ui.program import Program


async def choose_at_home(program: Program) -> None:
    """Ask for another activity, and change to it."""
    from tangy_tui.ui.screens.home import HomeScreen

    before = program.workspace.profile
    try:
        await choose_activity(program, program.workspace.change_activity)
    except TangyError as error:
        program.say(str(error), bad=True)
        return
    if program.workspace.profile != before:
        program.say(chosen_words(program.workspace.activity.title))
    if isinstance(program.screen, HomeScreen):
        program.screen.show_activity(program.workspace.activity.title)


async def choose_activity(program: Program, take: Callable[[str], object]) -> None:
    """Ask for another activity, and call `take` with it.

    Raises:
        TangyError: it cannot be used.
    """
    from tangy_tui.ui.dialogs.choose import ChooseDialog, Option

    workspace = program.workspace
    options = [Option(*one) for one in choices(workspace)]
    wanted = await program.push_screen_wait(ChooseDialog(CHOOSE_ACTIVITY, options))
    if wanted is None or wanted == workspace.profile:
        return
    take(wanted)
    await program.speaker.speak_of(workspace.activity)
    if program.hearing is not None:
        program.hearing.ears.understand_by(workspace.phrasebook())


def choices(workspace: Workspace) -> list[tuple[str, str, str]]:
    """Return the activities to choose from: name, title and note, the present one first.

    The user's own file is included while it is the present activity.
    """
    there = choosable(workspace.profile, workspace.activity)
    return [(name, activity.title, activity_note(activity)) for name, activity in there]
