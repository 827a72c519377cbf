"""Asks once where old games were played, if their log entries do not tell."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

from tangy_profiles.errors import TangyError
from tangy_profiles.game_world import read_game_world
from tangy_tui.text import old_games as text

if TYPE_CHECKING:
    from tangy_tui.ui.program import Program


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
