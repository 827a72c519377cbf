"""The live screen: a game among people with a live robot, in which staff can intervene.

Behaviours take time, so they run in a thread; nothing else uses the supervision meanwhile. Urgent
matters (a STOP, requests, the robot's position) go directly to the robot.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from math import ceil
from time import monotonic
from typing import ClassVar, TypeVar

from textual.binding import BindingType
from textual.content import Content
from textual.screen import Screen

from tangy_hw.robot_client.declared_live_world import DeclaredLiveWorld
from tangy_hw.robot_client.live_world import LiveWorld
from tangy_profiles.declared.typed_observations import about, sayable
from tangy_profiles.errors import TangyError
from tangy_profiles.game_world import BENCH, GameWorld
from tangy_profiles.past_game import PastGame
from tangy_profiles.state import FRONT
from tangy_tui.app.command_grammar import read_telling
from tangy_tui.app.fault_commands import Result
from tangy_tui.app.game_commands import (
    AT_ONCE,
    AUTONOMY,
    AskFor,
    CallAgain,
    ChangePace,
    GameCommand,
    GiveBack,
    GoOn,
    SetAutonomy,
    TakeBackCall,
    TakeOver,
)
from tangy_tui.app.seats import Seats
from tangy_tui.app.sensing import LinkedSensors
from tangy_tui.app.simulated_devices_world import BenchedWorld
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.verification import Verified
from tangy_tui.monitoring.supervision import Event, Supervision
from tangy_tui.text.control import (
    BUSY,
    NOT_WHILE_WORKING,
    WAITS_FOR_YOU,
    WAITS_SHORT,
    WHO_NEEDS_HELP,
    waits_words,
)
from tangy_tui.text.live_games import LOOKS_ROUND, MAY_MOVE, frozen_words
from tangy_tui.text.live_news import seated_words
from tangy_tui.text.missing_devices import missing_words
from tangy_tui.text.tablet import screen_words
from tangy_tui.ui.dialogs.choose import ChooseDialog, Option
from tangy_tui.ui.dialogs.driving import DrivingDialog
from tangy_tui.ui.dialogs.staff_line import TellDialog
from tangy_tui.ui.fault_console import Work
from tangy_tui.ui.panels import KeyLine
from tangy_tui.ui.screens import live_keys
from tangy_tui.ui.screens.live_cards import LiveCards
from tangy_tui.ui.screens.live_keys import CARDS_ONLY, FACTS_ONLY, NOT_LIVE
from tangy_tui.ui.screens.live_marks import track
from tangy_tui.ui.screens.play import PlayScreen
from tangy_tui.ui.screens.play_panels import STAFF
from tangy_tui.ui.widgets.room_view import RoomView
from tangy_tui.ui.widgets.status_line import Status

TRACK_SECONDS = 0.2
SLOW_TRACK_SECONDS = 1.0
"""The interval between two updates of the robot's position."""
STAFF_SECONDS = 1.0
"""The interval between two updates of the staff panel."""
ANSWERS_SECONDS = 0.7  # for a command, before staff are told that it has to wait
REST_SECONDS = 5.0  # in which the current behaviour is aborted

MODES: dict[GameWorld, str] = {BENCH: "bench"}
"""The worlds with another name on the status line."""

T = TypeVar("T")


