"""Staff at the live screen: their keys and commands.

Behaviours take time, so commands that wait for their turn are carried out in a thread.
"""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from dataclasses import replace
from typing import TypeVar

from tangy_hw.robot_client.declared_live_world import DeclaredLiveWorld
from tangy_hw.robot_client.live_world import LiveWorld
from tangy_profiles.declared.typed_observations import about, sayable
from tangy_profiles.errors import TangyError
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
from tangy_tui.app.staff_notes import REFUSALS, StaffNote
from tangy_tui.learning.verification import Verified
from tangy_tui.text.control import (
    NOT_WHILE_WORKING,
    WHO_NEEDS_HELP,
    noted_words,
    waits_words,
)
from tangy_tui.text.live_games import MAY_MOVE
from tangy_tui.text.typed_commands import NEXT_OVER, next_dropped
from tangy_tui.ui.dialogs.choose import ChooseDialog, Option
from tangy_tui.ui.dialogs.driving import DrivingDialog
from tangy_tui.ui.dialogs.staff_line import NextDialog, TellDialog
from tangy_tui.ui.screens.live_cards import LiveCards
from tangy_tui.ui.screens.play import PlayScreen
from tangy_tui.ui.screens.play_view import ViewSource
from tangy_tui.ui.screens.question_panel import AskingPanel
from tangy_tui.ui.widgets.room_view import RoomView

ANSWERS_SECONDS = 0.7  # for a command, before staff are told that it has to wait
LOOK_AGAIN_SECONDS = 0.05
"""The interval at which an answer typed ahead looks for Tangy's question."""

T = TypeVar("T")


class LiveStaff(PlayScreen):
    """Carries out what staff want while a robot is among people."""

    world: LiveWorld
    working = 0
    """The number of running and queued commands."""
    _cards: LiveCards
    _typed_next = ""
    """What staff have typed that Tangy does next, until it asks."""

    @property
    def at_rest(self) -> bool:
        """Whether no game runs or begins; in a game, the robot may drive."""
        return self._supervision.over and not self.working

    async def _beside(self, work: Callable[[], T]) -> T:
        """Run slow work in a thread while the screen stays responsive."""
        self.working += 1
        self.show_status()
        try:
            return await asyncio.to_thread(work)
        finally:
            self.working -= 1

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
            self.show_staff()
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
        elif self.control.joined:
            if not self.went_back():
                self._take([StaffNote("joining")])
        else:
            super().action_leave()

    def action_take_over(self) -> None:
        """Hand control to staff as soon as the current behaviour ends; they can type at once."""
        if (asking := self._asking) is not None and asking.wanted:
            self.action_type()
        elif not self._supervision.over:
            self._do(TakeOver())
            if self.control.taking_over:
                dialog = NextDialog(self._typed_next)
                said = self._say_next(dialog, self.ask(dialog))
                self.run_worker(said, name="next", group="next", exclusive=True)

    async def _say_next(self, dialog: NextDialog, answered: asyncio.Future[str | None]) -> None:
        """Let staff type what Tangy does next, and answer its question with that."""
        closed = False
        while not answered.done():
            if not self.control.asks_next:  # the game is over, or Tangy goes on
                closed = True
                dialog.answer(dialog.typed)
            elif self._asks_openly is not None and not dialog.typed:
                dialog.answer("")  # the line of the question takes the keys
            await asyncio.sleep(LOOK_AGAIN_SECONDS)
        said = answered.result()
        if said is None:
            self._typed_next = ""
            self._let_tangy_go_on()
            return
        self._typed_next = said
        self.show_staff()
        while said and self.control.asks_next:
            if (asking := self._asks_openly) is not None:
                self._typed_next = ""
                asking.take(said)
                return
            await asyncio.sleep(LOOK_AGAIN_SECONDS)
        self._typed_next = ""
        over = self._supervision.over
        if said:
            self._tell_now(next_dropped(said, over=over), "warn")
        elif closed and over:
            self._tell_now(NEXT_OVER, "warn")

    def _source(self) -> ViewSource:
        """Return what the view for staff is shown with."""
        return replace(super()._source(), typed=self._typed_next)

    @property
    def _asks_openly(self) -> AskingPanel | None:
        """The panel of Tangy's question, once it takes answers."""
        asking = self._asking
        return asking if asking is not None and asking.is_open else None

    def _let_tangy_go_on(self) -> None:
        if (asking := self._asking) is not None:
            asking.ask_to_give_up()
        elif self.control.taking_over:
            self._do(GiveBack())

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
        """Say the last number once more, after the current behaviour."""
        if not self._refused():
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
            away = self.control.plan.away
            here = [person for person in self._workspace.people if person.id not in away]
            options = [Option(person.id, person.name) for person in here]
            chosen = self.ask(ChooseDialog(WHO_NEEDS_HELP, options))
            self.run_worker(self._ask_for(chosen), name="ask", group="ask")

    async def _ask_for(self, chosen: Awaitable[str | None]) -> None:
        if (person := await chosen) is not None:
            self._do(AskFor(person))

    def action_whose_card(self) -> None:
        """Ask staff who owns a card."""
        if not self._supervision.over:
            whom = self.ask(self._cards.people())
            say = self._cards.say_whose(self.app, whom, self.control, self.do_sure)
            self.run_worker(say, name="card", group="ask")

    def action_tell(self) -> None:
        """Report what a person answers or does."""
        if not self._supervision.over:
            self.ask(self._telling())

    def _telling(self) -> TellDialog:
        world, workspace = self.world, self._workspace
        if isinstance(world, DeclaredLiveWorld):
            person, words = about(world.ahead), tuple(sayable(world.ahead))
        else:
            person, words = self.control.robot.asks_about
        return TellDialog(self._report, workspace.name(person) if person else "", words)

    def _report(self, line: str) -> None:
        """Tell Tangy what staff report about a person; raises TangyError if it is refused."""
        workspace = self._workspace
        command = read_telling(line, lambda wanted: workspace.find_person(wanted).id)
        done = self.control.apply(command)
        for one in done:
            if isinstance(one, StaffNote) and one.kind in REFUSALS:
                raise TangyError(noted_words(one, workspace.name, by_keys=True))
        self._take(done)

    async def _learn(self, answer: Verified) -> list[Result]:
        """Carry out an answer, which takes time, and learn from it."""
        self.working += 1
        try:
            return await super()._learn(answer)
        finally:
            self.working -= 1
