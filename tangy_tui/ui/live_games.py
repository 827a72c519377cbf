"""Live games in the program: the robot is switched on, games are played, it is switched off."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from contextlib import AbstractContextManager, ExitStack
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tangy_hw.world import LiveWorld
    from tangy_tui.learning.policy import Policy
    from tangy_tui.ui.program import Program

Opening = Callable[[bool], "AbstractContextManager[LiveWorld]"]
"""Opens a robot, or its bench (in a hurry, if that is wanted)."""


async def play_live(
    program: Program, opening: Opening, policy: Policy, *, games: int, seed: int, teacher: str
) -> None:
    """Switch the robot on, play on the live screen, and switch it off again."""
    from tangy_tui.ui.screens.live import LiveScreen

    house = program.house
    with ExitStack() as opened:
        world = await program.in_thread(
            "Switching the robot on ...", lambda: opened.enter_context(opening(False))
        )
        if world is None:
            return
        supervision = house.supervision(policy, seed, asks=True, world=world)
        try:
            screen = LiveScreen(house, supervision, world, games=games, teacher=teacher)
            await program.push_screen_wait(screen)
        finally:
            await asyncio.shield(asyncio.to_thread(opened.close))
