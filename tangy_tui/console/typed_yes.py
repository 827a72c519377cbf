"""A typed yes in the console: y, or a digit if the person is on another machine.

A line typed before its question does not answer it. From another machine its delay is unknown, so
there the yes is a digit that the question names. A yes that comes faster than anybody reacts was
typed before the question could be read, so that Tangy asks for it again.
"""

from __future__ import annotations

import random
import sys
from collections.abc import Callable
from queue import Empty, SimpleQueue
from time import monotonic

from tangy_tui.app.command_grammar import read_answer
from tangy_tui.app.terminal_session import DIGITS, QuestionKey, TerminalSession, terminal_session
from tangy_tui.learning.verification import Asked, Offered, Reply, Verification
from tangy_tui.text.questions import TOO_EARLY, yes_words

REACTION_SECONDS = 0.1
"""Nobody reacts to what they see in less (a simple visual reaction takes about .2 s)."""


class TypedYes:
    """Parses a typed yes to the last question."""

    def __init__(
        self,
        *,
        terminal: bool = False,
        setting: QuestionKey = "auto",
        session: Callable[[], TerminalSession] = terminal_session,
        flush: Callable[[], None] | None = None,
        clock: Callable[[], float] = monotonic,
    ) -> None:
        """Parse typed answers.

        Args:
            terminal: a person types the lines; a script answers as written.
            setting: the user's setting of the key for yes.
            session: returns where the terminal is.
            flush: drops typed input that was not read yet (default: of standard input).
            clock: returns s on a scale that only goes forward.
        """
        self.typed = terminal
        """Whether a person types the lines."""
        self._digit = terminal and (setting == "digit" or (setting == "auto" and session().remote))
        self._flush = flush or _flush_input
        self.drop_begun: Callable[[Callable[[str], bool]], None] = lambda dropped: None
        """Drops the line that is being typed, if a function returns True for it."""
        self.written: Callable[[], object] = lambda: None
        """Finds out when the question that was written is on the terminal."""
        self._clock = clock
        self._readable_from = clock()
        self._random = random.SystemRandom()
        self.key = "Y"

    def ask(self, typed: SimpleQueue[str | None] | None = None) -> str:
        """Drop answers typed ahead, and return the key for yes to a new question.

        Write the question with it, and call `asked` then.

        Args:
            typed: the lines read so far, of which answers are dropped. In this case unread input is
                kept, since it may be a stop.
        """
        if self.typed and typed is None:
            self._flush()
        elif self.typed and typed is not None:
            self.drop_begun(lambda begun: read_answer(begun) is not None)
            _drop_answers(typed)
        self._readable_from = self._clock() + REACTION_SECONDS
        if self._digit:
            self.key = self._random.choice([digit for digit in DIGITS if digit != self.key])
        return self.key

    def asked(self) -> None:
        """Begin to take a yes: the question is written now, which may have taken time."""
        if self.typed:
            self._readable_from = self._clock() + REACTION_SECONDS
            self.written()

    def ask_of(self, said: Verification, typed: SimpleQueue[str | None] | None = None) -> str:
        """Do so if a verification asks something; return the key for yes."""
        return self.ask(typed) if isinstance(said, Asked | Offered) else self.key

    def answer(self, line: str) -> Reply | str | None:
        """Return the answer in a line, the problem with it, or None if it is none."""
        reply = read_answer(line)
        if reply is None:
            return None
        executes = reply.yes or reply.alternative is not None
        if self.typed and executes and self._clock() < self._readable_from:
            return TOO_EARLY
        if not self._digit:
            return reply
        if line.strip() == self.key:
            return Reply(yes=True)
        return yes_words(self.key) if reply.yes else reply


def _drop_answers(typed: SimpleQueue[str | None]) -> None:
    kept: list[str | None] = []
    try:
        while True:
            line = typed.get_nowait()
            if line is None or read_answer(line) is None:
                kept.append(line)
    except Empty:
        for line in kept:
            typed.put(line)


def _flush_input() -> None:
    """Drop unread input of the terminal."""
    import termios

    try:
        termios.tcflush(sys.stdin, termios.TCIFLUSH)
    except (termios.error, ValueError):  # it is closed; there is nothing to drop
        return
