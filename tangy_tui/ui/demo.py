"""The demo in the application: a story with its own data folder, on one screen."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from tangy_tui.app.workspace import Workspace

if TYPE_CHECKING:
    from tangy_tui.ui.program import Program

SEED = 1


async def tell_story_aside(program: Program) -> None:
    """Play the story in a temporary data folder."""
    own = program.workspace
    with TemporaryDirectory(prefix="tangy-demo-") as scratch:
        workspace = Workspace(Path(scratch), activity=own.profile, users=len(own.people))
        try:
            await tell_story(program, workspace, SEED)
        finally:
            workspace.close()


async def tell_story(program: Program, workspace: Workspace, seed: int) -> None:
    """Play the story in a workspace; return when its screen has come to rest."""
    from tangy_tui.console.story import Story
    from tangy_tui.ui.screens.demo import DemoScreen

    screen = DemoScreen(workspace, Story(workspace, seed))
    await program.push_screen_wait(screen)
    await screen.rest()
