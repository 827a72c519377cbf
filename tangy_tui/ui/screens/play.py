"""The playing screen: Tangy facilitates by itself; pausing, asking, and standing still."""

from __future__ import annotations

import asyncio
from contextlib import suppress
from typing import ClassVar

from textual.binding import BindingType

from tangy_profiles.errors import TangyError
from tangy_tui.app.workspace import Workspace, teacher_name
from tangy_tui.interaction.game_events import GameEnded
from tangy_tui.interaction.tally import Tally
from tangy_tui.monitoring.supervision import Event, Supervision
from tangy_tui.ui.closing import close, close_after
from tangy_tui.ui.dialogs.confirm import ConfirmDialog
from tangy_tui.ui.dialogs.message import MessageDialog
from tangy_tui.ui.messages import Stop
from tangy_tui.ui.panels import LOW, WIDE, KeyLine
from tangy_tui.ui.screens import play_keys
from tangy_tui.ui.screens.play_asking import PlayAsking
from tangy_tui.ui.screens.play_keys import (
    ASKS_FIRST,
    NOT_IN_THE_DEMO,
    STOPPED_FIRST,
    TRIES_AGAIN,
    faster,
    keys,
)
from tangy_tui.ui.widgets.fault_list import FaultList
from tangy_tui.ui.widgets.room_view import RoomView
from tangy_tui.ui.widgets.transcript import Transcript


