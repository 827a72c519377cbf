"""The playing screen: Tangy facilitates, pauses, asks, and halts."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from contextlib import suppress
from typing import TYPE_CHECKING, ClassVar, TypeVar

from textual.binding import BindingType

from tangy_profiles.errors import TangyError
from tangy_tui.app.game_commands import GoOn, OneStep, Pause, StopRobot
from tangy_tui.app.game_controller import GameController
from tangy_tui.app.staff_notes import StaffNote
from tangy_tui.app.workspace import Workspace
from tangy_tui.interaction.feedback import void_last
from tangy_tui.interaction.game_events import GameEnded
from tangy_tui.interaction.tally import Tally
from tangy_tui.monitoring.supervision import Event, Supervision
from tangy_tui.text import games as text
from tangy_tui.text.control import noted_words
from tangy_tui.text.interruptions import ENDED
from tangy_tui.ui.base import on_top
from tangy_tui.ui.dialogs.confirm import ConfirmDialog
from tangy_tui.ui.dialogs.message import MessageDialog
from tangy_tui.ui.messages import Stop
from tangy_tui.ui.panels import LOW, WIDE, KeyLine
from tangy_tui.ui.screens import play_keys
from tangy_tui.ui.screens.play_keys import faster, keys
from tangy_tui.ui.screens.play_staff import PlayStaff
from tangy_tui.ui.widgets.room_view import RoomView

if TYPE_CHECKING:
    from tangy_hw.robot_client.live_world import LiveWorld
    from tangy_profiles.past_game import PastGame

T = TypeVar("T")

IDLE_SECONDS = 0.2
"""The interval between two attempts while it is too early for the next behaviour."""


class PlayScreen(PlayStaff):
    """Games by the learnt policy, watched at any speed. Dismissed with their totals."""

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
        teacher: str = "",
        robot: LiveWorld | None = None,
        past: PastGame | None = None,
    ) -> None:
        """Create the screen.

        Args:
            workspace: the workspace of the games.
            supervision: runs the games.
            games: the number of games.
            speed: a ratio to real time.
            teacher: who answers Tangy's questions (default: the workspace's teacher).
            robot: the world of a real robot.
            past: an interrupted game to resume first.
        """
        who = teacher or workspace.teacher

        def void(person: str) -> bool:
            return void_last(workspace.store, supervision.game.game, person, who)

        control = GameController(supervision, who, robot=robot, void=void, past=past)
        super().__init__(workspace, control)
        self.games = games
        self._speed = speed
        self._past = past
        self.tally = Tally()
        self.skipping = False
        self._played = 0  # the tally counts a game that staff end only a moment later
        self._ended = False  # whether staff chose to leave the game
        self._left = 0.0  # s left of a drive that STOP or a fault interrupted
        self._halted = False
        self._leaving = False

    def on_mount(self) -> None:
        """Show the state, and begin."""
        loop = asyncio.get_running_loop()
        self.control.changed = lambda: loop.call_soon_threadsafe(self.nudge.set)
        self._let_look_on()
        self.picture.begin()
        self._faults.begin()
        self._voice.begin(self.app)
        self.action_panel(self.FIRST)
        self.run_worker(self._play(), name="game", exclusive=True)

    # ---------------------------------------------------------------------------------- keys

    def action_pause(self) -> None:
        """Pause, or continue; after a STOP, let the robot move again."""
        self.do_sure(Pause() if self.control.going else GoOn())

    def go_on(self) -> None:
        """Continue after a pause or a STOP."""
        stopped, self._halted = self.control.stopped, False
        self._faults.try_again()
        self._do(GoOn())
        if stopped and (asking := self._asking) is not None:
            asking.hold(False)

    def action_one_step(self) -> None:
        """Carry out one step, then pause."""
        if not self._supervision.over:
            self._do(OneStep())

    def action_speed(self, by: int) -> None:
        """Play faster or slower."""
        self._speed = faster(self._speed, by)
        self.nudge.set()
        self.show_status()

    def action_skip(self) -> None:
        """Play the rest of the game at once, after confirmation."""
        if not (self._refused() or self._supervision.over):
            self._sure(text.SKIP, text.SKIP_DETAIL, self._skip)

    def _skip(self) -> None:
        if self._refused() or self._supervision.over:
            return
        self.skipping = True
        self._voice.hush()
        self._do(GoOn())

    def action_next(self) -> None:
        """Play one more game, now or after this one, after confirmation."""
        if not self._refused():
            self._sure(text.ANOTHER, self._another_detail(), self._another)

    def _another(self) -> None:
        if self._refused():
            return
        self.games += 1
        if self._supervision.over and self.tally.games + 1 == self.games:
            self._halted = False
            self._do(GoOn())
            self.run_worker(self._play(), name="game", exclusive=True)
        else:
            self._tell_now(text.following_words(self.games - self.tally.games - 1), "dim")

    def action_leave(self) -> None:
        """Go back by one step, give up a question, or leave; in mid-game ask first."""
        if self.went_back():
            return
        if (asking := self._asking) is not None:
            asking.ask_to_give_up()
        elif self.at_rest:
            self.leave(self.tally)
        elif not self._leaving:
            self.run_worker(self._leave(), name="leave")

    async def _leave(self) -> None:
        """Ask whether to leave in mid-game; the game waits, which is no pause of staff."""
        self._leaving = True
        detail = self._leave_detail(self.games - self.tally.games - 1)
        dialog = ConfirmDialog(text.LEAVE, detail, yes="leave", no="go on")
        with self._holding() as answered:
            leaves = await self.app.push_screen_wait(dialog)
            answered()
            self._leaving = False
            if leaves:
                self._ended = True
                self.control.note("ended")
                self.control.end_joined(ENDED)
                await self._come_to_rest()
                if not self._supervision.over:
                    self.tally.add(self.control.abandon())
                self.leave(self.tally)

    async def _come_to_rest(self) -> None:
        """Let the current behaviour end first."""

    def on_unmount(self) -> None:
        """Leave a game that nobody ended to be resumed."""
        self.control.changed = lambda: None
        if not self.control.joined:  # an onlooker may stop the robot while it is switched on again
            self._workspace.door.detach(self.control)
        if not self._supervision.over:
            end = self.control.abandon if self._ended else self.control.interrupt
            end()
        self._voice.hush()

    def on_stop(self, message: Stop) -> None:
        """Stop the robot: no further behaviour runs until staff continue."""
        if getattr(self.app, "leaving", False):
            self.control.hold(message.reason)  # nobody pressed STOP
            return
        self.control.apply(StopRobot())  # before drawing
        self._show_stopped()

    def _show_stopped(self) -> None:
        self.skipping = False
        self._voice.hush()
        self.nudge.set()
        self._write(noted_words(StaffNote("stopped"), self._workspace.name, by_keys=True), "bad")
        if self._asking is not None:
            self._asking.hold(True)
        self.show_status()

    @property
    def at_rest(self) -> bool:
        """Whether no game is running."""
        return self._supervision.over

    # ---------------------------------------------------------------------------------- game

    async def _play(self) -> None:
        while self._played < self.games:
            if not await self._may_begin():
                return
            try:
                await self._play_game()
                self._played += 1
            except TangyError as error:  # logging failed, so pause
                await self._hold(str(error))
            if self.control.joined:
                await on_top(self)  # staff may be answering a question, or on another page
                await self.switch_off()
                await on_top(self)
                self.leave(self.tally)
                return

    async def switch_off(self) -> None:
        """Switch the robot off for a new person, while the screen still shows the game."""

    async def _may_begin(self) -> bool:
        """Ask before a game begins after one with an uncleared fault."""
        if self.control.past is not None:
            self.show_staff()
        if not self._supervision.over or await self._faults.all_well():
            return True
        self.games = self.tally.games
        if not self._supervision.games:
            self.leave(self.tally)
        return False

    async def _play_game(self) -> None:
        """Play one game, or the rest of one that was paused by a failure."""
        control, supervision = self.control, self._supervision
        if supervision.over:
            self._tell(await self._begin_game())
        owed = 0.0  # s of game time still to pass after a recovery
        while not supervision.over:
            await self._until_going()
            if supervision.halted is not None:
                self.skipping = False
                await self._faults.free()
                continue
            if self._left and not self.skipping and not control.single:
                await self._wait(self._left)  # the robot continues its drive
                continue
            alone = self.skipping or control.single
            if not alone and not await self._voice.heard(self._speed, self.nudge):
                continue
            before = supervision.seconds
            events, rest = await self._beside(self.control.next), list[Event]()
            if not self.skipping and control.going:
                events, rest = self._faults.staged.parts(events)
            self._take([*control.plan.late_notes(), *events])
            if control.proposal is not None:
                await self._propose(control.proposal)
            if supervision.question is not None:
                await self._ask(supervision.question)
            owed = max(owed, supervision.seconds - before)
            if supervision.halted is not None:
                self._left = owed if self._drives else 0.0
                owed = 0.0
            if self.skipping or self._faults.urgent(events):
                await asyncio.sleep(0)  # let the screen handle keys
            elif events:
                await self._wait(owed)
                owed = 0.0
            else:
                await self._nudged(IDLE_SECONDS)
            if rest:
                self._faults.staged.done()
                self._tell(rest)
        if self.skipping:
            self.action_panel("posteriors")  # as the question promised
        self.skipping = False

    async def _until_going(self) -> None:
        """Wait while the game is paused, or the robot stopped."""
        while not self.control.going and not self.control.joined:
            self.nudge.clear()
            await self.nudge.wait()

    async def _nudged(self, seconds: float) -> None:
        """Wait for a nudge, up to some s."""
        self.nudge.clear()
        with suppress(TimeoutError):
            await asyncio.wait_for(self.nudge.wait(), seconds)

    async def _begin_game(self) -> list[Event]:
        return await self._beside(self.control.begin)

    async def _beside(self, work: Callable[[], T]) -> T:
        """Run work of the game; a simulated one takes no time."""
        return work()

    def _stand_still(self, reason: str) -> None:
        """Pause after a failure, until staff retry."""
        self._halted = True
        self.skipping = False
        self.control.apply(Pause())
        self._write(text.halted_words(reason), "bad")
        self.show_status()

    async def _hold(self, reason: str) -> None:
        """Pause after a failure, tell why, and wait until staff retry."""
        self._stand_still(reason)
        await self._say_why(reason, text.TRIES_AGAIN)
        await self._until_going()

    def _fail(self, reason: str) -> None:
        """Pause after a failure between two steps, and tell why."""
        self._stand_still(reason)
        self.run_worker(self._say_why(reason, text.TRIES_AGAIN), name="why", group="why")

    async def _wait(self, seconds: float) -> None:
        """Let a step's time (in the game, in s) pass; a change of speed ends the wait early."""
        clock = asyncio.get_running_loop().time
        speed, until = self._speed, clock() + seconds / self._speed
        await self._nudged(seconds / speed)
        held = self.control.stopped or self._supervision.halted is not None
        caught = held and self._drives
        self._left = max(0.0, until - clock()) * speed if caught else 0.0

    @property
    def _drives(self) -> bool:
        return self.query_one(RoomView).going is not None

    def _tell(self, events: list[Event], known: bool = False) -> None:
        """Show events; a dialog tells why a game stopped, unless that is `known`."""
        self.tally.add(events)
        if self._faults.urgent(events):
            self.nudge.set()  # do not wait for the rest of the step's time
        self.picture.tell(events, 0 if self.skipping else self._speed)
        if not self.skipping:
            self._voice.tell(events, self._speed if self.control.going else 0)
        for event in events:
            if isinstance(event, GameEnded) and event.stopped is not None and not known:
                self._halted = True
                self.run_worker(self._say_why(event.stopped, text.LEADS_HOME), name="why")
        if events and (not self.skipping or self._supervision.over):
            self.show_staff()
        self.show_status()

    async def _say_why(self, reason: str, then: str) -> None:
        """Tell why a game could not continue, at every window size."""
        dialog = MessageDialog(text.stopped_words(reason, self._told(then)), title=text.STOPPED)
        await self.app.push_screen_wait(dialog)

    # -------------------------------------------------------------------------------- status

    def show_status(self) -> None:
        """Show the state of the game on the status line."""
        asking = self._asking
        if asking is not None and self._supervision.question is None and not self._learning:
            asking.withdraw()
        halted = self._supervision.halted is not None
        self.query_one(RoomView).hold(self.control.stopped or halted)
        robot = self._faults.status
        if self._halted and self._supervision.halted is None:
            robot = "ASKS"
        if self.control.stopped:
            robot = "STOPPED" if self._supervision.halted is None else f"STOPPED, {robot}"
        self.picture.show_status(robot, self._note(), self.mode)
        going = self.control.going
        self.query_one(KeyLine).show(*keys(going=going, over=self.at_rest))
        if asking is not None:
            asking.show_keys(going=going)
        self._faults.show()

    def _note(self) -> str:
        """Describe the effect of the keys, or the speed."""
        if self.control.stopped:
            return self._told(text.GOES_ON)
        if self._learning:
            return text.DOES_WHAT_YOU_SAID
        if self.at_rest:
            return self._told(text.PLAYS_AGAIN) if self._supervision.games else ""
        return f"x{self._speed:g}" if self.control.going else "paused"
