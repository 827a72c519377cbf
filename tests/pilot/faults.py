"""Helpers for tests of the fault console: the program with a game in which faults can come."""

from __future__ import annotations

from tangy_sim.worlds.faulty_world import FaultyWorld
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.policy import Policy
from tangy_tui.monitoring.fault import Fault
from tangy_tui.monitoring.supervision import Supervision
from tangy_tui.ui.dialogs.confirm import ConfirmDialog
from tangy_tui.ui.dialogs.critical import CriticalDialog
from tangy_tui.ui.program import Program
from tangy_tui.ui.screens.play import PlayScreen
from tangy_tui.ui.screens.question_panel import AskingPanel
from tangy_tui.ui.widgets.command_bar import CommandBar
from tangy_tui.ui.widgets.log_view import LogView
from tests.pilot.conftest import StillClock, TangyPilot
from tests.support.waiting import until_shown

TINY = (60, 18)
MIDDLE = (120, 40)


def playing(
    workspace: Workspace,
    policy: Policy,
    *injections: str,
    speed: float = 1,
) -> Program:
    """Make the program with the playing screen open; at speed 1 only keys move the game."""

    async def start(program: Program) -> None:
        supervision = workspace.supervision(policy, 5, asks=True, injections=injections)
        screen = PlayScreen(workspace, supervision, speed=speed, teacher="ann")
        await program.push_screen(screen)

    return Program(workspace, start, clock=StillClock())


def game_of(pilot: TangyPilot) -> tuple[PlayScreen, Supervision, FaultyWorld]:
    """Return the playing screen, its games' supervision, and their world."""
    screen = next(s for s in pilot.app.screen_stack if isinstance(s, PlayScreen))
    world = screen.control.supervision.world
    assert isinstance(world, FaultyWorld)
    return screen, screen.control.supervision, world


async def halted(pilot: TangyPilot) -> CriticalDialog:
    """Wait until the dialog of a critical fault takes keys."""
    await until_shown(pilot, lambda: isinstance(pilot.app.screen, CriticalDialog))
    dialog = pilot.app.screen
    assert isinstance(dialog, CriticalDialog)
    await until_shown(pilot, lambda: dialog.fresh_keys.seen)
    return dialog


async def halting(pilot: TangyPilot, kind: str = "emergency-stop") -> CriticalDialog:
    """Pause the game, inject a critical fault, and wait for its dialog."""
    await pilot.press("p")
    game_of(pilot)[2].inject(kind)
    return await halted(pilot)


async def asked(pilot: TangyPilot) -> AskingPanel:
    """Wait until Tangy asks and accepts a command."""
    screen = game_of(pilot)[0]
    await until_shown(pilot, lambda: screen.query(AskingPanel))
    await until_shown(pilot, lambda: any(not bar.closed for bar in screen.query(CommandBar)))
    return screen.query_one(AskingPanel)


async def sure(pilot: TangyPilot, key: str) -> None:
    """Press a key that asks for confirmation, and say yes."""
    await pilot.press(key)
    await until_shown(pilot, lambda: isinstance(pilot.app.screen, ConfirmDialog))
    asked = pilot.app.screen
    await pilot.press("y")
    await until_shown(pilot, lambda: asked not in pilot.app.screen_stack)


def kinds_of(fault: Fault) -> list[str]:
    """Return the kinds of a fault's moves, in order."""
    return [move.kind for move in fault.moves]


def seen(pilot: TangyPilot) -> str:
    """Return the readable text, on one line."""
    return " ".join(pilot.text().split())


def sentences(screen: PlayScreen) -> list[str]:
    """Return the sentences of the log."""
    return list(screen.query_one(LogView).sentences)
