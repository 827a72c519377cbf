"""Teaching in the console: for a pipe, a script, a screen reader or a simple terminal.

It drives the same sessions as the screens, and writes one fact per line, without graphics.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from threading import Thread
from typing import Any

from tangy_profiles.errors import TangyError
from tangy_tui.app.command_grammar import read_answer
from tangy_tui.app.screen_grammar import Perform
from tangy_tui.app.spoken_answers import choices_of, spoken_settling
from tangy_tui.app.teaching_grammar import AgainFrom, Leave, TeachAs, read_settling, read_teaching
from tangy_tui.app.tour import Tour
from tangy_tui.console.after_teaching import AfterTeaching
from tangy_tui.console.confirming import ConfirmingTeacher
from tangy_tui.console.step_rules import rules_to_type
from tangy_tui.console.teaching_inquiries import TeachingInquiries
from tangy_tui.console.typed_yes import TypedYes
from tangy_tui.learning.teaching_events import (
    Again,
    Begun,
    Discard,
    Executed,
    Finished,
    StepUndone,
    TeacherCommand,
    TeachingEvent,
)
from tangy_tui.learning.teaching_session import TeachingSession
from tangy_tui.learning.verification import (
    Asked,
    Offered,
    Reply,
    Say,
    StopCommand,
)
from tangy_tui.monitoring.attention import goes_to_people
from tangy_tui.speech.input import Heard, SpeechInput
from tangy_tui.text.coach import SAYABLE, sayable_now
from tangy_tui.text.hearing import hearing_words
from tangy_tui.text.questions import ANSWER_HELP, NO_QUESTION, answer_help
from tangy_tui.text.refusals import WHICH
from tangy_tui.text.remarks import left_open_lines, which_answer
from tangy_tui.text.teaching import left_words, teaching_lines
from tangy_tui.text.teaching_commands import (
    GAME_OVER,
    GUIDED_ALREADY,
    HELP,
    NOT_GUIDED,
    NOTHING_CHANGED,
    ON_THE_SCREEN,
    STOPPED,
    WHICH_STEP,
    learn_next,
    left_after,
)
from tangy_tui.text.tour import tour_line
from tangy_tui.text.voice import OR_SAY_WHICH, OR_SAY_YES
from tangy_tui.text.who import renamed_teacher, teaches_as

Read = Callable[[], str | None]
"""Returns the next line, None at the end."""
Write = Callable[[str], None]


class TeachingLines:
    """A teaching session in the console; `run` returns when the teacher or the input ends it."""

    def __init__(
        self,
        teaching: TeachingSession,
        read: Read,
        write: Write,
        ears: SpeechInput | None = None,
        *,
        scripted: bool = False,
        seen: Callable[[], list[str]] = list,
        why: Callable[[], list[str]] = list,
        resume: str = "tangy teach",
        learn: str = "tangy learn",
        yes: TypedYes | None = None,
        rename: Callable[[str], str] | None = None,
        after: AfterTeaching | None = None,
        tour: bool = False,
    ) -> None:
        """Create the session.

        Args:
            teaching: the session.
            read: returns the next line, None at the end.
            write: writes a line.
            ears: the recogniser, if there is one; answers come from `read`.
            scripted: the lines come from a script, so speech is handled before them.
            seen: returns a sentence with the coverage, then the missing situations, one per line.
            why: returns an explanation of Tangy's present decision.
            resume: the command that resumes this demonstration.
            learn: the command that learns from it.
            yes: parses a typed yes.
            rename: stores another name of the teacher, and returns it.
            after: learns from the demonstrations, and plays by them.
            tour: whether to show the tour.
        """
        self._together = ears is not None and ears.live and not scripted
        self._teaching = teaching
        self._read = read
        self._write = write
        self._ears = ears
        self._seen = seen
        self._inquiries = TeachingInquiries(teaching, seen, why)
        self._resume = resume
        self._learn = learn
        self._yes = yes or TypedYes()
        self._sure = ConfirmingTeacher(teaching, self._yes, write)
        self._rename = rename
        self._after = after
        self.plays = False
        """Whether the teacher has left to see Tangy run a game."""
        self._tour = Tour() if tour else None
        self._scripted = scripted
        self._kept = False  # part of the present demonstration is in the log
        self._complete = False  # a demonstration was completed, and Tangy has not learnt since
        self._spoken: asyncio.Future[Heard | None] | None = None
        self._typed: asyncio.Future[str | None] | None = None
        if ears is not None:
            ears.tell = lambda note: write(hearing_words(note))

    async def run(self, *, resume: bool = True) -> None:
        """Teach until `quit` or the end of the input. Verified steps are stored."""
        ears = self._ears
        try:
            await self._teach(resume=resume)
        finally:
            if ears is not None:
                await ears.close()
            if self._spoken is not None:
                await asyncio.gather(self._spoken, return_exceptions=True)
        self._leave()

    async def _teach(self, *, resume: bool) -> None:
        teaching, write = self._teaching, self._write
        begun = teaching.begin(resume=resume)
        guided = "" if teaching.demonstration.guided else f" {NOT_GUIDED}"
        write(f"Teaching {teaching.activity.title}. {HELP}{guided}")
        self._tell(begun)
        self._write(self._inquiries.where())
        self._tell_of_tour()
        while (line := await self._next_line()) is not None:
            command: TeacherCommand | StopCommand | Leave | None
            if isinstance(line, str):
                command = self._command(line)
            else:
                remark = teaching.remark if self._answers else None
                command = spoken_settling(line, remark) or line
            if isinstance(command, Leave) or self.plays:
                break
            asked = teaching.question
            if isinstance(command, StopCommand):
                if asked is not None:
                    self._tell(teaching.apply(Reply(yes=False)))
                write(STOPPED)
            elif command is not None:
                self._tell(teaching.apply(command))
            if self._ears is not None:
                if asked is not None and teaching.question is not asked:  # for the next question
                    self._ears.asking(False)
                self._ears.asking(teaching.question is not None, choices_of(teaching.question))

    def _leave(self) -> None:
        """Write what happens to the demonstration, and what to do next."""
        if self.plays:
            return
        shown = self._teaching.demonstration
        if self._complete and (shown.finished or not shown.steps):
            self._write(learn_next(self._learn))
        elif shown.steps and self._kept:
            self._write(left_after(len(shown.steps), self._resume))
        elif shown.steps:
            self._write(NOTHING_CHANGED)

    async def _next_line(self) -> str | Heard | None:
        """Return the next input: a spoken command if one is due, otherwise a line.

        A recording goes before the lines, so that a script can answer it; a live speaker may also
        type. While a question is open, speech waits unless it answers the question or stops the
        robot.
        """
        asks = self._teaching.question is not None
        if self._ears is None or (asks and not (self._together or self._answers)):
            return await self._line()
        spoken = self._spoken = self._spoken or asyncio.ensure_future(anext(self._ears, None))
        if asks and _is_heard(spoken, Say):
            return await self._line()
        typed = self._typed = self._typed or (self._reading() if self._together else None)
        waiting: list[asyncio.Future[Any]] = [spoken] if typed is None else [spoken, typed]
        done, _ = await asyncio.wait(waiting, return_when=asyncio.FIRST_COMPLETED)
        if typed in done or (asks and _is_heard(spoken, Say)):
            return await self._line()
        self._spoken = None
        try:
            said = await spoken
        except TangyError as error:
            if not self._together:
                raise
            self._write(str(error))
            said = None
        if said is None:
            self._ears = None
            return await self._line()
        return said.text if isinstance(said, Say) and said.commands is None else said

    def _reading(self) -> asyncio.Future[str | None]:
        """Read a line in a thread that does not delay the end of the program."""
        loop = asyncio.get_running_loop()
        line: asyncio.Future[str | None] = loop.create_future()

        def give(read: str | None) -> None:
            if not line.done():
                line.set_result(read)

        def wait() -> None:
            read = self._read()
            with suppress(RuntimeError):  # the program has ended
                loop.call_soon_threadsafe(give, read)

        Thread(target=wait, daemon=True).start()
        return line

    async def _line(self) -> str | None:
        line, self._typed = self._typed or self._reading(), None
        return await line

    @property
    def _answers(self) -> bool:
        return self._ears is not None and self._ears.answers

    def _command(self, line: str) -> TeacherCommand | StopCommand | Leave | None:
        text = line.strip()
        if self._tour is not None and self._tours(text):
            return None
        if not text and not self._scripted and self._teaching.question is None:
            can = sayable_now(self._teaching.sayable)
            self._write(f"{SAYABLE}: {can}." if can else GAME_OVER)
        if not text or text.startswith("#"):
            return None
        word = read_teaching(text, self._teaching.phrasebook.game)
        if isinstance(word, StopCommand | Leave):
            self._sure.drop()
        if self._sure.takes(text):
            return self._sure.answer(text)
        answer, question = read_answer(text), self._teaching.question
        remark = self._teaching.remark
        if question is None and remark is not None and (settle := read_settling(text, remark)):
            return settle
        if question is not None and not isinstance(word, StopCommand | Leave):
            typed = self._yes.answer(text)
            if isinstance(typed, str):
                self._write(typed)
                return None
            answer = typed
            if answer is None:
                short = WHICH if isinstance(question, Offered) else ANSWER_HELP
                self._write_all(answer_help(question) if word == "help" else [short])
            return answer
        if word is None and (answer is None or text.isdecimal()):
            return Say(text)
        if word is None and remark is not None:
            self._write_all(which_answer(remark, self._teaching.activity))
        elif word is None:
            self._write(NO_QUESTION)
        elif isinstance(word, str):
            self._write_all(self._inquiries.lines(word))
        elif isinstance(word, TeachAs) or word == Perform("name"):
            self._write(self._named(word.name if isinstance(word, TeachAs) else ""))
        elif word == Perform("rule"):
            self._write_all(rules_to_type(self._teaching))
        elif isinstance(word, Perform):
            self._perform(word)
        elif isinstance(word, AgainFrom):
            if word.step is not None:
                return self._sure.ask(Again(self._teaching.demonstration.id, word.step - 1))
            self._write(WHICH_STEP)
        elif isinstance(word, StopCommand | Leave):
            return word
        else:
            return self._sure.ask(word)
        return None

    def _tours(self, text: str) -> bool:
        """Continue or end the tour, if a line says so."""
        tour, skips = self._tour, text.casefold() == "skip"
        if tour is None or tour.at is None or not (skips or (tour.enter_goes_on and not text)):
            return False
        if skips:
            tour.skip()
        else:
            tour.go_on()
        self._tell_of_tour()
        return True

    def _tell_of_tour(self) -> None:
        teaching = self._teaching
        if self._tour is not None and self._tour.at is not None:
            phrase, activity = next(iter(teaching.sayable), ""), teaching.activity
            at, visits = self._tour.at, goes_to_people(activity)
            self._write(tour_line(at, teaching.teacher, activity.title, phrase, visits=visits))

    def _named(self, name: str) -> str:
        """Change the teacher's name, or return it if no name is given."""
        teaching = self._teaching
        if not name or self._rename is None:
            return teaches_as(teaching.teacher)
        try:
            teaching.teach_as(self._rename(name))
        except TangyError as error:
            return str(error)
        if not teaching.demonstration.steps:
            self._tell(teaching.apply(Discard()))
        return renamed_teacher(teaching.teacher, teaching.demonstration.teacher)

    def _perform(self, word: Perform) -> None:
        """Learn, begin a guided game, or leave for a game; other actions need a screen."""
        if word == Perform("guided"):
            self._guide()
            return
        if word == Perform("learn"):
            self._write_all(left_open_lines(self._teaching))
            self._complete = False
        lines, self.plays = (
            ([ON_THE_SCREEN], False) if self._after is None else (self._after.perform(word))
        )
        self._write_all(lines)

    def _guide(self) -> None:
        """Begin or resume a guided game; the steps of the present game are kept."""
        teaching, shown = self._teaching, self._teaching.demonstration
        if shown.guided and not shown.finished:
            self._write(GUIDED_ALREADY)
            return
        if shown.steps and not shown.finished:
            self._write(left_words(len(shown.steps)))
        teaching.guided = True
        self._tell(teaching.begin())
        self._write(self._inquiries.where())

    def _write_all(self, lines: Iterable[str]) -> None:
        for line in lines:
            self._write(line)

    def _drop_answer(self) -> None:
        """Drop what was typed or said before the question that it would answer."""
        typed, spoken = self._typed, self._spoken
        if typed is not None and typed.done() and read_answer(typed.result() or "") is not None:
            self._typed = None
        if spoken is not None and _is_heard(spoken, Reply):
            self._spoken = None

    def _tell(self, events: Sequence[TeachingEvent]) -> None:
        if self._ears is not None:
            self._ears.follow(events)
        over = self._teaching.demonstration.finished
        for event in events:
            match event:
                case Begun():
                    self._kept = event.resumed
                case Executed() | StepUndone():
                    self._kept = True
                case Finished():
                    self._complete = True
                case Asked() | Offered():
                    self._drop_answer()
                    self._yes.ask()
            self._write_all(teaching_lines(event, self._teaching, self._yes.key))
            if isinstance(event, Asked | Offered) and self._answers:
                self._write(OR_SAY_YES if isinstance(event, Asked) else OR_SAY_WHICH)
            if isinstance(event, Finished):
                self._write_all(self._seen()[:1])
                self._write(GAME_OVER)
            if isinstance(event, Executed | StepUndone) and not over:
                self._write(self._inquiries.where())
        if self._tour is not None and self._tour.follow(events):
            self._tell_of_tour()


def _is_heard(spoken: asyncio.Future[Heard | None], kind: type[Say | Reply]) -> bool:
    """Return whether recognised speech is available, and of a kind: a new command, or an answer."""
    if not spoken.done() or spoken.cancelled() or spoken.exception() is not None:
        return False
    return isinstance(spoken.result(), kind)
