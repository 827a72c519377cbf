"""A question in a game: Tangy is unsure, the game waits, and the teacher answers by a command.

The answer is verified like a command while teaching: nothing happens before a y.
"""

from __future__ import annotations

import asyncio
from enum import Enum
from typing import Any, TypeVar

from textual.app import ComposeResult
from textual.containers import Vertical
from textual.message import Message
from textual.widgets import Static

from tangy_profiles.errors import TangyError
from tangy_tui.app.answers import Spoken
from tangy_tui.app.command_grammar import command_reader
from tangy_tui.app.game_commands import Accept, EndGame, GameCommand, GiveBack, StopRobot, asked_for
from tangy_tui.app.game_controller import GameController
from tangy_tui.app.inquiry_grammar import Question
from tangy_tui.app.screen_grammar import Perform
from tangy_tui.app.staff_notes import StaffNote
from tangy_tui.app.typed_line import commands_in, read_typed
from tangy_tui.app.workspace import Workspace
from tangy_tui.interaction.game_events import Unsure
from tangy_tui.language.commands import Phrasebook
from tangy_tui.learning.verification import (
    Asked,
    NotUnderstood,
    Offered,
    Refused,
    Rejected,
    Reply,
    Say,
    Verified,
)
from tangy_tui.text import questions as text
from tangy_tui.text.keys import with_keys
from tangy_tui.text.refusals import not_understood_words, refused_words
from tangy_tui.ui.base import Dialog, can_perform, give_keys_back, perform
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.dialogs.confirm import ConfirmDialog
from tangy_tui.ui.dialogs.question import dialog_for
from tangy_tui.ui.hearing import hearing_of
from tangy_tui.ui.keys import foot, keymap_of
from tangy_tui.ui.messages import Stop
from tangy_tui.ui.screens.question_text import question_words, seen_words
from tangy_tui.ui.type_ahead_guard import SETTLE_SECONDS
from tangy_tui.ui.widgets.command_bar import AnswerBar, CommandBar
from tangy_tui.ui.widgets.log_view import Kind, LogView

ResultT = TypeVar("ResultT")

KEYS = ("why", "command:answer", "pause", "back:give the game up")
ACCEPTING_KEYS = ("why", "accept:all right", "command:answer", "pause", "back:give the game up")
OWN_KEYS = ("why", "command:answer", "pause", f"back:{text.LETS_GO_ON}")
"""The keys available while the line does not have the focus."""


class NoAnswer(Enum):
    """Outcomes other than an answer."""

    GIVE_UP = "give up"
    ACCEPT = "accept"
    WITHDRAWN = "withdrawn"


