"""The teaching screen (III-A-2): the simulated room, the trajectory, and one line for commands."""

from __future__ import annotations

import asyncio
from collections.abc import Sequence
from typing import ClassVar, TypeVar

from textual import events
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.containers import Horizontal, Vertical
from textual.geometry import Region
from textual.screen import Screen
from textual.widgets import Static

from tangy_profiles.errors import TangyError
from tangy_tui.app.screen_grammar import Perform
from tangy_tui.app.teaching_grammar import read_settling, read_teaching
from tangy_tui.app.tour import Tour
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.teaching_events import (
    Again,
    Begun,
    Discard,
    Executed,
    Next,
    Redo,
    Remark,
    Settle,
    StepUndone,
    TeacherCommand,
    TeachingEvent,
    Undo,
)
from tangy_tui.learning.teaching_session import TeachingSession
from tangy_tui.learning.verification import Asked, NotUnderstood, Offered, Refused, Rejected
from tangy_tui.text import teaching as text
from tangy_tui.text.questions import REJECTED
from tangy_tui.text.refusals import not_understood_words, refused_words
from tangy_tui.text.who import renamed_teacher
from tangy_tui.ui.base import TangyScreen
from tangy_tui.ui.dialogs.question import dialog_for
from tangy_tui.ui.dialogs.remark import remark_dialog
from tangy_tui.ui.hearing import HearingLine, hearing_of
from tangy_tui.ui.messages import Stop
from tangy_tui.ui.panels import LOW, WIDE, KeyLine, panel, room_panel
from tangy_tui.ui.screens import teach_keys
from tangy_tui.ui.screens.teach_choices import add_rule, put_away, show_again
from tangy_tui.ui.screens.teach_hearing import TeachHearing
from tangy_tui.ui.screens.teach_letters import type_letter
from tangy_tui.ui.screens.teach_scripted import follow_script
from tangy_tui.ui.screens.teach_why import TeachWhy
from tangy_tui.ui.screens.teach_words import follow_word, go_home
from tangy_tui.ui.speaking import preference_of, speaker_of
from tangy_tui.ui.teaching_picture import TeachingPicture
from tangy_tui.ui.widgets.call_board import CallBoard
from tangy_tui.ui.widgets.command_bar import CommandBar
from tangy_tui.ui.widgets.coverage_list import CoverageList
from tangy_tui.ui.widgets.log_view import LogView
from tangy_tui.ui.widgets.room_view import RoomView
from tangy_tui.ui.widgets.sayable_list import SayableList
from tangy_tui.ui.widgets.status_line import StatusLine
from tangy_tui.ui.widgets.transcript import Transcript

T = TypeVar("T")


