"""Lines that a person types while the program writes: no output runs into what they type.

The terminal hands over each key, and this module echoes it. Each line of output goes above the
line that is being typed. A terminal without a cursor ("dumb") gets the typed text again below it.
"""

from __future__ import annotations

import codecs
import os
import re
import select
import signal
import sys
import termios
import threading
import unicodedata
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from time import monotonic
from typing import TextIO

LOOK_SECONDS = 0.5
"""The interval between two checks of the terminal's mode, which a shell may have changed."""
READ_BYTES = 4096
LONGEST = 1000  # characters of a typed line
END_OF_INPUT, ERASE_LINE, ERASE_WORD, REDRAW, ESCAPE = "\x04", "\x15", "\x17", "\x12", "\x1b"
BACKSPACES = ("\x7f", "\b")
ASK_CURSOR, CURSOR = "\x1b[6n", re.compile(r"\x1b\[\d+;\d+R")
"""The question for the terminal's cursor, and its reply: what came before it is on the screen."""
REPLY_SECONDS = 1.0
"""A terminal that has not replied by then never does."""


def cells_of(text: str) -> int:
    """Return the width of a text on a terminal, in cells; the console does not load rich for it."""
    return sum(
        0 if unicodedata.combining(one) else 2 if unicodedata.east_asian_width(one) in "WF" else 1
        for one in text
    )


class LineEditor:
    """The line that is being typed: takes characters, returns complete lines."""

    def __init__(self) -> None:
        self.text = ""
        """The text that was typed since the last complete line."""
        self._sequence = ""  # of an escape sequence so far
        self.replies = 0
        """The number of the terminal's replies among what was typed."""

    def take(self, character: str) -> str | None:
        """Take a character; return the line that it completes, None if it completes none."""
        if self._sequence or character == ESCAPE:
            self._skip(character)
        elif character in "\r\n":
            line, self.text = self.text, ""
            return line
        elif character in BACKSPACES:
            self.text = self.text[:-1]
        elif character == ERASE_LINE:
            self.text = ""
        elif character == ERASE_WORD:
            self.text = self.text.rstrip().rpartition(" ")[0]
            self.text += " " if self.text else ""
        elif (character.isprintable() or character == "\t") and len(self.text) < LONGEST:
            self.text += " " if character == "\t" else character
        return None

    def _skip(self, character: str) -> None:
        """Skip the escape sequence of a key such as an arrow."""
        self._sequence += character
        begins = len(self._sequence) == 1 or self._sequence in ("\x1b[", "\x1bO")
        if not begins and not (self._sequence[1] == "[" and character in "0123456789;<=>?"):
            self.replies += bool(CURSOR.fullmatch(self._sequence))
            self._sequence = ""


