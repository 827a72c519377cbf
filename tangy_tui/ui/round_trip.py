"""Proof that a question has reached the terminal: the terminal replies to a query sent after it.

After writing a question, Tangy moves the cursor to a position that it uses only once, queries it
(`CSI 6n`), and moves the cursor back. A reply with that position can only come from a terminal that
has drawn the question. Keys count from then on. A reply on the terminal's behalf (by tmux, screen,
mosh) proves nothing; there, the yes to each question is a new random digit, which nobody knows
without reading it.
"""

from __future__ import annotations

import math
import random
import re
from collections import deque
from collections.abc import Callable, Iterable

from textual._xterm_parser import XTermParser
from textual.drivers import linux_driver
from textual.message import Message

from tangy_tui.app.terminal_session import (
    DIGITS,
    QuestionKey,
    TerminalSession,
    answers_for_another,
)
from tangy_tui.ui.pasted_text import marked, pasted_in

MOST_WAITING = 4

SLOW_SECONDS = 0.3
"""A longer reply time indicates a slow link."""

READING_SECONDS = 0.1
"""The shortest time in which a person can see a question that the terminal has drawn."""

Seen = Callable[[float], None]
"""Called with the time from which keys count, in s on the scale of `time.monotonic`."""


class RoundTrip:
    """Asks the terminal whether it has drawn all earlier output."""

    def __init__(
        self,
        write: Callable[[str], None],
        session: Callable[[], TerminalSession],
        clock: Callable[[], float],
        *,
        cursor: Callable[[], tuple[int, int]] = lambda: (0, 0),
        setting: QuestionKey = "auto",
        rng: random.Random | None = None,
    ) -> None:
        """Query a terminal.

        Args:
            write: sends control sequences after the drawn output.
            session: returns where the terminal is; it may change while the program runs.
            clock: returns s, on the scale of `time.monotonic`.
            cursor: returns the column and line, from 0, to move the cursor back to.
            setting: the user's setting of the key for yes.
            rng: draws digits and the first position (default: from the system).
        """
        self._write = write
        self._session = session
        self._clock = clock
        self._setting = setting
        self._random = rng or random.SystemRandom()
        self._size = (80, 24)
        self._cursor = cursor
        self._place = self._random.randrange(1000)
        self._waiting: dict[tuple[int, int], tuple[Seen, float]] = {}
        self._shortest = math.inf  # the shortest reply time so far, in s
        self._answers = False
        self._took: deque[float] = deque(maxlen=3)  # the last reply times, in s
        self._base = 0  # 1 if the terminal reports positions from 0
        self._for_another = False
        self._digit = ""

    # -------------------------------------------------------------------------------- asking

    def begin(self, size: tuple[int, int]) -> None:
        """Find out whether the terminal replies; `size` in columns and lines."""
        self._size = size
        if self._session().remote:
            self._write("\x1b[>c")
        self.ask(lambda time: None)

    def ask(self, seen: Seen) -> None:
        """Call `seen` when the terminal has drawn all output so far."""
        columns, lines = self._size
        # Skip the first line: there a report looks like Shift+F3. Skip the second too, which a
        # terminal that counts from 0 reports as the first.
        places = columns * max(1, lines - 2)
        self._place = (self._place + 1) % places
        line, column = divmod(self._place, columns)
        self._waiting[column, line + 2] = (seen, self._clock())
        x, y = self._cursor()
        self._write(f"\x1b[{line + 3};{column + 1}H\x1b[6n\x1b[{y + 1};{x + 1}H")

    def resized(self, size: tuple[int, int]) -> None:
        """Query again: after a change of size, the terminal may report another position."""
        self._size = size
        waiting, self._waiting = dict.fromkeys(seen for seen, _ in self._waiting.values()), {}
        for seen in waiting:
            self.ask(seen)

    def ask_again(self, seen: Seen) -> None:
        """Query again after a reply that may be lost; only a few queries wait at a time."""
        if sum(1 for waits, _ in self._waiting.values() if waits == seen) < MOST_WAITING:
            self.ask(seen)

    # ------------------------------------------------------------------------------- answers

    def reported(self, x: int, y: int, time: float) -> None:
        """Handle the terminal's reply: a position (from 0), and its time of arrival in s."""
        if y == 0:
            return  # Shift+F3, which Textual parses as a report
        if not self._answers and (x + 1, y + 1) in self._waiting and (x, y) not in self._waiting:
            self._base = 1  # it counts from 0, as kmscon reportedly does
        found = self._waiting.pop((x + self._base, y + self._base), None)
        if found is None:
            return
        seen, asked = found
        self._answers = True
        self._shortest = min(self._shortest, time - asked)
        self._took.append(time - asked)
        self._waiting = {p: waits for p, waits in self._waiting.items() if waits[0] != seen}
        # A delayed reply arrived later than the person saw the question. Keys cannot overtake it,
        # so the reading time may be shorter by the delay.
        held_up = time - asked - self._shortest
        seen(time + max(0.0, READING_SECONDS - held_up))

    def attributes(self, given: str) -> None:
        """Handle the terminal's device attributes ("84;0;0")."""
        self._for_another = answers_for_another(given)

    # ------------------------------------------------------------------------------ the rule

    @property
    def yes(self) -> str:
        """The key for yes to a question that starts now: "y", or a digit drawn for it."""
        if not self.needs_digit:
            return "y"
        self._digit = self._random.choice([d for d in DIGITS if d != self._digit])
        return self._digit

    @property
    def needs_digit(self) -> bool:
        """Whether no reply of the terminal would prove that the person has seen a question."""
        if self._setting != "auto":
            return self._setting == "digit"
        session = self._session()
        proven = self._answers and not (session.multiplexer or self._for_another)
        return session.remote and not proven

    @property
    def slow(self) -> bool:
        """Whether one of the last replies took long."""
        return max(self._took, default=0.0) > SLOW_SECONDS

    @property
    def answers(self) -> bool:
        """Whether the terminal has replied at least once."""
        return self._answers


class ReplyParser(XTermParser):
    """Textual's input parser, which also parses device attributes.

    Textual does not know these replies, and would take them as typed letters.
    """

    heard: Callable[[str], None] | None = None
    """Called with the attributes."""

    _ANSWER = re.compile(r"\x1b\[[>?]([\d;]*)c")
    _BEGUN = re.compile(r"\x1b\[(?:[>?][\d;]*)?\Z")
    _rest = ""

    def feed(self, data: str) -> Iterable[Message]:
        """Parse input from the terminal."""
        if data:
            data = self._ANSWER.sub(self._take, self._rest + data)
            begun = self._BEGUN.search(data)
            self._rest = data[begun.start() :] if begun else ""
            data = data[: begun.start()] if begun else data
            if not data:
                return ()
        return marked(super().feed(data), pasted_in(data))

    def _take(self, found: re.Match[str]) -> str:
        if (heard := type(self).heard) is not None:
            heard(found[1])
        return ""


def read_replies() -> None:
    """Let every application started from now on read with a `ReplyParser`."""
    linux_driver.XTermParser = ReplyParser  # type: ignore[attr-defined]
