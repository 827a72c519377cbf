"""How a yes is typed to a question by lines: y, or a digit where the person sits elsewhere.

A line that was typed before its question was written answers nothing. From another machine it may
be on its way longer than that can be told; there the yes is a digit that the question names.
"""

from __future__ import annotations

import random
import sys
from collections.abc import Callable
from queue import Empty, SimpleQueue

from tangy_tui.app.command_grammar import read_answer
from tangy_tui.app.terminal_session import DIGITS, QuestionKey, TerminalSession, terminal_session
from tangy_tui.learning.verification import Asked, Offered, Reply, Verification
from tangy_tui.text.questions import yes_words


class TypedYes:
    """Says which line is a yes to the question that was asked last."""

    def __init__(
        self,
        *,
        terminal: bool = False,
        setting: QuestionKey = "auto",
        session: Callable[[], TerminalSession] = terminal_session,
        flush: Callable[[], None] | None = None,
    ) -> None:
        """Make it.

        Args:
            terminal: the lines are typed by a person now; a script answers as it is written.
            setting: what the user wants.
            session: looks at where the person sits.
            flush: drops what was typed and not yet read (default: on standard input).
        """
        self._terminal = terminal
        self._digit = terminal and (setting == "digit" or (setting == "auto" and session().remote))
        self._flush = flush or _flush_input
        self._random = random.SystemRandom()
        self.key = "Y"

    def ask(self, typed: SimpleQueue[str | None] | None = None) -> str:
        """Drop the answers that were typed ahead, and return what says yes to a new question.

        Args:
            typed: the lines that were read already. Where there are such, nothing is dropped of
                what is being typed: it may be a stop.
        """
        if self._terminal and typed is None:
            self._flush()
        elif self._terminal and typed is not None:
            _drop_answers(typed)
        if self._digit:
            self.key = self._random.choice([digit for digit in DIGITS if digit != self.key])
        return self.key

    def ask_of(self, said: Verification, typed: SimpleQueue[str | None] | None = None) -> str:
        """Do so where a verification asks something; return what says yes to it."""
        return self.ask(typed) if isinstance(said, Asked | Offered) else self.key

    def answer(self, line: str) -> Reply | str | None:
        """Return the answer that a line is, what is wrong with it, or None if it is none."""
        reply = read_answer(line)
        if not self._digit or reply is None:
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
    """Drop what was typed on the terminal and not read."""
    import termios

    try:
        termios.tcflush(sys.stdin, termios.TCIFLUSH)
    except (termios.error, ValueError):  # it has gone; there is nothing to drop
        return
