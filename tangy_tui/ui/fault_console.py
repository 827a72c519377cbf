"""The fault console of the game screens: it polls devices, reports faults, and acts on them.

The robot has stopped before anything of this is drawn; what is done here goes through the
controller of the game, and is in the log before it is told.
"""

from __future__ import annotations

import asyncio
import gc
from collections.abc import Awaitable, Callable
from dataclasses import replace
from typing import Any

from textual.screen import Screen

from tangy_hw.robot_client.live_world import LiveWorld
from tangy_profiles.errors import TangyError
from tangy_sim.worlds.faulty_world import FaultyWorld
from tangy_sim.worlds.injection import KINDS
from tangy_tui.app.game_commands import Acknowledge, CallExpert, Clear, Reached, StaffNote
from tangy_tui.app.game_controller import GameController
from tangy_tui.app.injected import possible_kinds
from tangy_tui.app.simulated_devices_world import BenchedWorld
from tangy_tui.app.workspace import Workspace
from tangy_tui.monitoring.fault import (
    OPEN,
    OVER,
    Diagnosed,
    Fault,
    Moved,
)
from tangy_tui.monitoring.games import uncleared
from tangy_tui.monitoring.supervision import Event
from tangy_tui.text import injections
from tangy_tui.text.faults import (
    banner_words,
    doing_words,
    said_words,
    status_words,
    told_in_banner,
)
from tangy_tui.text.halts import ALL_WELL, uncleared_words
from tangy_tui.text.keys import with_keys
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.dialogs.confirm import ConfirmDialog
from tangy_tui.ui.dialogs.critical import CriticalDialog
from tangy_tui.ui.dialogs.fault import FaultDialog
from tangy_tui.ui.dialogs.inject import InjectDialog, comes_later
from tangy_tui.ui.keys import keymap_of
from tangy_tui.ui.widgets.command_bar import CommandInput
from tangy_tui.ui.widgets.fault_banner import ESC_SEEN, SEEN, FaultBanner
from tangy_tui.ui.widgets.fault_list import FaultList
from tangy_tui.ui.widgets.status_line import StatusLine

LOOK_SECONDS = 0.025
"""How often the devices are looked at between behaviours, also while the game stands still: so
that, with the time that drawing takes, what is wrong is seen within 0.1 s."""

Tell = Callable[[list[Event], bool], None]
"""Shows events; the second is whether it is known already why a game was stopped."""

Work = Callable[[], list[Event]]
Beside = Callable[[Work], Awaitable[list[Event]]]
"""Does something beside the screen, which lives meanwhile, and returns what it tells."""

_TAKES_TIME = ("asked", "remedied")
"""The moves of which it takes time to see what comes."""


