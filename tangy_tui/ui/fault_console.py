"""The fault console of the game screens: it polls devices, reports faults, and acts on them.

The robot stops before any of this is drawn. All actions go through the controller of the game, and
are logged before they are shown.
"""

from __future__ import annotations

import asyncio
import gc
from collections.abc import Awaitable, Callable
from typing import Any

from textual.screen import Screen

from tangy_hw.robot_client.live_world import LiveWorld
from tangy_profiles.errors import TangyError
from tangy_sim.worlds.faulty_world import FaultyWorld
from tangy_tui.app.game_commands import Acknowledge, CallExpert, Clear, Reached
from tangy_tui.app.game_controller import GameController
from tangy_tui.app.simulated_devices_world import BenchedWorld
from tangy_tui.app.staff_notes import StaffNote
from tangy_tui.app.workspace import Workspace
from tangy_tui.monitoring.earlier import EarlierPart
from tangy_tui.monitoring.fault import OVER, Diagnosed, Fault, Moved
from tangy_tui.monitoring.games import record_all_well, uncleared
from tangy_tui.monitoring.supervision import Event
from tangy_tui.text.earlier import before_words
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
from tangy_tui.ui.fault_injection import FaultInjection
from tangy_tui.ui.keys import keymap_of
from tangy_tui.ui.staged_recovery import StagedRecovery, takes_time
from tangy_tui.ui.widgets.command_input import CommandInput
from tangy_tui.ui.widgets.fault_banner import ESC_SEEN, SEEN, FaultBanner
from tangy_tui.ui.widgets.fault_list import FaultList
from tangy_tui.ui.widgets.status_line import StatusLine

LOOK_SECONDS = 0.025
"""The interval at which the devices are polled between behaviours, also while the game is paused:
with the time for drawing, a fault is visible within 0.1 s."""

Tell = Callable[[list[Event], bool], None]
"""Shows events; the second argument tells whether the user knows already why a game stopped."""

Work = Callable[[], list[Event]]
Beside = Callable[[Work], Awaitable[list[Event]]]
"""Runs work in the background while the screen stays responsive, and returns its events."""


