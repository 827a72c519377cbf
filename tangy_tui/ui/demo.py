"""The whole story on the screens: demonstrations, learning, a game, and what is believed."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from tangy_tui.app.workspace import Workspace
from tangy_tui.text.program import LEARNING

if TYPE_CHECKING:
    from tangy_tui.ui.program import Program

TEACHING = (2.0, 6.0, 12.0)
"""Steps a second of the three demonstrations: slow enough to read at first."""

PLAYING = 100.0
"""Times life of the game: half an hour in about 20 s."""


async def tell_story_aside(program: Program) -> None:
    """Tell the story in a data folder of its own, so that nothing of it stays."""
    own = program.workspace
    with TemporaryDirectory(prefix="tangy-demo-") as scratch:
        program.workspace = Workspace(Path(scratch), activity=own.profile, users=len(own.people))
        try:
            await tell_story(program, 1)
        finally:
            program.workspace.close()
            program.workspace = own


async def tell_story(program: Program, seed: int) -> None:
    """Three demonstrations by a scripted teacher, learning, one game, what is believed."""
    from tangy_tui.console.demo import learn
    from tangy_tui.learning.scripted_teacher import SCRIPTED
    from tangy_tui.ui.screens.people import PeopleScreen
    from tangy_tui.ui.screens.play import PlayScreen
    from tangy_tui.ui.screens.teach import TeachScreen

    workspace = program.workspace
    teaching = workspace.teaching(SCRIPTED, seed)
    for number, pace in enumerate(TEACHING):
        complete = await program.push_screen_wait(
            TeachScreen(workspace, teaching, scripted=pace, another=number > 0)
        )
        if not complete:
            return
    policy = await program.in_thread(LEARNING, lambda: learn(workspace))
    if policy is None:
        return
    await program.open_policy(policy, leave_after=6.0)
    supervision = workspace.supervision(policy, seed)
    await program.push_screen_wait(
        PlayScreen(workspace, supervision, speed=PLAYING, leave_after=3.0)
    )
    await program.push_screen_wait(PeopleScreen(workspace, leave_after=None))
