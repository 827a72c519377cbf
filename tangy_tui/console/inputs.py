"""The sources of lines and keys: a script, standard input, or the terminal behind it."""

from __future__ import annotations

import os
import re
import sys
from collections import deque
from collections.abc import Callable, Iterable
from pathlib import Path
from queue import SimpleQueue
from threading import Thread

from tangy_profiles.errors import TangyError
from tangy_profiles.reading import plain

LARGEST_SCRIPT = 4_000_000  # bytes: a hundred thousand lines

WAIT = re.compile(
    r"wait (?:(\d{1,3}(?:\.\d{1,2})?)(?: ?s)?|until (asked|halted|called|over|paused))"
)
"""A line of a script that waits for some s, or until an event."""


def any_waits(lines: Iterable[str]) -> bool:
    """Return whether a line makes a script wait."""
    return any(WAIT.fullmatch(line.casefold()) for line in lines)


def line_reader(script: Path | None) -> Callable[[], str | None]:
    """Return a function that reads lines from the script or standard input.

    Raises:
        TangyError: the script cannot be read, or is too large.
    """
    if script is None:
        lines_in = sys.stdin  # None if it is closed
        return lambda: lines_in.readline() or None if lines_in is not None else None
    try:
        with script.open("rb") as file:  # may be a pipe: `--script <(...)`, /dev/stdin
            content = file.read(LARGEST_SCRIPT + 1)
        if len(content) > LARGEST_SCRIPT:
            raise TangyError(plain(f"{script}: is larger than {LARGEST_SCRIPT:,} bytes."))
        lines = iter(content.decode().splitlines())
    except FileNotFoundError:
        raise TangyError(plain(f"{script}: there is no such file.")) from None
    except (OSError, UnicodeDecodeError):
        raise TangyError(plain(f"{script}: cannot be read as text.")) from None
    return lambda: next(lines, None)


class ReadAhead:
    """Lines read in a thread of their own; games that follow each other share them."""

    def __init__(self, read: Callable[[], str | None]) -> None:
        """Set what blocks for the next line, and returns None at the end."""
        self._read = read
        self._begun = False
        self.lines: SimpleQueue[str | None] = SimpleQueue()
        """The lines read so far; None: there are no more."""
        self.early = deque[str]()
        """Lines that wait for Tangy to ask for its next action."""
        self.ended = False
        """Whether all lines were taken."""

    def begin(self) -> None:
        """Begin to read, unless it has begun."""
        if not self._begun:
            self._begun = True
            Thread(target=self._read_all, daemon=True).start()

    def _read_all(self) -> None:
        while (line := self._read()) is not None:
            self.lines.put(line)
        self.lines.put(None)


def is_typed(script: Path | None) -> bool:
    """Return whether a person is typing the lines."""
    return script is None and sys.stdin is not None and sys.stdin.isatty()


def keys_from_terminal(script: Path | None) -> int:
    """Free standard input, which carries sound, to read keys from the terminal.

    Returns:
        The new file descriptor of the sound.

    Raises:
        TangyError: there is no terminal.
    """
    sound = os.dup(0)
    try:
        keys = os.open("/dev/null" if script is not None else "/dev/tty", os.O_RDWR)
    except OSError:
        raise TangyError(
            "--mic -: the sound comes on standard input, so the answers need a terminal or "
            "--script FILE."
        ) from None
    os.dup2(keys, 0)
    os.close(keys)
    return sound
