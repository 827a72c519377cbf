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


SWITCH_ON = (
    "It stands at the front, facing people, with nobody close by, and somebody is near its stop "
    "button. In the game ctrl+x stops it, too."
)
BENCH = (
    "No robot is named, so its devices are simulated, and the people at the table; all else is as "
    "in a live game. `tangy --robot FILE` names a robot."
)


async def play_from_home(program: Program, policy: Policy) -> None:
    """Ask first, and play: with the robot, if its file names drivers, or on the bench."""
    from tangy_tui.live.opening import opening_of
    from tangy_tui.ui.dialogs.confirm import ConfirmDialog

    house = program.house
    bench = not house.robot.drivers
    if bench:
        dialog = ConfirmDialog("Play on the bench?", BENCH, yes="play", no="back")
    else:
        question = f"Switch {house.robot.title} on?"
        dialog = ConfirmDialog(question, SWITCH_ON, yes="switch it on, and play", no="back")
    if await program.push_screen_wait(dialog):
        seed = house.game_seed(None)
        opening = opening_of(house, bench=bench, seed=seed)
        await play_live(program, opening, policy, games=1, seed=seed, teacher="")


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
