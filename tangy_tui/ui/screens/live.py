"""The live screen: a game among people, by a robot that is there, with staff who can step in.

Behaviours take their time, so they are carried out beside the screen; nothing else touches the
supervision meanwhile. What must not wait (a STOP, who asks, where the robot is) goes to the robot
itself.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from contextlib import suppress
from math import ceil
from typing import ClassVar

from textual.binding import BindingType
from textual.content import Content
from textual.screen import Screen

from tangy_hw.robot_client.live_world import LiveWorld
from tangy_profiles.errors import TangyError
from tangy_profiles.state import FRONT
from tangy_tui.app.game_commands import AUTONOMY, AskFor, CallAgain, TakeBackCall
from tangy_tui.app.game_controller import TOOK_OVER, GameController
from tangy_tui.app.robot_controls import ENDED
from tangy_tui.app.seats import Seats
from tangy_tui.app.sensing import LinkedSensors
from tangy_tui.app.simulated_devices_world import BenchedWorld
from tangy_tui.app.workspace import Workspace, teacher_name
from tangy_tui.learning.policy import Decision
from tangy_tui.learning.verification import Verified
from tangy_tui.monitoring.supervision import Event, Supervision
from tangy_tui.text.control import autonomy_words
from tangy_tui.ui.dialogs.choose import ChooseDialog, Option
from tangy_tui.ui.dialogs.confirm import ConfirmDialog
from tangy_tui.ui.dialogs.driving import DrivingDialog
from tangy_tui.ui.fault_console import Work
from tangy_tui.ui.messages import Stop
from tangy_tui.ui.panels import KeyLine
from tangy_tui.ui.screens import live_keys, live_words
from tangy_tui.ui.screens.live_cards import LiveCards
from tangy_tui.ui.screens.live_keys import NOT_LIVE
from tangy_tui.ui.screens.live_marks import track
from tangy_tui.ui.screens.play import PlayScreen
from tangy_tui.ui.widgets.room_view import RoomView
from tangy_tui.ui.widgets.status_line import Status

TRACK_SECONDS = 0.2
"""Between two pictures of where the robot is."""
REST_SECONDS = 5.0  # in which what it does is broken off


class LiveScreen(PlayScreen):
    """Games among people. Dismissed with what they added up to."""

    MODE = "live"
    HELP = live_keys.HELP
    BINDINGS: ClassVar[list[BindingType]] = live_keys.BINDINGS

    def __init__(
        self,
        workspace: Workspace,
        supervision: Supervision,
        world: LiveWorld,
        *,
        games: int = 1,
        teacher: str = "",
    ) -> None:
        """Make the screen for games in a world that is there."""
        super().__init__(workspace, supervision, games=games, speed=1, teacher=teacher)
        self._world = world
        self._control = GameController(supervision, teacher or teacher_name(), robot=world)
        self._faults.beside = self._attend_beside
        self._working = False
        self._turn = asyncio.Lock()
        """Whoever has it has the supervision, and the robot."""
        self._seen_doing = ""
        self._frozen = 0.0
        self._seats = Seats(workspace.name)
        self._cards = LiveCards(workspace, supervision, world, self._write)

    def on_mount(self) -> None:
        """Show what is known of the robot, and follow it; the playing screen begins the game."""
        self._show_status()
        if self._world.link.tablet:
            self._write(self._world.link.tablet, "text")
            # the log has no room in a small window, and the tablet may have to be opened again
            self.query_one(RoomView).border_subtitle = Content(self._world.link.tablet_page)
        self.set_interval(TRACK_SECONDS, self._track)

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        """Leave out what cannot be done among people."""
        return action not in NOT_LIVE and super().check_action(action, parameters)

    # ---------------------------------------------------------------------------------- game

    @property
    def _at_rest(self) -> bool:
        """Whether no game goes on, nor begins: for that the robot may drive."""
        return self._supervision.over and not self._working

    async def _begin_game(self) -> list[Event]:
        await self._going.wait()
        if self._world.lost:
            self._write(live_words.LOOKS_ROUND, "warn")
        self._world.link.release()  # staff have said that all is well
        return await self._beside(self._supervision.begin)

    async def _step(self) -> list[Event]:
        try:
            return await self._beside(self._supervision.step)
        finally:
            self._control.confirm(None)

    async def _beside(self, work: Work) -> list[Event]:
        """Do something that takes its time, while the screen lives."""
        async with self._turn:
            self._working = self._faults.busy = True
            self._show_status()
            try:
                return await asyncio.to_thread(work)
            finally:
                self._working = False
                self._faults.busy = self._learning

    async def _attend_beside(self, work: Work) -> list[Event]:
        """Do something about what halts the robot, which may end in another robot process."""
        try:
            return await self._beside(work)
        finally:
            if self._stopped:  # that one was not told
                self._control.robot.stop()

    async def _wait(self, seconds: float) -> None:
        """Wait for nothing: what was done has taken its time."""
        self._left = 0.0

    async def _may_step(self) -> bool:
        """Ask first, where the dial says so, or let staff say what is done."""
        supervision = self._supervision
        if supervision.question is not None or supervision.waiting or supervision.over:
            return True
        state = self._world.observe()
        decision = supervision.policy.decide(state.situation)
        if self._control.taking_over:
            self._control.taking_over = False
            supervision.game.ask(TOOK_OVER, "Say what it does.", "took over")
            if supervision.question is not None:
                await self._ask(supervision.question, wanted=True)
                if supervision.question is not None:  # it was left without an answer
                    supervision.game.withdraw()
                    self._tell_now("Tangy goes on by itself.", "dim")
            return False
        if decision.sure and await self._rests(decision):
            return False
        if not decision.sure or not self._control.asks_about(decision):
            return True
        return await self._confirm(decision, state.attended)

    async def _rests(self, decision: Decision) -> bool:
        """Let a moment pass where it is too early for the next call: staff may step in meanwhile.

        Whoever asks for help in the meantime does not wait for it.
        """
        if not self._control.robot.rests(decision):
            return False
        self._show_status()
        self._nudge.clear()
        with suppress(TimeoutError):
            await asyncio.wait_for(self._nudge.wait(), TRACK_SECONDS)
        return True

    async def _confirm(self, decision: Decision, attended: str | None) -> bool:
        """Ask whether the next behaviour is to be done; if not, ask what else."""
        behaviour = self._workspace.activity.behaviours[decision.behaviour]
        target = attended if behaviour.attends else None
        whom = f" ({self._workspace.name(target)})" if target else ""
        dialog = ConfirmDialog(
            f"Next: {behaviour.name}{whom}?",
            f"{decision.share:.0%} of the votes. After this, i turns the questions off.",
            yes="do it",
            no="say what else",
        )
        does = await self.app.push_screen_wait(dialog)
        self._control.confirm((behaviour.name, target) if does else None)
        if not does and not self._stopped:
            self._control.taking_over = True
        return does and self._going.is_set()

    # ------------------------------------------------------------------------- staff's keys

    def on_stop(self, message: Stop) -> None:
        """Stop the robot itself, before the playing screen draws anything."""
        self._control.robot.stop()

    def action_pause(self) -> None:
        """Pause, or go on; after a STOP this is what lets the robot move again."""
        robot = self._control.robot
        if self._at_rest and robot.frozen:  # in a game that is a fault, and cleared as one
            robot.release(everybody=True)
            self._tell_now(live_words.MAY_MOVE, "dim")
            return
        if self._stopped and self._supervision.halted is None:
            robot.release()
        super().action_pause()

    def action_autonomy(self) -> None:
        """Turn the dial of how much Tangy does of itself."""
        level = AUTONOMY[(AUTONOMY.index(self._control.autonomy) + 1) % len(AUTONOMY)]
        self._control.autonomy = level
        self._tell_now(f"Tangy {autonomy_words(level)}.", "dim")
        self._show_status()

    def action_leave(self) -> None:
        """Take back that staff want to say what is done next, or leave."""
        if self._control.taking_over:
            self._control.taking_over = False
            self._tell_now("Tangy goes on by itself.", "dim")
        else:
            super().action_leave()

    def action_take_over(self) -> None:
        """Let staff say what is done next, as soon as what is done now is over."""
        if self._refused() or self._supervision.over:
            return
        self._control.taking_over = True
        self._tell_now("When this is done, you say what Tangy does next.", "dim")
        self._nudge.set()

    def action_drive(self) -> None:
        """Let staff drive; the game waits meanwhile."""
        if self._working:
            self._tell_now("Not in the middle of what it does: p pauses, ctrl+x stops it.", "warn")
        elif not self._refused():
            self.run_worker(self._drive(), name="drive", group="drive")

    async def _drive(self) -> None:
        going = self._going.is_set()
        self._going.clear()
        self._nudge.set()
        await self.app.push_screen_wait(DrivingDialog(self._world.link))
        self._faults.note("staff drove the robot by keys")
        if going and not self._stopped:
            self._going.set()

    def action_call_again(self) -> None:
        """Say the last number once more."""
        if self._working or self._refused():
            self._tell_now("Not now: Tangy is busy.", "dim")
        elif not self._world.called:
            self._tell_now("No number was called yet.", "dim")
        else:
            self.run_worker(self._call_again(), name="call", group="call")

    async def _call_again(self) -> None:
        self._tell_now("Tangy calls the last number again.", "dim")
        await self._tried(lambda: self._control.robot.do(CallAgain()))

    def action_void_call(self) -> None:
        """Take the last call back."""
        if self._working:
            self._tell_now("Not now: Tangy is busy.", "dim")
        elif not self._world.called:
            self._tell_now("No number was called yet.", "dim")
        else:
            self.run_worker(self._void_call(), name="void", group="call", exclusive=True)

    async def _void_call(self) -> None:
        last = self._world.called[-1]
        label = self._workspace.activity.deck.label(last)
        text = "It counts as not called then, and comes again later."
        dialog = ConfirmDialog(f"Take {label} back?", text, yes="take it back", no="leave it")
        if not await self.app.push_screen_wait(dialog):
            return
        async with self._turn:  # what Tangy began meanwhile comes first
            if self._world.called[-1:] != [last]:
                self._tell_now(f"{label} is not the last any more.", "warn")
                return
            self._control.robot.do(TakeBackCall())
        self._tell_now(f"{label} counts as not called; say so to the group.", "warn")
        self.query_one(RoomView).show(self._world.scene())

    def action_ask_for(self) -> None:
        """Ask for help for somebody."""
        if not self._supervision.over:
            self.run_worker(self._ask_for(), name="ask", group="ask")

    async def _ask_for(self) -> None:
        options = [Option(person.id, person.name) for person in self._workspace.people]
        person = await self.app.push_screen_wait(ChooseDialog("Who needs help?", options))
        if person is not None:
            self._control.robot.do(AskFor(person))
            name = self._workspace.name(person)
            self._tell_now(f"{name} asks for help.", "dim")

    def action_whose_card(self) -> None:
        """Say whose a card is."""
        if not self._supervision.over:
            say = self._cards.say_whose(self.app, self._faults)
            self.run_worker(say, name="card", group="ask")

    async def _tried(self, work: Callable[[], object]) -> None:
        async with self._turn:
            self._working = self._faults.busy = True
            try:
                await asyncio.to_thread(work)
            except TangyError as error:
                self._tell_now(str(error), "warn")
            finally:
                self._working = False
                self._faults.busy = self._learning

    async def _learn(self, answer: Verified) -> list[Event]:
        """Act on an answer, which takes its time, and learn from it."""
        async with self._turn:
            self._working = True
            try:
                return await super()._learn(answer)
            finally:
                self._working = False

    # -------------------------------------------------------------------------------- picture

    def _sensors_screen(self, shown: Callable[[], Status]) -> Screen[None]:
        """Make the screen of the devices that the robot process has."""
        from tangy_tui.ui.screens.sensors import SensorsScreen

        workspace, where = (
            self._workspace,
            "on the bench" if isinstance(self._world, BenchedWorld) else "",
        )
        sensors = LinkedSensors(self._world.link, workspace.robot, workspace.activity.deck)
        return SensorsScreen(
            workspace, sensors, health=sensors.health, shown=shown, live=True, where=where
        )

    def _tell(self, events: list[Event], known: bool = False) -> None:
        """Show events, and who was seen where somebody else usually sits."""
        super()._tell(events, known)
        for line in self._seats.news(events, self._world.sitting):
            self._write(line, "warn")
        self._cards.tell(events)

    def _track(self) -> None:
        """Draw where the robot is, and what it knows of the floor; and tell it that this lives."""
        self._world.link.alive()
        self._cards.tell()
        room = self.query_one(RoomView)
        state = self._world.link.state
        if not state.number:
            return
        if (doing := self._doing()) != self._seen_doing:
            self._seen_doing = doing
            self._show_status()
        if state.frozen and not self._frozen:
            self._write(live_words.WAS_FROZEN.format(state.frozen), "bad")
            self._faults.note(f"the robot process was frozen for {state.frozen:.1f} s")
        self._frozen = state.frozen
        track(room, state)

    async def _come_to_rest(self) -> None:
        """Stop the robot in the midst of what it does, and wait until it has broken that off."""
        self._control.robot.stop(ENDED)
        with suppress(TimeoutError):
            async with asyncio.timeout(REST_SECONDS), self._turn:
                pass

    def _show_status(self) -> None:
        super()._show_status()
        going = self._going.is_set()
        self.query_one(KeyLine).show(*live_keys.keys(going=going, over=self._at_rest))

    def _note(self) -> str:
        """Say what the robot is doing, or what the keys would do next."""
        if self._stopped or self._learning or self._at_rest or not self._going.is_set():
            return super()._note()
        level = self._control.autonomy
        autonomy = live_keys.DIAL[level] if level != AUTONOMY[0] else ""
        return self._doing() or self._until_call() or autonomy

    def _doing(self) -> str:
        """Say what keeps the robot busy on its wheels, "" if nothing does."""
        if self._working and self._world.lost:
            return "finds its place"
        going = self._world.link.state.going
        if not going:
            return ""
        return f"drives to {'the front' if going == FRONT else self._workspace.name(going)}"

    def _until_call(self) -> str:
        left = 0.0 if self._working else self._world.calls_in
        return f"next call in {ceil(left)} s" if left else ""