class FaultConsole:
    """Polls for faults, shows them on panels, and opens a dialog for critical ones."""

    def __init__(
        self,
        screen: Screen[Any],
        workspace: Workspace,
        control: GameController,
        *,
        tell: Tell,
        failed: Callable[[str], None],
    ) -> None:
        """Create the console.

        Args:
            screen: the screen with the panels.
            workspace: the workspace of the game.
            control: the controller of the games.
            tell: shows events on the screen.
            failed: shows that the log could not be written, and pauses.
        """
        self.supervision = control.supervision
        self.ticks = 0
        """The number of polls so far."""
        self.earlier: EarlierPart | None = None
        """What happened in the first game before it was interrupted."""
        self.beside: Beside | None = None
        """Runs commands that take time in a live world; None in a simulated one."""
        self._screen = screen
        self._workspace = workspace
        self._control = control
        self._tell = tell
        self._failed = failed
        self._gave_up = False  # writing the log failed
        self._free = asyncio.Event()
        self._free.set()
        self._dialog: CriticalDialog | None = None
        self._status = ("", "")
        self._made = 0  # moves against faults that are shown
        self.staged = StagedRecovery(control.supervision)
        """The recovery whose outcome is shown later."""
        self._put_away: set[tuple[str, int]] = set()
        self.injection = FaultInjection(control.supervision, control.by)

    def begin(self) -> None:
        """Start polling; exempt all present objects from garbage collection.

        Each full collection took 0.1 to 0.3 s, during which nothing could be drawn.
        """
        gc.collect()
        gc.freeze()
        self._screen.set_interval(LOOK_SECONDS, self.tick)

    def tick(self) -> None:
        """Poll the devices once, and report new faults."""
        self.ticks += 1
        if self._gave_up or self.supervision.over:
            return
        try:
            events = self._control.look()
        except TangyError as error:
            self._gave_up = True
            self._failed(str(error))
            return
        if events is None:  # a behaviour is carried out: an answer may have ended a fault
            events = []
        elif self._dialog is not None:
            self._dialog.look()
        if events or self.supervision.status != self._status or self._made != self._moves:
            self._tell(events, False)

    @property
    def _moves(self) -> int:
        """How many moves were made against faults; Tangy may still be speaking in the last one."""
        return sum(len(fault.moves) for fault in self.supervision.faults)

    def try_again(self) -> None:
        """Resume polling, after writing the log had failed."""
        self._gave_up = False

    # ---------------------------------------------------------------------------- showing

    @property
    def status(self) -> str:
        """The state of the robot in words, with its cause."""
        supervision, halted = self.supervision, self.supervision.halted
        word, cause = self._status = supervision.status
        if halted is not None and supervision.over:
            return f"WARN: {halted.name}, not cleared"
        question = supervision.question
        if word == "ASKS" and question is not None:
            named = (fault.name for fault in supervision.faults if fault.id == question.fault)
            return status_words((word, next(named, "")))
        if (during := self.staged.fault) is not None:
            return status_words(("WARN", during.name))
        return "OK" if halted is None and supervision.over else status_words((word, cause))

    @property
    def asked_about(self) -> Fault | None:
        """The fault that Tangy asks about; None if it asks about an unknown situation."""
        question = self.supervision.question
        wanted = "" if question is None else question.fault
        return next((f for f in self.supervision.faults if f.id == wanted), None)

    def show(self) -> None:
        """Update banner and list, and open the dialog of a fault that halts the robot."""
        screen, supervision = self._screen, self.supervision
        self._made = self._moves
        if supervision.halted is not None and not supervision.over and self._free.is_set():
            self._free.clear()
            screen.run_worker(self._attend(), name="fault", group="fault")
            return  # the dialog hides the rest, which is drawn with its first key
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
                key=with_keys(ESC_SEEN if typing else SEEN, keys) if self.shows(fault) else "",
            )
        else:
            banner.show(())
        faults = screen.query_one(FaultList)
        part = self._before
        earlier = () if part is None else part.faults
        heading = "" if part is None or part.joined else before_words(part.at)
        faults.fill([*map(self.staged.as_shown, supervision.faults)], earlier, heading)
        there = any(not fault.asks_only for fault in (*earlier, *supervision.faults))
        faults.set_class(there, "-there")
        if self._dialog is not None:
            self._dialog.show(screen.query_one(StatusLine).status)

    @property
    def _before(self) -> EarlierPart | None:
        """What happened before the present game was interrupted."""
        return self.earlier if self.supervision.games <= 1 else None

    @property
    def told(self) -> list[Fault]:
        """The faults for the banner, the most urgent first, as they are shown."""
        supervision, during = self.supervision, self.staged.fault
        if supervision.halted is not None and supervision.over:
            return [supervision.halted]
        told = [] if supervision.over else told_in_banner(supervision)
        if during is not None:
            told = [during, *(fault for fault in told if fault is not during)]
        shown = map(self.staged.as_shown, told)
        return [fault for fault in shown if _told_so_far(fault) not in self._put_away]

    def urgent(self, events: list[Event]) -> bool:
        """Return whether a fault needs action at once."""
        moved = {event.move.kind for event in events if isinstance(event, Moved)}
        found = any(isinstance(event, Diagnosed) for event in events)
        if self.supervision.halted is not None:
            return found or bool(moved)
        due = found or "went on" in moved  # people's actions do not end the wait for a retry
        return due and bool(self.supervision.waiting) and not takes_time(moved)

    def dialog(self, id: str) -> FaultDialog | None:
        """Return the dialog with all about a fault; None if there is no such fault."""
        earlier = () if self._before is None else self._before.faults
        fault = next((f for f in (*self.supervision.faults, *earlier) if f.id == id), None)
        if fault is None:
            return None
        game = self.supervision
        label = game.world.activity.behaviour_words
        return FaultDialog(fault, game.book, game.robot, label)

    # ---------------------------------------------------------------------------- halting

    async def free(self) -> None:
        """Wait until no fault halts the robot."""
        await self._free.wait()

    async def _attend(self) -> None:
        """Open the dialogs of the faults that halt the robot, until all are cleared or given up."""
        supervision, app = self.supervision, self._screen.app
        while (fault := supervision.halted) is not None and not supervision.over:
            app.clear_notifications()  # toasts would cover the dialog
            dialog = self._dialog = CriticalDialog(self, fault, supervision.robot)
            dialog.show(self._screen.query_one(StatusLine).status)
            await app.push_screen_wait(dialog)
            while dialog.is_attached:  # noqa: ASYNC110 - there is no event for it
                await asyncio.sleep(0)
        self._dialog = None
        self._free.set()

    @property
    def unseen(self) -> Fault | None:
        """The fault in the banner that staff can say they have seen; not one Tangy asks about."""
        told, asked = self.told, self.asked_about
        if not told or self.supervision.over or (asked is not None and asked.id == told[0].id):
            return None
        return told[0]

    def shows(self, fault: Fault) -> bool:
        """Return whether a fault is still the one in the banner that staff can see."""
        return self.unseen is not None and self.unseen.id == fault.id

    def see(self, fault: Fault) -> bool:
        """Acknowledge the fault in the banner and hide it; False: that is another one now."""
        if not self.shows(fault):
            return False
        (known,) = (one for one in self.supervision.faults if one.id == fault.id)
        self._put_away.add(_told_so_far(self.told[0]))
        if known.status != OVER:
            self.acknowledge(known)
        self.show()
        return True

    async def all_well(self) -> bool:
        """Ask about an uncleared fault of the last game; False: no other game may begin."""
        await self._free.wait()
        fault = uncleared(self._workspace.store)
        if fault is None:
            return True
        dialog = ConfirmDialog(
            ALL_WELL,
            uncleared_words(fault.name),
            yes="all is well: go on",
            no="not yet",
        )
        if not await self._screen.app.push_screen_wait(dialog):
            return False
        record_all_well(self._workspace.store, fault, self._control.by)
        return True

    def acknowledge(self, fault: Fault | None = None) -> None:
        """Acknowledge a fault (default: the one that halts the robot)."""
        self._apply(Acknowledge("" if fault is None else fault.id))

    def _apply(self, command: Acknowledge | CallExpert | Clear) -> None:
        self._tell(self._carried_out(command), False)

    def _carried_out(self, command: Acknowledge | CallExpert | Clear) -> list[Event]:
        """Return the events of a command.

        Raises:
            TangyError: it could not be logged, so it was not carried out.
        """
        told = self._control.carry_out(command)
        return [one for one in told if not isinstance(one, StaffNote)]

    @property
    def takes_time(self) -> bool:
        """Whether commands about a fault take time."""
        return self.beside is not None

    @property
    def restarts(self) -> bool:
        """Whether calling the expert also restarts the robot process."""
        world = self.supervision.world
        link = world.link if isinstance(world, LiveWorld) else None
        return link is not None and bool(link.silent or link.state.failed)

    @property
    def simulated(self) -> bool:
        """Whether the expert is simulated, like the room."""
        return isinstance(self.supervision.world, FaultyWorld | BenchedWorld)

    async def call_expert(self) -> None:
        """Call the expert for the fault that halts the robot, and recover what Tangy can."""
        await self._do(CallExpert())

    def reached(self) -> None:
        """Log that staff reached the expert."""
        self._control.carry_out(Reached())

    async def clear(self) -> None:
        """Clear the fault, if it is acknowledged and gone, so that the robot continues."""
        await self._do(Clear())

    async def _do(self, command: CallExpert | Clear) -> None:
        if self.beside is None:
            self._apply(command)
        else:
            self._tell(await self.beside(lambda: self._carried_out(command)), False)

    def give_up(self) -> None:
        """End the halted game."""
        self._tell(self._control.give_up(), True)


def _told_so_far(fault: Fault) -> tuple[str, int]:
    """Return the id and the number of requests: each new request shows the fault again."""
    return fault.id, sum(bool(move.speech) for move in fault.moves)