class AskingPanel(Vertical):
    """Tangy's question with its reason, and the line for answers; `answer()` waits for one.

    It also listens through the application's speech input; spoken answers are verified like typed
    ones. While the robot is stopped the panel is on hold, and returns commands to the line.
    """

    DEFAULT_CSS = """
    AskingPanel { height: auto; border-top: heavy $warning; border-title-color: $warning; }
    AskingPanel Static.asks { height: auto; max-height: 5; padding: 0 1; }
    AskingPanel Static.now { height: auto; max-height: 4; padding: 0 1; color: $ink-dim; }
    AskingPanel Static.said { height: auto; max-height: 3; padding: 0 1; display: none; }
    AskingPanel.-says Static.said { display: block; }
    """

    class WhyWanted(Message):
        """The teacher asked why, or when Tangy goes to people: explain it."""

        def __init__(self, about: Question | None = None) -> None:
            super().__init__()
            self.about = about

    class Commanded(Message):
        """The teacher typed a command instead of an answer."""

        def __init__(self, command: GameCommand) -> None:
            self.command = command
            super().__init__()

    def __init__(
        self,
        workspace: Workspace,
        control: GameController,
        question: Unsure,
        before: str = "",
    ) -> None:
        """Create the panel for a question; `before` is the result of the last answer.

        If staff requested the question, leaving it lets Tangy continue by itself.
        """
        super().__init__(id="asking")
        self._workspace = workspace
        self._answers = control.answers
        self._supervision = control.supervision
        self._question = question
        self._phrasebook = workspace.phrasebook()
        self._acceptable = control.supervision.acceptable
        self._answer: asyncio.Future[Verified | NoAnswer]
        self._answer = asyncio.get_running_loop().create_future()
        self._dialog: Dialog[Any] | None = None
        self._held = False
        self.is_open = False  # for answers: the line is visible, and no verification is open
        self._by_voice = False  # the present command was spoken
        self._hearing = hearing_of(self.app)
        self._before = clean(before)
        self.wanted = asked_for(question)
        """Whether staff requested the question."""
        self.set_class(bool(before), "-says")
        self.border_title = "Tangy asks"

    def compose(self) -> ComposeResult:
        """Lay out the question, what Tangy sees, and the line."""
        yield Static(
            question_words(self._workspace, self._supervision, self._question),
            classes="asks",
            markup=False,
        )
        yield Static(
            seen_words(self._workspace, self._supervision, self._question),
            classes="now",
            markup=False,
        )
        yield Static(self._before, classes="said", markup=False)
        yield AnswerBar(
            lambda typed: self._phrasebook.complete(typed),
            sayable=lambda: self._answers.sayable,
            placeholder=text.answer_line(own=self.wanted, accepts=self._acceptable),
            resting=self._keys(going=True),
            closed=True,
            id="command",
        )

    def on_mount(self) -> None:
        """Focus the line, but ignore keys typed before the question was visible.

        With push-to-talk, the screen keeps the focus.
        """
        self._had_keys = self.screen.focused
        if self.wanted:
            self.query_one(AnswerBar).leave_by(self.withdraw, text.LETS_GO_ON)
        self._take_keys()
        self.set_timer(SETTLE_SECONDS, self._ready)
        if self._hearing is not None:
            self._hearing.attend(self)

    def on_unmount(self) -> None:
        """Stop listening, and let the panel that had the focus take keys again."""
        if self._hearing is not None:
            self._hearing.leave(self)
        self.screen.call_later(give_keys_back, self.screen, self._had_keys)

    @property
    def _by_key(self) -> bool:
        return self._hearing is not None and self._hearing.by_key

    def _keys(self, *, going: bool) -> str:
        own = OWN_KEYS if self.wanted else KEYS
        ids = (*(("talk",) if self._by_key else ()), *(ACCEPTING_KEYS if self._acceptable else own))
        if not going:
            ids = tuple("pause:go on" if id == "pause" else id for id in ids)
        return "   ".join(" ".join(key) for key in foot(self.app, *ids))

    def _take_keys(self) -> None:
        if self._by_key:
            self.screen.set_focus(None)
        else:
            self.query_one(CommandBar).focus_input()

    async def answer(self) -> Verified | NoAnswer:
        """Wait for a verified answer, or another outcome."""
        return await self._answer

    def withdraw(self) -> None:
        """Close the question, which an event has made obsolete."""
        self._settle(NoAnswer.WITHDRAWN)
        if (dialog := self._dialog) is not None:
            self._close(dialog)
            self.screen.run_worker(self._take_away(dialog), group="take away")

    def _close(self, dialog: Dialog[Any]) -> None:
        dialog.on_stop(Stop("the question was withdrawn"))

    async def _take_away(self, dialog: Dialog[Any]) -> None:
        """Remove a dialog of the question, as soon as it is on top."""
        while dialog.is_attached:
            self._close(dialog)
            await asyncio.sleep(0.05)

    @property
    def acceptable(self) -> bool:
        """Whether the teacher can accept what happened as normal."""
        return self._acceptable

    def accept(self) -> bool:
        """Accept what happened as normal; False: not possible for this question."""
        if self._acceptable and self._held:
            self.say(text.STOPPED_FIRST)
        elif self._acceptable:
            self._settle(NoAnswer.ACCEPT)
        return self._acceptable

    def ask_to_give_up(self) -> None:
        """Confirm giving up the game; or let Tangy continue, if staff requested the question."""
        if self.wanted:
            self.withdraw()
        elif self._dialog is None:
            self.screen.run_worker(self._confirm(), name="give up", group="give up")

    async def _confirm(self) -> None:
        dialog = ConfirmDialog(
            text.GIVE_UP,
            text.GIVE_UP_DETAIL,
            yes="give the game up",
            no="go on",
        )
        if await self._put(dialog):
            self._settle(NoAnswer.GIVE_UP)

    async def _put(self, dialog: Dialog[ResultT]) -> ResultT:
        """Show a dialog, which closes if the question is withdrawn.

        Its worker belongs to the screen, so that its answer is always awaited.
        """
        self._dialog = dialog
        try:
            return await self.app.push_screen_wait(dialog)
        finally:
            self._dialog = None

    def _settle(self, answer: Verified | NoAnswer) -> None:
        if not self._answer.done():
            self._answer.set_result(answer)

    def hold(self, held: bool) -> None:
        """Hold or release commands while the robot is stopped; the screen gets the focus."""
        self._held = held
        if held:
            self.screen.set_focus(None)
            self.say(text.STOPPED_FIRST)
        else:
            self.say("")
            self._take_keys()

    def on_command_bar_given(self, event: CommandBar.Given) -> None:
        """Handle a typed answer or command."""
        event.stop()
        self.take(event.text)

    def take(self, typed: str) -> None:
        """Handle an answer or a command that was typed here, or before the question was visible."""
        self._by_voice = False
        try:
            find, screen = self._find_person, self.screen
            read = command_reader(self._workspace.activity, find, asks=lambda: True)
            command = read_typed(typed, read, find, lambda id: can_perform(screen, id), asks=True)
        except TangyError as error:
            self._return(typed, str(error))
            return
        if isinstance(command, Perform | Question):
            self.query_one(CommandBar).ready()
            self._show(command)
        elif command is None or (isinstance(command, Accept) and not self._acceptable):
            if self._held:
                self._return(typed, text.STOPPED_FIRST)
            else:
                self._tell(self._answers.say(Say(typed)))
        else:
            self.query_one(CommandBar).ready()
            for one in commands_in(command):
                self._carry_out(one)

    def _show(self, word: Perform | Question) -> None:
        """Show an explanation, or run a key's action."""
        if isinstance(word, Question) or word.action == "why":
            self.post_message(self.WhyWanted(word if isinstance(word, Question) else None))
        else:
            self.app.run_worker(perform(self.screen, word.action, word.on))

    def _carry_out(self, command: GameCommand) -> None:
        match command:
            case StopRobot():
                self.app.run_worker(self.run_action("app.stop"))
            case EndGame():
                self.ask_to_give_up()
            case Accept():
                self.accept()
            case GiveBack() if self.wanted:
                self.withdraw()
            case _:
                self.post_message(self.Commanded(command))

    def _find_person(self, wanted: str) -> str:
        return self._workspace.find_person(wanted).id

    def _tell(self, said: Spoken) -> None:
        match said:
            case Asked() | Offered():
                self._be_open(False)
                self.screen.run_worker(self._verify(said), name="question", group="question")
            case NotUnderstood(heard, suggestions):
                self._return(heard, not_understood_words(heard, suggestions))
            case Rejected(heard):
                self._return(heard, text.STOPPED_FIRST if self._held else text.REJECTED)
            case Refused():
                self._return(said.heard, refused_words(said))
            case Verified():
                self._settle(said)
            case StaffNote():
                self.withdraw()
        if not isinstance(said, Asked | Offered):
            self._be_open(True)

    async def _verify(self, asked: Asked | Offered) -> None:
        """Verify an answer, and handle the reply once its dialog is removed."""
        dialog = dialog_for(asked, self._hearing.aloud if self._hearing is not None else "")
        answer = await self._put(dialog)
        while dialog.is_attached:  # noqa: ASYNC110 - the next one has the same id, and no event
            await asyncio.sleep(0)
        if self._answer.done():
            return
        reply = Reply(answer.yes and not self._held, answer.reply.alternative)
        self._tell(self._answers.reply(reply))

    def _return(self, heard: str, sentence: str) -> None:
        """Put a command back into the line, with a message."""
        self.say(sentence)
        self.screen.query_one(LogView).write(sentence, "warn")
        bar = self.query_one(CommandBar)
        if self._by_voice:
            bar.ready()
        else:
            bar.restore(heard)
        if self._held:
            self.screen.set_focus(None)

    # ------------------------------------------------------------------------------- hearing

    @property
    def listens(self) -> bool:
        """Whether a spoken answer can be taken now."""
        free = self.is_open and self._dialog is None and not self._answer.done()
        return free and self.screen.is_active

    @property
    def spoken(self) -> Phrasebook:
        """The phrases that can be spoken."""
        return self._phrasebook

    def hear(self, said: Say) -> None:
        """Handle a spoken answer."""
        self._by_voice = True
        if self._held:
            self._return(said.text, text.STOPPED_FIRST)
        else:
            self._tell(self._answers.say(said))

    def told(self, sentence: str, kind: Kind) -> None:
        """Show a sentence about speech input, below the question and in the log."""
        self.say(sentence)
        self.screen.query_one(LogView).write(sentence, kind)

    def _be_open(self, is_open: bool) -> None:
        """Open or close the panel for answers; queued speech is handled next."""
        self.is_open = is_open
        if self._hearing is not None:
            self._hearing.look()

    def say(self, sentence: str) -> None:
        """Replace the sentence below the question."""
        self.set_class(bool(sentence), "-says", "-refuses")
        for said in self.query(".said").results(Static):
            said.update(clean(with_keys(sentence, keymap_of(self.app))))

    def show_keys(self, *, going: bool) -> None:
        """Show the available keys while the line does not have the focus."""
        for bar in self.query(AnswerBar):
            bar.rest(self._keys(going=going))

    def _ready(self) -> None:
        self.query_one(CommandBar).ready()
        self._be_open(True)