class LiveScreen(PlayScreen):
    """Games among people. Dismissed with their totals."""

    mode = "live"
    FIRST = STAFF
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
        past: PastGame | None = None,
    ) -> None:
        """Create the screen for games in a live world; a past game is resumed first."""
        super().__init__(
            workspace,
            supervision,
            games=games,
            speed=1,
            teacher=teacher,
            robot=world,
            past=past,
        )
        self.world = world
        self.mode = MODES.get(world.played_in, self.mode)
        self._faults.beside = self._attend_beside
        self.picture.counts = lambda: bool(self._until_call()) and not self.at_rest
        self.working = 0  # number of running and queued commands
        self._seen_doing = ""
        self._frozen = 0.0
        self._tracked = 0.0
        self._seats = Seats()
        self._cards = LiveCards(workspace, supervision, world, self._write)

    def on_mount(self) -> None:
        """Show the robot's state, and poll it; the base screen begins the game."""
        self.show_status()
        self.set_interval(STAFF_SECONDS, self.show_staff)
        workspace = self._workspace
        for told in missing_words(workspace.robot, workspace.activity):
            self._write(told, "text")
        if (link := self.world.link).screen:
            self._write(screen_words(link.screen, link.code), "text")
            # a small window hides the log, and the tablet may have to be connected again
            self.query_one(RoomView).border_subtitle = Content(self.world.link.tablet_page)
        self.set_interval(TRACK_SECONDS, self.track)

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        """Disable actions that are not available among people."""
        none = CARDS_ONLY if not self._has_cards else () if self.world.eyes else FACTS_ONLY
        return action not in (*NOT_LIVE, *none) and super().check_action(action, parameters)

    @property
    def _has_cards(self) -> bool:
        return not isinstance(self.world, DeclaredLiveWorld)

    # ---------------------------------------------------------------------------------- game

    @property
    def at_rest(self) -> bool:
        """Whether no game runs or begins; in a game, the robot may drive."""
        return self._supervision.over and not self.working

    async def _begin_game(self) -> list[Event]:
        if not (self.control.stopped and self.control.past is not None):
            await self._until_going()
        if self.world.lost:
            self._write(LOOKS_ROUND, "warn")
        return await super()._begin_game()

    async def _beside(self, work: Callable[[], T]) -> T:
        """Run slow work in a thread while the screen stays responsive."""
        self.working += 1
        self.show_status()
        try:
            return await asyncio.to_thread(work)
        finally:
            self.working -= 1

    async def _attend_beside(self, work: Work) -> list[Event]:
        """Act on the fault that halts the robot, which may restart the robot process."""
        try:
            return await self._beside(work)
        finally:
            if self.control.stopped:  # the new process does not know of the stop
                self.control.robot.stop()

    async def _wait(self, seconds: float) -> None:
        """Do not wait: a live behaviour has already taken its time."""
        self._left = 0.0

    # ------------------------------------------------------------------------- staff's keys

    def _do(self, command: GameCommand) -> None:
        """Carry out a command, in the background if it has to wait for its turn."""
        if isinstance(command, AT_ONCE):
            super()._do(command)
        else:
            self.run_worker(self._do_beside(command), name="command", group="command")

    async def _do_beside(self, command: GameCommand) -> None:
        done = asyncio.create_task(self._beside(lambda: self.control.apply(command)))
        if not (await asyncio.wait({done}, timeout=ANSWERS_SECONDS))[0]:
            self._tell_now(waits_words(command, self._workspace.name), "dim")
            self.picture.show_scene(0, drive=False, pace=0)
        self._take(await done)

    def action_pause(self) -> None:
        """Pause, or continue; after a STOP, let the robot move again."""
        if self._frozen_at_rest and not self.control.stopped:
            self.go_on()
        else:
            super().action_pause()

    def go_on(self) -> None:
        """Continue; between two games, let a robot move that was frozen."""
        if self._frozen_at_rest:
            self._do(GoOn())
            self._tell_now(MAY_MOVE, "dim")
        else:
            super().go_on()

    @property
    def _frozen_at_rest(self) -> bool:
        return self.at_rest and self.control.robot.frozen  # in a game that is a fault

    def action_autonomy(self) -> None:
        """Cycle through the levels of autonomy."""
        level = AUTONOMY[(AUTONOMY.index(self.control.autonomy.level) + 1) % len(AUTONOMY)]
        self._do(SetAutonomy(level))

    def action_speed(self, by: int) -> None:
        """Call faster or slower."""
        self._do(ChangePace(1 if by > 0 else -1))
        self.show_staff()

    def action_leave(self) -> None:
        """Hand control back to Tangy, or leave."""
        if self.control.taking_over:
            self._do(GiveBack())
        else:
            super().action_leave()

    def action_take_over(self) -> None:
        """Hand control to staff as soon as the current behaviour ends."""
        if not self._supervision.over:
            self._do(TakeOver())

    def action_drive(self) -> None:
        """Let staff drive while the game waits."""
        if self.working:
            self._tell_now(NOT_WHILE_WORKING, "warn")
        elif not self._refused():
            self.run_worker(self._drive(), name="drive", group="drive")

    async def _drive(self) -> None:
        with self.control.driving():
            await self.app.push_screen_wait(DrivingDialog(self.world.link))

    def action_call_again(self) -> None:
        """Say the last number once more."""
        if self.working or self._refused():
            self._tell_now(BUSY, "dim")
        else:
            self._do(CallAgain())

    def action_void_call(self) -> None:
        """Take the last call back, after the current behaviour."""
        self.do_sure(TakeBackCall())

    async def _carry_out(self, command: GameCommand) -> None:
        if isinstance(command, AT_ONCE):
            await super()._carry_out(command)
        else:
            await self._do_beside(command)
            self.query_one(RoomView).show(self.control.plan.scene)

    def action_ask_for(self) -> None:
        """Ask for help on behalf of a person."""
        if not self._supervision.over:
            self.run_worker(self._ask_for(), name="ask", group="ask")

    async def _ask_for(self) -> None:
        away = self.control.plan.away
        here = [person for person in self._workspace.people if person.id not in away]
        options = [Option(person.id, person.name) for person in here]
        person = await self.app.push_screen_wait(ChooseDialog(WHO_NEEDS_HELP, options))
        if person is not None:
            self._do(AskFor(person))

    def action_whose_card(self) -> None:
        """Ask staff who owns a card."""
        if not self._supervision.over:
            say = self._cards.say_whose(self.app, self.control, self.do_sure)
            self.run_worker(say, name="card", group="ask")

    def action_tell(self) -> None:
        """Report what a person answers or does."""
        if not self._supervision.over:
            self.run_worker(self._tell_of(), name="tell", group="ask")

    async def _tell_of(self) -> None:
        world, workspace = self.world, self._workspace
        if isinstance(world, DeclaredLiveWorld):
            person, words = about(world.ahead), tuple(sayable(world.ahead))
        else:
            person, words = self.control.robot.asks_about
        dialog = TellDialog(workspace.name(person) if person else "", words)
        line = await self.app.push_screen_wait(dialog)
        if line is not None:
            try:
                self._do(read_telling(line, lambda wanted: workspace.find_person(wanted).id))
            except TangyError as error:
                self._tell_now(str(error), "warn")

    async def _learn(self, answer: Verified) -> list[Result]:
        """Carry out an answer, which takes time, and learn from it."""
        self.working += 1
        try:
            return await super()._learn(answer)
        finally:
            self.working -= 1

    # -------------------------------------------------------------------------------- picture

    def _sensors_screen(self, shown: Callable[[], Status]) -> Screen[None]:
        """Create the screen of the robot process's devices."""
        from tangy_tui.ui.screens.sensors import SensorsScreen

        workspace, where = (
            self._workspace,
            "on the bench" if isinstance(self.world, BenchedWorld) else "",
        )
        sensors = LinkedSensors(self.world.link, workspace.robot, workspace.activity.deck)
        return SensorsScreen(
            workspace, sensors, health=sensors.health, shown=shown, live=True, where=where
        )

    def _tell(self, events: list[Event], known: bool = False) -> None:
        """Show events, and people at another person's seat."""
        super()._tell(events, known)
        for seated in self._seats.news(events, self.world.sitting):
            self._write(seated_words(seated, self._workspace.name), "warn")
        self._cards.tell(events)

    def track(self) -> None:
        """Draw the robot's pose and its estimates; send it a heartbeat."""
        self.world.link.alive()
        self._cards.tell()
        room = self.query_one(RoomView)
        state = self.world.link.state
        if not state.number:
            return
        if (doing := self._doing()) != self._seen_doing:
            self._seen_doing = doing
            self.show_status()
        if state.frozen and not self._frozen:
            self._write(frozen_words(state.frozen), "bad")
            self.control.note("robot frozen", detail=f"{state.frozen:.1f}")
        self._frozen = state.frozen
        due = SLOW_TRACK_SECONDS if getattr(self.app, "slow_link", False) else 0.0
        if (now := monotonic()) - self._tracked >= due:
            self._tracked = now
            track(room, state)

    async def _come_to_rest(self) -> None:
        """Abort the robot's current behaviour, and wait until it has stopped."""
        self.control.break_off()
        await asyncio.to_thread(self.control.wait_for_turn, REST_SECONDS)

    def show_status(self) -> None:
        """Show the state of the game, and the keys that have an effect now."""
        super().show_status()
        going = self.control.going
        self.query_one(KeyLine).show(
            *live_keys.keys(
                going=going,
                over=self.at_rest,
                cards=self._has_cards,
                tells=self.world.eyes is not None,
            )
        )

    def _note(self) -> str:
        """Describe what the robot is doing, or the effect of the keys."""
        if self.control.stopped or self._learning or self.at_rest or not self.control.going:
            return super()._note()
        if self.control.phase == "asking":
            return WAITS_FOR_YOU
        level = self.control.autonomy.level
        autonomy = live_keys.DIAL[level] if level != AUTONOMY[0] else ""
        return self._doing() or self._until_call() or autonomy

    def _doing(self) -> str:
        """Describe the robot's current drive, "" if it is not driving."""
        if self.working and self.world.lost:
            return "finds its place"
        state = self.world.link.state
        going = state.going
        if not going:
            return ""
        if waits := WAITS_SHORT.get(state.yields_to):
            return waits
        return f"drives to {'the front' if going == FRONT else self._workspace.name(going)}"

    def _until_call(self) -> str:
        counts = self.control.phase == "running" and not self.working
        left = self.world.calls_in if counts else 0.0
        return f"next call in {ceil(left)} s" if left else ""
