"""Live games in the program: the robot is switched on, games are played, it is switched off."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

from textual.constants import ESCAPE_DELAY

from tangy_profiles import game_world
from tangy_profiles.errors import TangyError
from tangy_tui.text.live_games import BENCH, BENCH_DETAIL, SWITCH_ON_DETAIL, switch_on_words
from tangy_tui.ui.interruption import ask_about_interrupted

if TYPE_CHECKING:
    from tangy_hw.robot_client.live_world import LiveWorld
    from tangy_profiles.past_game import PastGame
    from tangy_tui.app.robot_opening import Opening
    from tangy_tui.app.switching_on import SwitchingOn
    from tangy_tui.learning.policy import Policy
    from tangy_tui.ui.program import Program

TYPED_AHEAD_SECONDS = 1.5 * ESCAPE_DELAY
"""After which an Esc that was typed before there was a screen is known to be one."""


async def play_from_home(program: Program, policy: Policy) -> None:
    """Ask first, and play: with the robot, if its file names drivers, or on the bench."""
    from tangy_tui.app.robot_opening import opening_of
    from tangy_tui.ui.dialogs.confirm import ConfirmDialog

    workspace = program.workspace
    bench = not workspace.robot.drivers
    if bench:
        dialog = ConfirmDialog(BENCH, BENCH_DETAIL, yes="play", no="back")
    else:
        question = switch_on_words(workspace.robot.title)
        dialog = ConfirmDialog(question, SWITCH_ON_DETAIL, yes="switch it on, and play", no="back")
    world = game_world.BENCH if bench else game_world.LIVE
    if await program.push_screen_wait(dialog):
        chosen = await ask_about_interrupted(program, world)
        if chosen is None:
            return
        past = chosen.past
        seed = workspace.game_seed(None) if past is None else past.beginning.seed
        opening = opening_of(workspace, bench=bench, seed=seed)
        await play_live(program, opening, policy, games=1, seed=seed, teacher="", past=past)


async def play_live(
    program: Program,
    opening: Opening,
    policy: Policy,
    *,
    games: int,
    seed: int,
    teacher: str,
    past: PastGame | None = None,
) -> None:
    """Switch the robot on, play on the live screen, and switch it off again.

    It is left off where somebody calls it off meanwhile. A past game, which was interrupted, is
    taken up first.
    """
    from tangy_tui.app.switching_on import SwitchingOn

    workspace = program.workspace
    robot = SwitchingOn(opening)
    try:
        world = await _switch_on(program, robot)
        if world is None:
            return
        from tangy_tui.ui.screens.live import LiveScreen

        supervision = workspace.supervision(policy, seed, asks=True, world=world)
        screen = LiveScreen(workspace, supervision, world, games=games, teacher=teacher, past=past)
        if program.hearing is not None:
            program.hearing.ears.begin()
        await program.push_screen_wait(screen)
    finally:
        await asyncio.shield(asyncio.to_thread(robot.close))


async def _switch_on(program: Program, robot: SwitchingOn) -> LiveWorld | None:
    """Switch a robot on behind a dialog; None where it was called off, or could not be.

    It may have come on at the very moment at which it was called off: then it goes off again.
    """
    from tangy_hw.cancellation import Cancelled
    from tangy_tui.ui.dialogs.message import MessageDialog
    from tangy_tui.ui.dialogs.switching_on import SwitchingOnDialog

    dialog = SwitchingOnDialog(program.workspace.robot.title, robot.cancel)
    program.push_screen(dialog)
    await dialog.shown()
    await asyncio.sleep(TYPED_AHEAD_SECONDS)
    opening = asyncio.ensure_future(asyncio.to_thread(robot.open))
    opening.add_done_callback(_heard)
    try:
        world = await asyncio.shield(opening)
        return None if dialog.called_off else world
    except Cancelled:
        return None
    except TangyError as error:
        said = str(error)
    except asyncio.CancelledError:  # the program is being left
        robot.cancel()
        raise
    finally:
        dialog.over()
    await program.push_screen_wait(MessageDialog(said, title="Not yet"))
    return None


def _heard(opening: asyncio.Future[LiveWorld]) -> None:
    """Take note of how it went, where nobody waits for it any more."""
    if not opening.cancelled():
        opening.exception()