class PlayScreen(PlayAsking):
    """Games by the learnt policy, watched at any speed. Dismissed with what they added up to."""

    CSS_PATH = "play.tcss"
    HORIZONTAL_BREAKPOINTS = WIDE
    VERTICAL_BREAKPOINTS = LOW
    HELP = play_keys.HELP
    BINDINGS: ClassVar[list[BindingType]] = play_keys.BINDINGS

    def __init__(
        self,
        workspace: Workspace,
        supervision: Supervision,
        *,
        games: int = 1,
        speed: float = 20,
        leave_after: float | None = None,
        teacher: str = "",
    ) -> None:
        """Make the screen.

        Args:
            workspace: what it belongs to.
            supervision: what runs the games.
            games: how many are played one after another.
            speed: times life.
            leave_after: seconds after the last game at which the screen closes by itself.
            teacher: who answers where Tangy asks (default: whoever is logged in).
        """
        super().__init__(workspace, supervision, teacher or teacher_name())
        self._games = games
        self._speed = speed
        self._leave_after = leave_after
        self._tally = Tally()
        self._going = asyncio.Event()
        self._going.set()
        self._nudge = asyncio.Event()
        self._skipping = False
        self._single = False
        self._left = 0.0  # s of a drive that STOP or a fault broke off
        self._halted = False
        self._leaving = False

    def on_mount(self) -> None:
        """Show what is known, and begin."""
        self._picture.begin()
        self._faults.begin()
        self._voice.begin(self.app)
        self.action_panel("transcript")
        self.run_worker(self._play(), name="game", exclusive=True)

    # ---------------------------------------------------------------------------------- keys

    def action_pause(self) -> None:
        """Pause, or go on; after a STOP this is what lets the robot move again."""
        if self._going.is_set():
            self._going.clear()
        else:
            stopped, self._stopped = self._stopped, False
            self._halted = False
            self._faults.busy = self._learning
            self._going.set()
            if stopped:
                self._faults.note("the robot was let go on")
            if stopped and (asking := self._asking) is not None:
                asking.hold(False)
        self._nudge.set()
        self._show_status()

    def action_one_step(self) -> None:
        """Do one step and pause."""
        if self._refused() or self._supervision.over:
            return
        self._single = True
        self._going.set()
        self._nudge.set()

    def action_speed(self, by: int) -> None:
        """Play faster or slower."""
        self._speed = faster(self._speed, by)
        self._nudge.set()
        self._show_status()

    def action_skip(self) -> None:
        """Play the rest of the game at once."""
        if self._refused() or self._supervision.over:
            return
        self._skipping = True
        self._voice.hush()
        self._going.set()
        self._nudge.set()

    def action_again(self) -> None:
        """Play one more game, now or after this one."""
        if self._refused():
            return
        self._games += 1
        if self._supervision.over and self._tally.games + 1 == self._games:
            self._halted = False
            self._going.set()
            self.run_worker(self._play(), name="game", exclusive=True)
        else:
            more = self._games - self._tally.games - 1
            follow = "Another game" if more == 1 else f"{more} more games"
            self._tell_now(f"{follow} will follow.", "dim")

    def action_leave(self) -> None:
        """Let go of a chosen step, give up what is asked, or go back; in mid-game it asks."""
        steps, faults = self.query_one(Transcript), self.query_one(FaultList)
        if faults.has_focus and faults.filtered:
            faults.unfilter()
        elif steps.has_focus and steps.chosen is not None:
            steps.release()
        elif (asking := self._asking) is not None:
            asking.ask_to_give_up()
        elif self._at_rest or self._leave_after is not None:
            close(self, self._tally)
        elif not self._leaving:
            self.run_worker(self._leave(), name="leave")

    async def _leave(self) -> None:
        """Ask whether to leave in mid-game; the game waits meanwhile."""
        self._leaving = True
        going = self._going.is_set()
        self._going.clear()
        dialog = ConfirmDialog(
            "Leave in the middle of the game?",
            "It ends here, and the log says so. What was learnt from it stays.",
            yes="leave",
            no="go on",
        )
        leaves = await self.app.push_screen_wait(dialog)
        self._leaving = False
        if leaves:
            await self._come_to_rest()
            self._end_game()
            close(self, self._tally)
        elif going and not self._stopped and not self._halted:
            self._going.set()

    async def _come_to_rest(self) -> None:
        """Let what is being done come to an end before the game does."""

    def _end_game(self) -> None:
        """Let the log say that a game was left."""
        if not self._learning:
            with suppress(TangyError):  # who leaves is not held up by a log that is full
                self._tally.add(self._supervision.leave())

    def on_unmount(self) -> None:
        """End a game whose program is being left."""
        self._end_game()
        self._voice.hush()

    def on_stop(self, message: Stop) -> None:
        """Stop the robot: nothing more is executed until somebody lets it go on."""
        self._skipping = False
        self._stopped = True
        self._voice.hush()
        self._going.clear()
        self._nudge.set()
        self._write("STOP. Press p to go on.", "bad")
        self._faults.note("the robot was stopped")
        if self._asking is not None:
            self._asking.hold(True)
        self._show_status()

    @property
    def _at_rest(self) -> bool:
        """Whether no game goes on."""
        return self._supervision.over

    def _refused(self) -> bool:
        """Say, after a STOP or while Tangy asks, what has to be done first."""
        if self._stopped:
            self._tell_now(STOPPED_FIRST, "warn")
        elif self._asking is not None:
            self._tell_now(ASKS_FIRST, "warn")
        return self._stopped or self._asking is not None

    # ---------------------------------------------------------------------------------- game

    async def _play(self) -> None:
        while self._tally.games < self._games:
            if not await self._may_begin():
                return
            try:
                await self._play_game()
            except TangyError as error:  # the log could not be written, so nothing more is done
                await self._hold(str(error))
        if self._leave_after is not None:
            await close_after(self, self._tally, self._leave_after)

    async def _may_begin(self) -> bool:
        """Ask before a game begins after one that ended with what nobody cleared."""
        begun = not self._supervision.over or self._leave_after is not None
        if begun or await self._faults.all_well():
            return True
        self._games = self._tally.games
        if not self._supervision.games:
            close(self, self._tally)
        return False

    async def _play_game(self) -> None:
        """Play one game, or the rest of one that was held."""
        supervision = self._supervision
        if supervision.over:
            self._tell(await self._begin_game())
        owed = 0.0  # s of the game that are to pass after what is done against a fault
        while not supervision.over:
            await self._going.wait()
            if supervision.halted is not None:
                self._skipping = False
                await self._faults.free()
                continue
            if self._left and not self._skipping and not self._single:
                await self._wait(self._left)  # it walks on to where it was going
                continue
            alone = self._skipping or self._single
            if not alone and not await self._voice.heard(self._speed, self._nudge):
                continue
            if self._single:
                self._single = False
                self._going.clear()
            if not await self._may_step():
                continue
            before = supervision.seconds
            events, rest = await self._step(), list[Event]()
            if not self._skipping and self._going.is_set():
                events, rest = self._faults.parts(events)
            self._tell(events)
            if supervision.question is not None:
                await self._ask(supervision.question)
            owed = max(owed, supervision.seconds - before)
            if supervision.halted is not None:
                self._left = owed if self._drives else 0.0
                owed = 0.0
            if self._skipping or self._faults.urgent(events):
                await asyncio.sleep(0)  # let the screen and the keys live
            else:
                await self._wait(owed)
                owed = 0.0
            if rest:
                self._faults.done()
                self._tell(rest)
        self._skipping = False

    async def _begin_game(self) -> list[Event]:
        return self._supervision.begin()

    async def _may_step(self) -> bool:
        """Say whether the next behaviour may be done now."""
        return True

    async def _step(self) -> list[Event]:
        return self._supervision.step()

    def _stand_still(self, reason: str) -> None:
        """Do nothing more, after a failure, until somebody lets it try again."""
        self._halted = True
        self._skipping = False
        self._going.clear()
        self._write(f"{reason} p tries again.", "bad")
        self._show_status()

    async def _hold(self, reason: str) -> None:
        """Stand still after a failure until somebody lets it try again."""
        self._stand_still(reason)
        await self._say_why(reason, TRIES_AGAIN)
        await self._going.wait()

    def _fail(self, reason: str) -> None:
        """Stand still after a failure that came between two steps."""
        self._stand_still(reason)
        self.run_worker(self._say_why(reason, TRIES_AGAIN), name="why", group="why")

    async def _wait(self, seconds: float) -> None:
        """Let a step's time (in the game, in s) pass; a key that changes the pace ends it early."""
        self._nudge.clear()
        clock = asyncio.get_running_loop().time
        speed, until = self._speed, clock() + seconds / self._speed
        with suppress(TimeoutError):
            await asyncio.wait_for(self._nudge.wait(), seconds / speed)
        held = self._stopped or self._supervision.halted is not None
        caught = held and self._drives
        self._left = max(0.0, until - clock()) * speed if caught else 0.0

    @property
    def _drives(self) -> bool:
        return self.query_one(RoomView).going is not None

    def _tell(self, events: list[Event], known: bool = False) -> None:
        """Show events; where a game was stopped a dialog says why, unless that is `known`."""
        self._tally.add(events)
        if self._faults.urgent(events):
            self._nudge.set()  # the rest of the step's time is not waited for
        self._picture.tell(events, 0 if self._skipping else self._speed)
        if not self._skipping:
            self._voice.tell(events, self._speed if self._going.is_set() else 0)
        for event in events:
            if isinstance(event, GameEnded) and event.stopped is not None and not known:
                self._halted = True
                text = "Esc leads home, where t teaches; g plays another game."
                self.run_worker(self._say_why(event.stopped, text), name="why")
        self._show_status()

    async def _say_why(self, reason: str, then: str) -> None:
        """Tell why a game could not go on, at every size of the window."""
        if self._leave_after is None:
            text = f"{reason}\n{then}"
            await self.app.push_screen_wait(MessageDialog(text, title="The game stopped"))

    # -------------------------------------------------------------------------------- status

    def action_inject(self) -> None:
        """Bring about a fault in the simulated room, or lift one."""
        if self._leave_after is not None:
            self._tell_now(NOT_IN_THE_DEMO, "warn")
        else:
            super().action_inject()

    def _show_status(self) -> None:
        asking = self._asking
        if asking is not None and self._supervision.question is None and not self._learning:
            asking.withdraw()
        halted = self._supervision.halted is not None
        self.query_one(RoomView).hold(self._stopped or halted)
        robot = self._faults.status
        if self._halted and self._supervision.halted is None:
            robot = "ASKS"
        if self._stopped:
            robot = "STOPPED" if self._supervision.halted is None else f"STOPPED, {robot}"
        self._picture.show_status(robot, self._note(), self.MODE)
        going = self._going.is_set()
        self.query_one(KeyLine).show(*keys(going=going, over=self._at_rest))
        if asking is not None:
            asking.show_keys(going=going)
        self._faults.show()

    def _note(self) -> str:
        """Say what the keys would do next, or how fast it goes."""
        if self._stopped:
            return "p goes on"
        if self._learning:
            return "learning"
        if self._at_rest:
            return "g plays again" if self._supervision.games else ""
        return f"x{self._speed:g}" if self._going.is_set() else "paused"