class TypedLines:
    """The lines of a terminal, and the output above them. `write` may be called by any thread."""

    def __init__(
        self, keys: int, out: TextIO, print_line: Callable[[str], None], *, dumb: bool = False
    ) -> None:
        """Read the keys of a terminal.

        Args:
            keys: its file descriptor.
            out: echoes what is typed.
            print_line: writes a line of output to the same terminal.
            dumb: whether it has no cursor that moves.
        """
        self._keys, self._out, self._print_line, self._dumb = keys, out, print_line, dumb
        self._line = LineEditor()
        self._come: deque[str] = deque()  # characters after a complete line
        self._decode = codecs.getincrementaldecoder("utf-8")("replace").decode
        self._drawing = threading.Lock()
        self._before = termios.tcgetattr(keys)
        self._mode = threading.RLock()  # `prepare` is also called by a signal
        self._given_back = False
        self._unseen, self._unseen_until = 0, 0.0  # questions that may not be on the screen yet
        self._is_answer: Callable[[str], bool] = lambda line: False
        self._replies = not dumb  # whether the terminal is known or believed to reply
        self.too_early: Callable[[], object] = lambda: None
        """Called after an answer was dropped that was typed before its question was shown."""

    def read(self) -> str | None:
        """Return the next line; None at the end of the input."""
        while True:
            while self._come:
                character = self._come.popleft()
                if character == END_OF_INPUT and not self._line.text:
                    return None
                if (line := self._take(character)) is not None:
                    return f"{line}\n"
            if not select.select([self._keys], [], [], LOOK_SECONDS)[0]:
                self.prepare()
                continue
            try:
                typed = os.read(self._keys, READ_BYTES)
            except OSError:  # the terminal is gone
                typed = b""
            if not typed:
                return None
            self._come.extend(self._decode(typed))

    def write(self, line: str) -> None:
        """Write a line of output above the line that is being typed."""
        with self._drawing:
            self._erase()
            self._print_line(line)
            self._echo(self._line.text)

    def drop(self, dropped: Callable[[str], bool]) -> None:
        """Erase the text that is being typed, if it is one to be dropped.

        It belongs to a question that is written next: until the terminal has shown that, further
        such lines are dropped, too. Call `ask_terminal` once the question is written.
        """
        with self._drawing:
            self._is_answer = dropped
            self._drop_begun()
            if self._replies:
                self._unseen += 1
                self._unseen_until = monotonic() + REPLY_SECONDS

    def ask_terminal(self) -> None:
        """Ask the terminal whether the question that was written is on the screen."""
        with self._drawing:
            if self._unseen:
                self._unseen_until = monotonic() + REPLY_SECONDS
                self._echo(ASK_CURSOR)

    def _drop_begun(self) -> None:
        if self._line.text and self._is_answer(self._line.text):
            self._erase()
            self._line.text = ""

    def _is_unseen(self) -> bool:
        """Return whether a question may not be on the screen yet."""
        if self._unseen and monotonic() > self._unseen_until:
            self._unseen, self._replies = 0, False
        return bool(self._unseen)

    def prepare(self) -> None:
        """Let the terminal hand over each key without echoing it, as long as it is ours."""
        with self._mode, suppress(termios.error, OSError):
            mode = termios.tcgetattr(self._keys)
            echoes = termios.ICANON | termios.ECHO
            if mode[3] & echoes and self._is_ours and not self._given_back:
                mode[3] &= ~echoes
                termios.tcsetattr(self._keys, termios.TCSANOW, mode)

    @property
    def _is_ours(self) -> bool:
        """Whether this process may change the mode: a job in the background would be stopped."""
        try:
            return os.tcgetpgrp(self._keys) == os.getpgrp()
        except OSError:  # it controls no jobs
            return True

    def restore(self) -> None:
        """Give the terminal back as it was, and leave it so, even if lines are still being read."""
        with self._mode, suppress(termios.error):
            self._given_back = True
            if self._is_ours:
                termios.tcsetattr(self._keys, termios.TCSANOW, self._before)

    def _take(self, character: str) -> str | None:
        with self._drawing:
            before, replies, unseen = self._line.text, self._line.replies, self._is_unseen()
            line = self._line.take(character)
            after = self._line.text
            early = unseen and line is not None and self._is_answer(line)
            if early:
                self._erase(before)
            elif line is not None:
                self._echo("\n")
            elif after.startswith(before) and character != REDRAW:
                self._echo(after[len(before) :])
            else:
                self._erase(before)
                self._echo(after)
            if unseen and self._line.replies > replies:
                self._unseen -= 1
                self._drop_begun()
        if early:
            self.too_early()
        return None if early else line

    def _erase(self, text: str | None = None) -> None:
        """Erase the typed text from the screen; on a dumb terminal, begin a new line."""
        text = self._line.text if text is None else text
        if not text:
            return
        up = max(0, cells_of(text) - 1) // self._columns
        self._echo("\n" if self._dumb else "\r" + (f"\x1b[{up}A" if up else "") + "\x1b[J")

    @property
    def _columns(self) -> int:
        try:
            return os.get_terminal_size(self._keys).columns or 80
        except OSError:
            return 80

    def _echo(self, text: str) -> None:
        if text:
            self._out.write(text)
            self._out.flush()


@contextmanager
def typed_lines(print_line: Callable[[str], None]) -> Iterator[TypedLines | None]:
    """Provide the lines of the terminal, and restore it afterwards; None if there is none."""
    if not (sys.stdin and sys.stdin.isatty() and sys.stdout and sys.stdout.isatty()):
        yield None
        return
    dumb = os.environ.get("TERM", "dumb") == "dumb"
    lines = TypedLines(sys.stdin.fileno(), sys.stdout, print_line, dumb=dumb)
    lines.prepare()
    try:
        with at_continue(lines.prepare):
            yield lines
    finally:
        lines.restore()


@contextmanager
def at_continue(prepare: Callable[[], object]) -> Iterator[None]:
    """Prepare the terminal again when a stopped program goes on: the shell has changed its mode."""
    try:
        before = signal.signal(signal.SIGCONT, lambda number, frame: prepare())
    except ValueError:  # signals reach only the main thread
        yield
        return
    try:
        yield
    finally:
        signal.signal(signal.SIGCONT, before)
