"""Live games for tests of screens: a fake robot process, and a program."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from dataclasses import replace
from time import sleep
from typing import TYPE_CHECKING, Any

from tangy_hw.robot_client.live_world import LiveWorld
from tangy_hw.robot_process.stop_latch import STAFF
from tangy_profiles.health import OK, DeviceState, Fact, Reading
from tangy_tui.app.game_commands import Pause
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.policy import Policy
from tangy_tui.ui.dialogs.staff_line import NextDialog
from tangy_tui.ui.program import Program
from tangy_tui.ui.screens.live import LiveScreen
from tangy_tui.ui.terminal import TerminalKind
from tests.hw.links import FakeLink
from tests.pilot.ears import FakeEars
from tests.support.clocks import StillClock
from tests.support.live_worlds import live_world
from tests.support.waiting import until_shown

if TYPE_CHECKING:
    from tests.pilot.conftest import TangyPilot

PEOPLE = ("user1", "user2", "user3", "user4")


class HeldLink(FakeLink):
    """A robot whose behaviours end only when the test allows it."""

    def __init__(self, people: tuple[str, ...] = PEOPLE) -> None:
        super().__init__(people)
        self.free = True
        self.stamps = 0
        """The number of the screen's signs of life."""
        self.most = 10_000
        """It speaks this many lines, then completes nothing more."""
        self.holds = False
        """Whether a behaviour has begun and is held."""
        self.held_by: set[str] = set()
        """The owners of stops that are not released."""
        self.released: list[str] = []
        """The people who released a stop, "" for all."""

    def alive(self) -> None:
        self.stamps += 1

    def wait(self, asked: Any, seconds: float = 0.0) -> bool:
        free = self.free and len(self.said) <= self.most
        self.holds = not free
        sleep(0.005)  # else a game would be over before a key is pressed
        return free or any(told.startswith("stop") for told in self.told)

    def stop(self, why: str, by: str = STAFF) -> None:
        super().stop(why, by)
        self.held_by.add(by)

    def release(self, by: str = "") -> None:
        super().release(by)
        self.released.append(by)
        self.held_by -= {by} if by else self.held_by

    def ail(self, device: str, state: DeviceState = OK, **facts: Fact) -> None:
        """Let a device report this from now on."""
        ill = Reading(device, 0.0, state, facts)
        health = tuple(ill if r.device == device else r for r in self.state.health)
        self.state = replace(self.state, health=health)

    def be_let(self) -> None:
        """Wait for permission, with a limit: a blocked screen could not give it."""
        for _ in range(1000):
            if self.free:
                break
            sleep(0.005)

    def restart(self) -> None:
        """Become a new healthy robot process, when the test allows it."""
        self.be_let()
        self.silent = ""
        self.state = replace(self.state, health=FakeLink(PEOPLE).state.health, failed="")


def held_world(
    workspace: Workspace, link: HeldLink, kind: type[LiveWorld] = LiveWorld
) -> LiveWorld:
    """Make the world of a robot whose time stands still between actions."""
    return live_world(workspace, link, kind, pace=0.0)


def live_program(
    workspace: Workspace, world: LiveWorld, policy: Policy, ears: FakeEars | None = None
) -> Program:
    """Make a program that opens with the live screen, and with these ears, if any."""
    supervision = workspace.supervision(policy, 1, asks=True, world=world)

    async def start(program: Program) -> None:
        await program.push_screen(LiveScreen(workspace, supervision, world, teacher="ann"))

    return Program(
        workspace,
        start,
        kind=TerminalKind(full_screen=True),
        clock=StillClock(),
        ears=None if ears is None else ears.ears,
    )


def live(pilot: TangyPilot) -> LiveScreen:
    return next(s for s in pilot.app.screen_stack if isinstance(s, LiveScreen))


async def settled(pilot: TangyPilot, drawn: Callable[[], str]) -> None:
    """Wait until the screen is unchanged for five looks."""
    looks: list[str] = []
    async with asyncio.timeout(20):
        while len(looks) < 5 or len(set(looks[-5:])) > 1:
            await pilot.pause(0.05)
            looks.append(drawn())


async def paused_after(pilot: TangyPilot, link: HeldLink, steps: int) -> None:
    """Let it take some steps, and pause."""
    await until_shown(pilot, lambda: live(pilot).control.supervision.steps >= steps)
    live(pilot).control.apply(Pause())
    await until_shown(pilot, lambda: not live(pilot).working)


async def until_a_call_is_held(
    pilot: TangyPilot, link: HeldLink, world: LiveWorld, calls: int = 1
) -> None:
    """Wait until Tangy, after some calls, says a number, and does not come to its end."""
    await until_shown(pilot, lambda: len(world.called_now) >= calls)
    while not (world.calling and len(link.said) > link.most):
        link.most = len(link.said)
        await pilot.pause(0.05)


async def ask_for_the_choice(pilot: TangyPilot) -> None:
    """Open the line for what Tangy does next, while it finishes its step."""
    await pilot.press("o")
    await until_shown(pilot, lambda: isinstance(pilot.app.screen, NextDialog))