class TeachScreen(TangyScreen[bool]):
    """One teacher's session. Dismissed with True when the scripted demonstration is complete.

    Commands are typed or spoken; spoken ones do not change the focus.
    """

    CSS_PATH = "teach.tcss"
    HORIZONTAL_BREAKPOINTS = WIDE
    VERTICAL_BREAKPOINTS = LOW
    AUTO_FOCUS = "#command-input"
    HELP = teach_keys.HELP
    BINDINGS: ClassVar[list[BindingType]] = teach_keys.BINDINGS

    def __init__(
        self,
        workspace: Workspace,
        teaching: TeachingSession,
        *,
        resume: bool = True,
        another: bool = False,
        scripted: float | None = None,
        begun: Sequence[TeachingEvent] = (),
        tour: bool = False,
    ) -> None:
        """Create the screen.

        Args:
            workspace: the workspace of the session.
            teaching: the session.
            resume: resume an unfinished demonstration of this teacher.
            another: the session has already begun; begin its next demonstration.
            scripted: let a scripted teacher demonstrate, at this many steps a second.
            begun: the session has already begun with these events.
            tour: whether to show the tour.
        """
        super().__init__()
        self._workspace = workspace
        self.teaching = teaching
        self._resume = resume
        self._scripted = scripted
        self._another = another
        self._begun = list(begun)
        self._listener = TeachHearing(self, workspace, teaching, self._apply)
        self._picture = TeachingPicture(self, workspace, teaching, lambda: self._listener.keys)
        self._picture.tour = Tour() if tour else None
        self._why = TeachWhy(self, workspace, teaching)

    def compose(self) -> ComposeResult:
        """Lay out status, room, dialogue, steps, situation and commands."""
        hearing = hearing_of(self.app) if self._scripted is None else None
        yield StatusLine()
        with Horizontal(id="body"):
            with Vertical(id="left"):
                yield room_panel(self._workspace)
                yield panel(CallBoard(self.teaching.activity.deck))
                yield panel(SayableList())
                yield panel(LogView(id="log"))
            with Vertical(id="right"):
                yield panel(Transcript(empty=text.begin_words(heard=hearing is not None)))
                yield panel(CoverageList())
        yield Static(id="now", markup=False)
        yield Static(id="unseen", markup=False)
        if hearing is not None:
            self._listener.hearing = hearing
            if hearing.by_key:
                self.AUTO_FOCUS = ""  # type: ignore[misc]  # so that t works at once
            yield HearingLine(hearing)
        yield CommandBar(
            lambda typed: self.teaching.phrasebook.complete(typed),
            sayable=lambda: self.teaching.sayable,
            placeholder=text.TYPE_HERE,
            letters=False,
            id="command",
        )
        keys = self._listener.keys if self._scripted is None else teach_keys.WATCHING
        yield KeyLine(*keys, typing=self._scripted is None)

    def on_mount(self) -> None:
        """Begin the session."""
        phrases = (b.phrases[0] for b in self.teaching.activity.behaviours.values())
        said = text.sayable_words(phrases)
        self.HELP = f"{type(self).HELP}{self._listener.help} {said}"  # type: ignore[misc]
        self._tell(self._begun or self._begin())
        if self._scripted is not None:
            self.query_one(CommandBar).disabled = True
            self.run_worker(self._follow_script(self._scripted), name="scripted teacher")
        self._listener.attend()

    def on_unmount(self) -> None:
        """Stop listening and speaking."""
        self._listener.leave()
        speaker_of(self.app).hush()

    def _begin(self) -> list[TeachingEvent]:
        if self._another:
            return self.teaching.apply(Next())
        return self.teaching.begin(resume=self._resume)

    def on_command_bar_given(self, event: CommandBar.Given) -> None:
        """Handle a typed command."""
        event.stop()
        self._listener.by_voice = False
        remark = self.teaching.remark
        if remark is not None and (settle := read_settling(event.text, remark)) is not None:
            self._apply(settle)
            return
        follow_word(self, read_teaching(event.text, self.teaching.phrasebook.game), event.text)

    def follow(self, command: TeacherCommand) -> None:
        """Apply a command to the session, and show its results."""
        self._apply(command)

    def again_from(self, step: int | None) -> None:
        """Demonstrate the present game again from a step, counted from 1; None: not specified."""
        self.query_one(CommandBar).ready()
        if step is None:
            self._log.notice(text.WHICH_STEP, "warn")
        else:
            self.again(self.teaching.demonstration.id, step - 1)

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        """Disable editing for a scripted teacher: onlookers can only look, leave or stop."""
        if action == "think_no_more":
            return self._why.thinks
        if action == "tour":
            return self._picture.tours(skip="skip" in parameters)
        if action == "talk":
            return self._listener.by_key
        return self._scripted is None or action not in teach_keys.NOT_WATCHING

    def take_letter(self, event: events.Key | events.Paste) -> bool:
        """Send letters to the line, whatever has the focus: none is a shortcut here."""
        by_key = self._listener.by_key
        return self._scripted is None and type_letter(self, event, push_to_talk=by_key)

    async def action_talk(self) -> None:
        """Start or end an utterance (push-to-talk)."""
        await self.run_action("app.talk")

    def action_undo(self) -> None:
        """Undo the last step."""
        self._apply(Undo())

    def action_redo(self) -> None:
        """Redo the last undone step."""
        self._apply(Redo())

    def action_again(self) -> None:
        """Demonstrate the present game again from the chosen step."""
        self.again_from(self.query_one(Transcript).chosen)

    def again(self, id: str, kept: int) -> None:
        """Demonstrate a game again from the step after `kept`, after confirmation."""
        self.run_worker(show_again(self, Again(id, kept)), name="again")

    def action_rule(self) -> None:
        """Extend the last step to more situations by ignoring some facts."""
        self.query_one(CommandBar).ready()
        self.run_worker(add_rule(self), name="rule")

    def listen(self) -> None:
        """Accept commands again."""
        self._listener.open(True)

    async def alone(self, dialog: Screen[T]) -> T:
        """Wait for a dialog's answer; accept no commands until it has been applied."""
        self._listener.open(False)
        self._log.clear_notices()
        answer = await self.app.push_screen_wait(dialog)
        while dialog.is_attached:  # noqa: ASYNC110 - the next one has the same id, and no event
            await asyncio.sleep(0)
        return answer

    def action_coverage(self) -> None:
        """Switch between the coverage and the steps."""
        self.toggle_class("-coverage")
        covers = self.has_class("-coverage")
        panel = self.query_one(CoverageList if covers else Transcript)
        self.call_after_refresh(panel.focus)

    def action_choose(self, by: int) -> None:
        """Focus the steps, and choose one."""
        steps = self.query_one(Transcript)
        self.remove_class("-coverage")
        steps.focus()
        steps.action_choose(by)

    def action_why(self) -> None:
        """Explain what Tangy would do in the chosen step's situation, or in the present one."""
        self.query_one(CommandBar).ready()
        self._why.show(self.query_one(Transcript).chosen)

    def action_think_no_more(self) -> None:
        """Cancel the computation, and stay here."""
        self._why.cancel()
        self._log.notice("Cancelled.", "dim")

    def teaches_as(self, name: str) -> None:
        """Change the teacher; a game in progress keeps its teacher."""
        self.teaching.teach_as(name)
        if not self.teaching.demonstration.steps:
            self._apply(Discard())
        self._log.write(renamed_teacher(name, self.teaching.demonstration.teacher), "good")

    def action_tour(self, way: str) -> None:
        """Continue the tour, or end it."""
        self._picture.go_on_tour(skip=way == "skip")

    def on_transcript_chosen(self, event: Transcript.Chosen) -> None:
        """Explain the step chosen with Enter."""
        event.stop()
        self.action_why()

    def action_next(self) -> None:
        """Begin another demonstration."""
        self._apply(Next())

    def action_leave(self) -> None:
        """Close the coverage, take the cursor off the steps, or go home; all steps are stored."""
        if not self.is_active:
            return  # it is covered, or has been left
        steps = self.query_one(Transcript)
        if self.has_class("-coverage", "-narrow"):
            self.remove_class("-coverage")
            steps.focus()
        elif steps.chosen is not None:
            steps.release()
        else:
            go_home(self, watching=self._scripted is not None)

    def action_discard(self) -> None:
        """Discard the present game, after confirmation, and begin another."""
        self.query_one(CommandBar).ready()
        self.run_worker(put_away(self), name="discard")

    def action_perform(self, action: str) -> None:
        """Run the action of a global key."""
        follow_word(self, Perform(action), "")

    def take_sentence(self, sentence: str) -> bool:
        """Show a notice in the log: in a corner it would cover what is still to show."""
        self._log.notice(sentence, "dim")
        return True

    def covered(self, region: Region) -> None:
        """Show what is still to show above a dialog, as far as there is room."""
        self._picture.covered(region)

    def on_stop(self, message: Stop) -> None:
        """Stop the robot where it is drawn, until the next command."""
        self.query_one(RoomView).hold(True)
        self.query_one(CommandBar).ready()
        self._log.notice(text.STOPPED, "warn")

    def _apply(self, command: TeacherCommand) -> None:
        try:
            events = self.teaching.apply(command)
        except TangyError as error:  # logging failed, so nothing was done
            self._log.notice(str(error), "bad")
            self.query_one(CommandBar).ready()
            self._listener.open(True)
        else:
            self._listener.follow(events)
            self._tell(events)

    def _tell(self, events: Sequence[TeachingEvent]) -> None:
        if not self.query(StatusLine):
            return  # the screen is closing, and its panels are removed first
        bar = self.query_one(CommandBar)
        self._picture.follow_tour(events)
        undone = [event for event in events if isinstance(event, StepUndone)]
        for event in events:
            match event:
                case Asked() | Offered():
                    self._listener.open(False)
                    self.run_worker(self._verify(event), name="question")
                    return
                case NotUnderstood(heard, suggestions):
                    self._log.notice(not_understood_words(heard, suggestions), "warn")
                    self._listener.give_back(heard)
                case Rejected(heard):
                    self._log.notice(REJECTED, "dim")
                    self._listener.give_back(heard)
                case Refused():
                    self._log.notice(refused_words(event), "warn")
                    if event.heard:
                        self._listener.give_back(event.heard)
                case Executed():
                    preference = preference_of(self._workspace, event.action.target)
                    speaker_of(self.app).interject(event.speech, preference)
                case StepUndone():
                    speaker_of(self.app).hush()
                case Begun():
                    self._listener.refresh()
            self._picture.tell(event, asked=self._scripted is None)
        if undone:
            self._picture.undone(undone)
        bar.ready()
        self._picture.state()
        remark = self.teaching.remark
        if remark is not None and remark in events and self._scripted is None:
            self.run_worker(self._remark(remark), name="remark")
        else:
            self._listener.open(True)

    async def _remark(self, remark: Remark) -> None:
        """Ask about a remark in place."""
        dialog = remark_dialog(remark, self.teaching, self._listener.aloud)
        answer = await self.alone(dialog)
        if answer == "later":
            self._picture.remark(remark)  # the dialog has shown it; from now on the log does
        self._apply(Settle(answer))
        if dialog.learns:
            self.action_perform("learn")

    async def _verify(self, asked: Asked | Offered) -> None:
        """Verify a command, and apply the answer once the dialog is removed."""
        answer = await self.alone(dialog_for(asked, self._listener.aloud))
        self._apply(answer.reply)

    @property
    def _log(self) -> LogView:
        return self.query_one(LogView)

    async def _follow_script(self, pace: float) -> None:
        await follow_script(self, self.teaching, pace, self._tell)
        self.close(True)

    def on_screen_resume(self, event: events.ScreenResume) -> None:
        """Listen for names as they are said now, and mark steps that were called wrong."""
        self._listener.refresh()
        self._picture.mark_wrong()
