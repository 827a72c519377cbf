"""Staff at the playing screen: their commands, and Tangy's questions to them."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import replace
from functools import partial

from textual.timer import Timer

from tangy_profiles.errors import TangyError
from tangy_profiles.room import SEAT
from tangy_tui.app.command_grammar import command_reader, read_command
from tangy_tui.app.confirmations import Confirmation, needed_confirmation
from tangy_tui.app.fault_commands import Result
from tangy_tui.app.freeze_watch import LOOK_SECONDS, FreezeGuard
from tangy_tui.app.game_commands import (
    Accept,
    CallAgain,
    ChangePace,
    ClaimCard,
    ComesIn,
    Confirm,
    GameCommand,
    GiveBack,
    GoesAway,
    GoOn,
    Joins,
    Pause,
    StopRobot,
    Tell,
    asked_for,
)
from tangy_tui.app.game_controller import GameController
from tangy_tui.app.inquiry_grammar import Question
from tangy_tui.app.joining import NEW, Admission
from tangy_tui.app.offered import offered
from tangy_tui.app.screen_grammar import Perform
from tangy_tui.app.similar_commands import nearest_commands
from tangy_tui.app.staff_notes import REFUSALS, Proposal, StaffNote
from tangy_tui.app.typed_line import Typed, commands_in, read_typed
from tangy_tui.app.workspace import Workspace
from tangy_tui.interaction.game_events import Unsure
from tangy_tui.language.steering import steering_of
from tangy_tui.learning.verification import Verified
from tangy_tui.text.confirmations import called_meanwhile, calling_words, confirmation_words
from tangy_tui.text.control import ACCEPT, NOT_ACCEPTABLE, confirmed_words, noted_words
from tangy_tui.text.freezes import DETAIL, GO_ON, STAY, question
from tangy_tui.text.game_help import example_words
from tangy_tui.text.typed_commands import (
    CLAIM,
    IS_AWAY,
    IS_HERE,
    SOMEBODY_NEW,
    TITLE,
    WHO_IS_HERE,
    claim_words,
)
from tangy_tui.text.watching import stopped_by_guest
from tangy_tui.ui.base import can_perform, perform
from tangy_tui.ui.claiming import ask_whose
from tangy_tui.ui.dialogs.choose import ChooseDialog, Option
from tangy_tui.ui.dialogs.confirm import ConfirmDialog
from tangy_tui.ui.dialogs.staff_line import CommandDialog
from tangy_tui.ui.game_voice import GameVoice
from tangy_tui.ui.joining import ask_where, ask_who_joins
from tangy_tui.ui.screens.play_answers import PlayAnswers
from tangy_tui.ui.screens.question_panel import AskingPanel, NoAnswer

PACE_SECONDS = 1.0
"""The delay after the last change of pace before the new pace is shown."""
SEEN_ANYWAY = ("paused", "goes on", "one step")
"""Notes that the key line and the status line show anyway."""


class PlayStaff(PlayAnswers):
    """Sends commands to the controller, and Tangy's questions to staff."""

    def __init__(self, workspace: Workspace, control: GameController) -> None:
        """Create the panels of a controller's games."""
        super().__init__(workspace, control)
        self._voice = GameVoice(workspace)
        self._learning = False
        self._pace_told: Timer | None = None
        self.nudge = asyncio.Event()
        """Set when the game should no longer wait for a step's time."""

    def show_status(self) -> None:
        """Update the status."""
        raise NotImplementedError

    def _show_stopped(self) -> None:
        """Show that the robot was stopped."""
        raise NotImplementedError

    def _let_look_on(self) -> None:
        """Let onlookers on other consoles follow these games, and show who stops the robot."""
        loop = asyncio.get_running_loop()

        def stopped(guest: str) -> None:
            if not self.is_running:  # the robot is being switched on again, without this screen
                return
            self._show_stopped()
            self._tell_now(stopped_by_guest(guest, self.control.by), "bad")

        self._workspace.door.attach(
            self.control, lambda who: loop.call_soon_threadsafe(stopped, who)
        )
        guard = FreezeGuard(self.control, lambda s: loop.call_soon_threadsafe(self._stood_still, s))
        self.set_interval(LOOK_SECONDS, guard.look)
        if self.control.stopped_by:  # while the robot was switched on again
            stopped(self.control.stopped_by)
        elif self.control.stopped:
            self._show_stopped()

    def _stood_still(self, seconds: float) -> None:
        """Ask whether to continue, after the program was frozen for some s."""
        self.show_status()
        self._write(question(seconds), "warn")
        self.run_worker(self._ask_to_go_on(seconds), name="freeze", group="freeze", exclusive=True)

    async def _ask_to_go_on(self, seconds: float) -> None:
        dialog = ConfirmDialog(question(seconds), DETAIL, yes=GO_ON, no=STAY)
        if await self.app.push_screen_wait(dialog) and self.control.phase == "paused":
            self._do(GoOn())

    def action_pause(self) -> None:
        """Pause or continue."""
        raise NotImplementedError

    def go_on(self) -> None:
        """Continue after a pause or a STOP."""
        raise NotImplementedError

    def do_sure(self, command: GameCommand) -> None:
        """Carry out a command; first ask about one that cannot be undone."""
        asked = needed_confirmation(command, self.control)
        if (refused := self.control.refuses(command)) is not None:
            self._take([refused])
        elif asked is not None:
            self.run_worker(self._make_sure(asked), name="sure", group="sure")
        elif isinstance(command, GoOn):
            self.go_on()
        else:
            self._do(command)

    async def _make_sure(self, asked: Confirmation) -> None:
        """Ask about a command; the game waits, also until it is carried out."""
        words = confirmation_words(replace(asked, calling=""), self._workspace.name)
        plan = self.control.plan
        last = plan.called("")

        def called_since() -> str:
            if asked.kind != "take back":
                return ""
            if calling := plan.calling:
                return calling_words(calling, asked.about)
            label = plan.called("")
            return called_meanwhile(label) if label not in ("", asked.about, last) else ""

        dialog = ConfirmDialog(
            words.question, words.detail, yes=words.yes, no=words.no, also=called_since
        )
        with self._holding() as answered:
            sure = await self.app.push_screen_wait(dialog)
            answered()
            if sure:
                await self._carry_out(asked.command)

    @contextmanager
    def _holding(self) -> Iterator[Callable[[], None]]:
        """Hold the game (see the controller), and show that it waits until staff answer."""
        with self.control.holding() as answered:

            def show() -> None:
                self.show_status()
                self.show_staff()

            def go_on() -> None:
                answered()
                show()

            show()
            yield go_on

    async def _carry_out(self, command: GameCommand) -> None:
        """Carry out a command that staff have confirmed."""
        if isinstance(command, GoOn):
            self.go_on()
        else:
            self._do(command)

    def _do(self, command: GameCommand) -> None:
        """Carry out a command of staff, and show its results."""
        self._take(self.control.apply(command))

    def _take(self, results: Sequence[Result]) -> None:
        """Show the results of a command, unless the screen shows them anyway."""
        for result in results:
            if isinstance(result, StaffNote) and result.kind not in SEEN_ANYWAY:
                said = noted_words(result, self._workspace.name, by_keys=True)
                if result.kind == "pace":
                    self._tell_pace(said)
                    continue
                self._tell_now(said, "warn" if result.kind in REFUSALS else "dim")
        noted = {one.kind for one in results if isinstance(one, StaffNote)}
        if noted & {"comes", "goes", "asked for", "asked to help"}:  # the next step may be a while
            self.picture.show_scene(0, drive=False, pace=0)
        ended = "ended" in noted
        self._tell([one for one in results if not isinstance(one, StaffNote)], ended)

    def _tell_pace(self, said: str) -> None:
        """Show the pace once it is stable: the keys change it in steps."""
        if self._pace_told is not None:
            self._pace_told.stop()
        self._pace_told = self.set_timer(PACE_SECONDS, lambda: self._tell_now(said, "dim"))

    def steer(self, text: str, sure: float) -> None:
        """Handle a spoken command (pause, continue, call again, change pace) or answer.

        After a STOP, only a key continues. `sure` is the likelihood of the recognition.
        """
        if steering_of(text) is None:  # an answer of the person the game waits for
            self._do(Tell(None, text, sure, "speech"))
            return
        command = read_command(text, self.id_of)
        if isinstance(command, GoOn) and not self.control.going:
            if not self._refused():
                self.action_pause()
        elif isinstance(command, Pause | CallAgain | ChangePace):
            self._do(command)

    def action_type(self) -> None:
        """Let staff type a command, in the line of an open question if there is one."""
        if lines := self.query("#command-input"):
            self.set_focus(lines.first())  # at once: letters may come with the key
        else:
            self._ask_command("")

    def action_claim(self) -> None:
        """Let staff type the number of a card to check, or a name."""
        word = self._workspace.activity.rules.claim
        self._ask_command(f"{word} ", (CLAIM, claim_words(word)))

    def _ask_command(self, begun: str, asked: tuple[str, str] | None = None) -> None:
        """Ask staff for a command; `asked` is the question, and its explanation."""
        activity, can = self._workspace.activity, partial(can_perform, self)
        names, offers = [*self._workspace.names.values()], offered(self.control)
        read = command_reader(activity, self.id_of)
        dialog = CommandDialog(
            lambda typed: read_typed(typed, read, self.id_of, can, activity.rules),
            begun,
            *(asked or (TITLE, self._told(example_words(activity.rules, offers)))),
            lambda typed: nearest_commands(typed, names, activity.rules, offers),
        )
        typed = self.ask(dialog)
        self.run_worker(self._take_typed(typed), name="type", group="type", exclusive=True)

    async def _take_typed(self, typed: Awaitable[Typed | None]) -> None:
        command = await typed
        if isinstance(command, Perform):
            await perform(self, command.action, command.on)
        elif isinstance(command, StopRobot):
            await self.run_action("app.stop")
        elif isinstance(command, Question):
            self.answer_about(command)
        elif command is not None:
            for one in commands_in(command):
                self._do_typed(one)

    def action_presence(self) -> None:
        """Ask staff who has come or left."""
        away = self.control.plan.away
        options = [
            Option(person.id, person.name, IS_AWAY if person.id in away else IS_HERE)
            for person in self._workspace.people
        ]
        if self.control.admission is not None:
            options.append(Option(NEW, *SOMEBODY_NEW))
        who = self._take_presence(self.ask(ChooseDialog(WHO_IS_HERE, options)))
        self.run_worker(who, name="presence", group="type", exclusive=True)

    async def _take_presence(self, chosen: Awaitable[str | None]) -> None:
        away, person = self.control.plan.away, await chosen
        if person == NEW and (admission := self.control.admission) is not None:
            await self._let_join(admission)
        elif person not in (None, NEW):
            self._do(ComesIn(person) if person in away else GoesAway(person))

    async def _let_join(self, admission: Admission) -> None:
        """Ask who joins and where they sit, unless the person would be refused."""
        workspace = self._workspace
        if (who := await ask_who_joins(self.app)) is None:
            return
        joins = Joins(*who)
        try:
            refused = self.control.refusal() or admission.refusal(joins)
        except TangyError:
            refused = StaffNote("cannot")
        if refused is None:
            seats = {
                seat: [workspace.name(person) for person in beside]
                for seat, beside in admission.seats.items()
            }
            seat = await ask_where(self.app, joins.name, seats, workspace.room.seat_word or SEAT)
            if seat is None:
                return
            joins = replace(joins, seat=seat)
        self._do(joins)  # which tells the refusal

    def on_asking_panel_commanded(self, event: AskingPanel.Commanded) -> None:
        """Carry out a command typed during a question."""
        event.stop()
        self._do_typed(event.command)

    def _do_typed(self, command: GameCommand) -> None:
        if isinstance(command, GoOn) and not self.control.going:
            self.action_pause()
        elif isinstance(command, ClaimCard) and (people := self.control.plan.may_hold(command)):
            self.run_worker(self._ask_whose(command, people), name="whose", group="type")
        else:
            self.do_sure(command)

    async def _ask_whose(self, claim: ClaimCard, people: Sequence[str]) -> None:
        """Ask whose card is to be checked, as nobody knows it; Esc checks nothing."""
        name = self._workspace.name
        whose = await ask_whose(self.app, self.control.plan, claim, people, name)
        if whose is not None:
            self.do_sure(whose)

    def _refused(self) -> bool:
        """Return whether a STOP or a question has to be handled first, and tell so."""
        refusal = StaffNote("joining") if self.control.joined else self.control.refusal()
        if refusal is not None:
            self._take([refusal])
        return refusal is not None

    async def _propose(self, proposal: Proposal) -> None:
        """Ask staff to approve the next behaviour, or to choose another."""
        words = confirmed_words(proposal, self._workspace.name)
        dialog = ConfirmDialog(*words, yes="do it", no="say what else")
        does = await self.app.push_screen_wait(dialog)
        if not self.control.stopped:
            self._do(Confirm(does))

    async def _ask(self, question: Unsure) -> None:
        """Wait for the teacher's answer, learn it in the background, and continue.

        If staff requested the question, they can also leave it, and Tangy continues by itself.
        """
        self.minimize()
        self.app.clear_notifications()  # toasts would cover the question
        learnt, self.picture.lesson = self.picture.lesson, ""
        asking = AskingPanel(self._workspace, self.control, question, learnt)
        self.add_class("-asking")
        await self.mount(asking, before="#microphone" if self.query("#microphone") else "#keys")
        if self.control.stopped:
            asking.hold(True)
        self.show_status()
        try:
            answer = await asking.answer()
        finally:
            self.remove_class("-asking")
            with suppress(Exception):  # the screen may be closing
                await asking.remove()
        match answer:
            case NoAnswer.WITHDRAWN:
                if asked_for(question) and self._supervision.question is question:
                    self._do(GiveBack())
            case NoAnswer.GIVE_UP:
                self._tell(self.control.give_up(), True)
            case NoAnswer.ACCEPT:
                self._do(Accept())
            case Verified():
                self._take(await self._learn(answer))

    async def _learn(self, answer: Verified) -> list[Result]:
        """Carry out an answer and learn from it; nothing else runs meanwhile."""
        self._learning = True
        self.show_status()
        try:
            return await asyncio.to_thread(self.control.answer, answer.behaviour, answer.target)
        finally:
            self._learning = False

    def action_accept(self) -> None:
        """Accept the condition that Tangy asks about, after confirmation."""
        asking = self._asking
        if self.control.stopped:
            self._take([StaffNote("stopped first", words=self.control.stopped_by)])
        elif asking is None or not asking.acceptable:
            self._tell_now(NOT_ACCEPTABLE, "dim")
        else:
            self._sure(ACCEPT, "", lambda: self._accept(asking))

    def _accept(self, asking: AskingPanel) -> None:
        if self._asking is not asking or not asking.accept():
            self._tell_now(NOT_ACCEPTABLE, "dim")
