"""The frames that a program writes to a terminal: their number, and which change nothing."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from time import monotonic

import pyte

from tests.support.terminal import Terminal

ASKED = b"\x1b[?2026$p"
"""The program's query for marked frames; with a yes, it marks each of them."""
YES = "\x1b[?2026;2$y"
BEGIN, END = b"\x1b[?2026h", b"\x1b[?2026l"


@dataclass(frozen=True, slots=True)
class Frames:
    """The frames of a session. `idle` changed no cell, and left the cursor where it was."""

    all: int
    idle: tuple[bytes, ...]
    bytes: int


class FramedTerminal(Terminal):
    """A terminal that supports marked frames, and reports no size of its own.

    `resized` holds each size with the number of bytes before it.
    """

    def read(self, seconds: float) -> bytes:
        """Read output for this long, and answer the program's queries."""
        chunk = super().read(seconds)
        if ASKED in chunk:
            self.type(YES)
        return chunk

    def watch(self, seconds: float, until: Callable[[], bool] = lambda: False) -> None:
        """Read for a while, or until a condition is true."""
        end = monotonic() + seconds
        while monotonic() < end and not until():
            self.read(0.05)


def frames_of(raw: bytes, columns: int, lines: int) -> Frames:
    """Find the frames in the output to a terminal of one size."""
    screen = pyte.Screen(columns, lines)
    stream = pyte.ByteStream(screen)
    before, *rest = raw.split(BEGIN)
    stream.feed(before)
    idle = list[bytes]()
    for part in rest:
        frame, _, after = part.partition(END)
        shown = _shown(screen)
        stream.feed(frame)
        if _shown(screen) == shown:
            idle.append(frame)
        stream.feed(after)
    return Frames(len(rest), tuple(idle), len(raw))


def _shown(screen: pyte.Screen) -> object:
    """Return every cell, and the cursor's position."""
    cells = [[screen.buffer[y][x] for x in range(screen.columns)] for y in range(screen.lines)]
    return cells, (screen.cursor.x, screen.cursor.y)
