"""Demonstrating a game again from a step."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tangy_profiles.errors import TangyError
from tangy_tui.text.program import NOT_POSSIBLE

if TYPE_CHECKING:
    from tangy_tui.ui.program import Program


async def show_again(program: Program, id: str, kept: int) -> None:
    """Demonstrate a game again after its first `kept` steps.

    An open teaching session continues with it: two of them would write to one game.
    """
    from tangy_tui.learning.teaching_events import Again
    from tangy_tui.ui.screens.teach import TeachScreen

    workspace = program.workspace
    open_one = next((s for s in program.screen_stack if isinstance(s, TeachScreen)), None)
    if open_one is not None:
        while program.screen is not open_one:
            await program.screen.dismiss(None)
        open_one.again(id, kept)
        return
    teaching = workspace.teaching(workspace.teacher, None, again=Again(id, kept))
    try:
        begun = teaching.begin()
    except TangyError as error:
        await program.tell(str(error), title=NOT_POSSIBLE)
        return
    program.push_screen(TeachScreen(workspace, teaching, begun=begun))
