"""Questions in the console before a command that cannot be undone.

They are asked only of a person who types: a script means what it says.
"""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack
from queue import SimpleQueue
from typing import Generic, TypeVar

from tangy_tui.app.command_grammar import ANSWERS
from tangy_tui.app.confirmations import needed_confirmation
from tangy_tui.app.game_commands import ClaimCard, GameCommand
from tangy_tui.app.game_controller import ControllerOutput, GameController
from tangy_tui.console.typed_yes import TypedYes
from tangy_tui.learning.teaching_events import (
    Again,
    Discard,
    Ruled,
    SameWhatever,
    TeacherCommand,
    Undo,
)
from tangy_tui.learning.teaching_session import TeachingSession
from tangy_tui.text.confirmations import (
    BEHIND,
    NOT_DONE,
    ConfirmationWords,
    again_confirmation,
    confirmation_words,
    discard_confirmation,
    rule_confirmation,
    undone_words,
)

_NO_AND_MORE = re.compile(r"(?:n|no)\b[\s,.;:!]+(.+)", re.I)
CommandT = TypeVar("CommandT")
Write = Callable[[str], None]


class TypedConfirmation(Generic[CommandT]):
    """A question about a command, and its answer in a later line."""

    def __init__(self, yes: TypedYes, write: Write) -> None:
        """Parse the answers with `yes`, and write each sentence with `write`."""
        self._yes, self._write = yes, write
        self._asked: tuple[CommandT, ConfirmationWords] | None = None

    @property
    def open(self) -> bool:
        """Whether a question is open."""
        return self._asked is not None

    def _put(
        self,
        command: CommandT,
        words: ConfirmationWords,
        typed: SimpleQueue[str | None] | None = None,
    ) -> None:
        self._asked = command, words
        self._write(words.line(self._yes.ask(typed)))
        self._yes.asked()

    def answer(self, line: str) -> CommandT | None:
        """Return the command that a line confirms; otherwise write what became of it."""
        if self._asked is None:
            return None
        command, words = self._asked
        reply = self._yes.answer(line)
        if isinstance(reply, str):
            self._write(reply)
        elif reply is None or reply.alternative is not None:
            self._write(words.line(self._yes.key))
        elif reply.yes:
            self._asked = None
            return command
        else:
            self._decline()
        return None

    def _decline(self) -> None:
        undone = NOT_DONE if self._asked is None else self._undone_words(self._asked[0])
        self.drop()
        self._write(undone)

    def _undone_words(self, command: CommandT) -> str:
        """Tell that a command is not carried out."""
        return NOT_DONE

    def drop(self) -> None:
        """Close the question."""
        self._asked = None


class ConfirmingStaff(TypedConfirmation[GameCommand]):
    """Asks staff whether they mean a command; the game is held while a question is open."""

    def __init__(
        self, controller: GameController, name: Callable[[str], str], yes: TypedYes, write: Write
    ) -> None:
        """Ask about commands for a controller; `name` returns a person's name."""
        super().__init__(yes, write)
        self._controller, self._name = controller, name
        self._hold = ExitStack()
        self._answered: Callable[[], None] = lambda: None
        self._behind: deque[str] = deque()

    def ask(self, command: GameCommand, typed: SimpleQueue[str | None] | None) -> bool:
        """Return whether a command needs an answer first, and ask for it.

        Args:
            command: the command.
            typed: the lines read so far, of which answers are dropped; None: unread input.
        """
        asked = needed_confirmation(command, self._controller) if self._yes.typed else None
        if asked is not None:
            self._answered = self._hold.enter_context(self._controller.holding())
            self._put(asked.command, confirmation_words(asked, self._name), typed)
        return asked is not None

    def drop(self) -> None:
        """Close the question, and let the game go on."""
        super().drop()
        self._hold.close()

    def no_and_more(self, line: str) -> str:
        """Close an open question if a line says no, and more; return what it says besides.

        It is "" if no question is open, or the line is something else.
        """
        found = _NO_AND_MORE.fullmatch(line.strip())
        if not self.open or found is None:
            return ""
        self._decline()
        return found[1]

    def give_way(self, command: GameCommand, line: str) -> None:
        """Close an open question because staff typed another command instead of an answer.

        A claim does not close the question about another claim: its line is kept; see `behind`.
        """
        if self._asked is None or self._asked[0] == command:
            return
        if isinstance(command, ClaimCard) and isinstance(self._asked[0], ClaimCard):
            self._behind.append(line)
            self._write(BEHIND)
        else:
            self._decline()

    def behind(self) -> Iterator[str]:
        """Yield the lines kept until a question is answered, as long as no other is open."""
        while self._behind and not self.open:
            yield self._behind.popleft()

    def _undone_words(self, command: GameCommand) -> str:
        return undone_words(command)

    def end_of_hold(self) -> Callable[[], Sequence[ControllerOutput]]:
        """Return a function that lets the game go on, once a confirmed command is carried out."""
        self._answered()
        hold = self._hold.pop_all()

        def end() -> Sequence[ControllerOutput]:
            hold.close()
            return ()

        return end


class ConfirmingTeacher(TypedConfirmation[TeacherCommand]):
    """Asks a teacher before steps are taken back or discarded, and before one becomes a rule."""

    def __init__(self, teaching: TeachingSession, yes: TypedYes, write: Write) -> None:
        """Ask about commands for a teaching session."""
        super().__init__(yes, write)
        self._teaching = teaching
        self._unasked = False  # whether the last line made a rule without a question

    def takes(self, line: str) -> bool:
        """Return whether a line answers the open question, or one that a script was not asked.

        A script is asked nothing, but may hold the answer that a person would type.
        """
        unasked, self._unasked = self._unasked, False
        other = self._teaching.question is not None or self._teaching.remark is not None
        return self.open or (unasked and not other and line.casefold() in ANSWERS)

    def answer(self, line: str) -> TeacherCommand | None:
        """Return the command that a line confirms, or that takes back what was done unasked."""
        if self.open:
            return super().answer(line)
        return None if ANSWERS[line.casefold()] else Undo()

    def ask(self, command: TeacherCommand) -> TeacherCommand | None:
        """Return a command that needs no answer; otherwise ask, and return None."""
        present = self._teaching.demonstration
        steps, words = len(present.steps), None
        match command:
            case Discard() if steps:
                words = discard_confirmation(steps)
            case Again(present.id, kept) if 0 <= kept < steps:
                words = again_confirmation(kept + 1, steps)
            case SameWhatever():
                rule = self._teaching.rules.would(present, command)
                if isinstance(rule, Ruled):
                    words = rule_confirmation(rule, self._teaching.activity)
        if words is None or not self._yes.typed:
            self._unasked = words is not None and isinstance(command, SameWhatever)
            return command
        self._put(command, words)
        return None