class FaultConsole:
    """Looks for faults all the time, shows them on panels, and puts the critical ones."""

    def __init__(
        self,
        screen: Screen[Any],
        workspace: Workspace,
        control: GameController,
        *,
        tell: Tell,
        failed: Callable[[str], None],
    ) -> None:
        """Make the console.

        Args:
            screen: that it is on.
            workspace: what it belongs to.
            control: of the games.
            tell: shows events on the screen.
            failed: says that the log could not be written, and stands still.
        """
        self.supervision = control.supervision
        self.ticks = 0
        """How often the timer has looked."""
        self.beside: Beside | None = None
        """Does what takes its time: the world is there, and not worked out at once."""
        self._screen = screen
        self._workspace = workspace
        self._control = control
        self._tell = tell
        self._failed = failed
        self._gave_up = False  # the log could not be written
        self._free = asyncio.Event()
        self._free.set()
        self._dialog: CriticalDialog | None = None
        self._status = ("", "")
        self._during: tuple[Fault, int] | None = None
        self._put_away: set[tuple[str, int]] = set()
        self._asked_for: dict[str, int] = {}
        self._game = 0

    def begin(self) -> None:
        """Start polling; objects loaded so far are frozen out of garbage collection.

        Going through all of it took 0.1 to 0.3 s each time, in which nothing could be drawn.
        """
        gc.collect()
        gc.freeze()
        self._screen.set_interval(LOOK_SECONDS, self.tick)

    def tick(self) -> None:
        """Check the devices once, and report new faults."""
        self.ticks += 1
        if self._gave_up or self.supervision.over:
            return
        try:
            events = self._control.look()
        except TangyError as error:
            self._gave_up = True
            self._failed(str(error))
            return
        if events is None:
            return
        if self._dialog is not None:
            self._dialog.look()
        if events or self.supervision.status != self._status:
            self._tell(events, False)

    def try_again(self) -> None:
        """Look on, after the log could not be written."""
        self._gave_up = False

    # ---------------------------------------------------------------------------- showing

    @property
    def status(self) -> str:
        """How the robot is, in words, with the cause."""
        supervision, halted = self.supervision, self.supervision.halted
        word, cause = self._status = supervision.status
        if halted is not None and supervision.over:
            return f"WARN: {halted.name}, not cleared"
        question = supervision.question
        if word == "ASKS" and question is not None:
            named = (fault.name for fault in supervision.faults if fault.id == question.fault)
            return status_words((word, next(named, "")))
        if self._during is not None and halted is None:
            return status_words(("WARN", self._during[0].name))
        return "OK" if halted is None and supervision.over else status_words((word, cause))

    @property
    def asked_about(self) -> Fault | None:
        """The fault about which Tangy asks, if it is not the situation that nobody has shown."""
        question = self.supervision.question
        wanted = "" if question is None else question.fault
        return next((f for f in self.supervision.faults if f.id == wanted), None)

    def show(self) -> None:
        """Show banner and list as they are now, and put what halts the robot."""
        screen, supervision = self._screen, self.supervision
        if supervision.halted is not None and not supervision.over and self._free.is_set():
            self._free.clear()
            screen.run_worker(self._attend(), name="fault", group="fault")
            return  # it hides the rest, which is drawn with the first key in it
        banner, told = screen.query_one(FaultBanner), self.told
        if told:
            fault = told[0]
            typing = isinstance(screen.focused, CommandInput)
            keys = keymap_of(screen.app)
            banner.show(
                tuple(map(clean, banner_words(fault, doing_words(fault, supervision.book)))),
                said=clean(said_words(fault)),
                more=len(told) - 1,
                critical=fault.critical,
                key="" if supervision.over else with_keys(ESC_SEEN if typing else SEEN, keys),
            )
        else:
            banner.show(())
        faults = screen.query_one(FaultList)
        faults.fill([self._as_shown(fault) for fault in supervision.faults])
        faults.set_class(any(not fault.asks_only for fault in supervision.faults), "-there")
        if self._dialog is not None:
            self._dialog.show(screen.query_one(StatusLine).status)

    @property
    def told(self) -> list[Fault]:
        """The faults of which the banner tells, the most urgent first, as they are shown."""
        supervision, during = self.supervision, self._during
        if supervision.halted is not None and supervision.over:
            return [supervision.halted]
        told = [] if supervision.over else told_in_banner(supervision)
        if during is not None and supervision.halted is None:
            told = [during[0], *(fault for fault in told if fault is not during[0])]
        shown = (self._as_shown(fault) for fault in told)
        return [fault for fault in shown if _told_so_far(fault) not in self._put_away]

    def _as_shown(self, fault: Fault) -> Fault:
        """Return a fault as it was before what came of the last move, which is yet to be shown."""
        if self._during is None or self._during[0] is not fault or self.supervision.halted:
            return fault
        return replace(fault, moves=fault.moves[: self._during[1]], status=OPEN)

    def parts(self, events: list[Event]) -> tuple[list[Event], list[Event]]:
        """Split recovery events into those begun and their outcomes, which show later."""
        for n, event in enumerate(events):
            if isinstance(event, Moved) and event.move.kind in _TAKES_TIME and events[n + 1 :]:
                if self.supervision.halted is not None or self.supervision.question is not None:
                    break
                count = next(k for k, m in enumerate(event.fault.moves, 1) if m is event.move)
                self._during = (event.fault, count)
                return events[: n + 1], events[n + 1 :]
        return events, []

    def urgent(self, events: list[Event]) -> bool:
        """Return whether a fault needs action before any time passes."""
        moved = {event.move.kind for event in events if isinstance(event, Moved)}
        found = any(isinstance(event, Diagnosed) for event in events)
        if self.supervision.halted is not None:
            return found or bool(moved)
        due = found or "went on" in moved  # what people do ends no wait between two tries
        return due and bool(self.supervision.waiting) and moved.isdisjoint(_TAKES_TIME)

    def done(self) -> None:
        """Say that what came of it may be shown."""
        self._during = None

    def dialog(self, id: str) -> FaultDialog | None:
        """Return the dialog that tells of one fault in full; None: there is no such fault."""
        fault = next((f for f in self.supervision.faults if f.id == id), None)
        if fault is None:
            return None
        return FaultDialog(fault, self.supervision.book, self.supervision.robot)

    # ---------------------------------------------------------------------------- halting

    async def free(self) -> None:
        """Wait until nothing halts the robot any more."""
        await self._free.wait()

    async def _attend(self) -> None:
        """Put what halts the robot, one fault after the other, until all is cleared or given up."""
        supervision, app = self.supervision, self._screen.app
        while (fault := supervision.halted) is not None and not supervision.over:
            app.clear_notifications()  # they would lie over it
            dialog = self._dialog = CriticalDialog(self, fault, supervision.robot)
            dialog.show(self._screen.query_one(StatusLine).status)
            await app.push_screen_wait(dialog)
            while dialog.is_attached:  # noqa: ASYNC110 - there is no event for it
                await asyncio.sleep(0)
        self._dialog = None
        self._free.set()

    def see(self) -> bool:
        """Take away what the banner tells, because it was seen; False: it tells of nothing."""
        told = self.told
        if not told or self.supervision.over:
            return False
        fault = next(f for f in self.supervision.faults if f.id == told[0].id)
        if fault.status != OVER:
            self.acknowledge(fault)
        self._put_away.add(_told_so_far(told[0]))
        self.show()
        return True

    async def all_well(self) -> bool:
        """Ask about what nobody cleared in the last game; False: no other one may begin."""
        await self._free.wait()
        fault = uncleared(self._workspace.store)
        if fault is None:
            return True
        dialog = ConfirmDialog(
            ALL_WELL,
            uncleared_words(fault.name),
            yes="all is well: begin the game",
            no="do not begin",
        )
        return await self._screen.app.push_screen_wait(dialog)

    def acknowledge(self, fault: Fault | None = None) -> None:
        """Say that a fault (default: the one that halts the robot) was seen."""
        self._apply(Acknowledge("" if fault is None else fault.id))

    def _apply(self, command: Acknowledge | CallExpert | Clear) -> None:
        self._tell(self._carried_out(command), False)

    def _carried_out(self, command: Acknowledge | CallExpert | Clear) -> list[Event]:
        """Return what came of a command.

        Raises:
            TangyError: it could not be logged, so it was not done.
        """
        told = self._control.carry_out(command)
        return [one for one in told if not isinstance(one, StaffNote)]

    @property
    def takes_time(self) -> bool:
        """Whether it takes its time to do something about the fault."""
        return self.beside is not None

    @property
    def restarts(self) -> bool:
        """Whether calling the expert starts the robot process again."""
        world = self.supervision.world
        link = world.link if isinstance(world, LiveWorld) else None
        return link is not None and bool(link.silent or link.state.failed)

    @property
    def simulated(self) -> bool:
        """Whether the expert is simulated, as all else in the room."""
        return isinstance(self.supervision.world, FaultyWorld | BenchedWorld)

    async def call_expert(self) -> None:
        """Note that the expert is needed for what halts the robot, and do what Tangy can."""
        await self._do(CallExpert())

    def reached(self) -> None:
        """Say that the expert was reached."""
        self._control.carry_out(Reached())

    async def clear(self) -> None:
        """Let the robot go on, if the fault was seen and is gone."""
        await self._do(Clear())

    async def _do(self, command: CallExpert | Clear) -> None:
        if self.beside is None:
            self._apply(command)
        else:
            self._tell(await self.beside(lambda: self._carried_out(command)), False)

    def give_up(self) -> None:
        """End the game that is halted."""
        self._tell(self._control.give_up(), True)

    # ---------------------------------------------------------------- bringing faults about

    def refuses(self) -> str:
        """Say why no fault can be brought about now; empty if one can."""
        if not self.simulated:
            return injections.NOT_SIMULATED
        return injections.NO_GAME if self.supervision.over else ""

    async def inject(self) -> tuple[str, bool]:
        """Choose a fault, and inject or remove it.

        Returns:
            What was done ("": nothing), and whether it is seen at once what came of it.
        """
        world = self.supervision.world
        if not isinstance(world, FaultyWorld | BenchedWorld):
            return injections.NOT_SIMULATED, False
        if self._game != self.supervision.games:
            self._game = self.supervision.games
            self._asked_for.clear()
        to_come = [
            kind
            for kind, came in self._asked_for.items()
            if kind not in world.present and all(kind != late for _, late in world.came[came:])
        ]
        book = self.supervision.book
        possible = possible_kinds(rule.code for rule in book.rules)
        called = {name: book.rule(KINDS[name].code).name for name in possible}
        dialog = InjectDialog(world.present, to_come, called)
        kind = await self._screen.app.push_screen_wait(dialog)
        if kind is None or self.refuses():
            return "", False
        if kind in world.present or kind in to_come:
            there = kind in world.present
            world.lift(kind)
            self.supervision.note("fault lifted", self._control.by, detail=kind)
            self._asked_for.pop(kind, None)
            return injections.lifted_words(kind), there
        self._asked_for[kind] = len(world.came)
        self.supervision.note("fault injected", self._control.by, detail=kind)
        world.inject(kind)
        if comes_later(kind):
            return injections.comes_later_words(kind), False
        return injections.injected_words(kind), True


def _told_so_far(fault: Fault) -> tuple[str, int]:
    """Return what a fault is told by: each time that Tangy asks somebody it is told anew."""
    return fault.id, sum(bool(move.speech) for move in fault.moves)
