"""Lines to a process, written by a thread of their own: whoever has something to say never waits.

A process that hangs reads nothing, and its pipe is full after a while. What is said then waits
here, in order, and is written when it reads again.
"""

from __future__ import annotations

import os
import threading
from collections import deque
from contextlib import suppress
from typing import IO


class WriteQueue:
    """What is to be written to one pipe; `run` writes it until `close`, or until nobody reads."""

    def __init__(self, pipe: IO[bytes]) -> None:
        """Take the pipe, which is closed at the end."""
        self._pipe = pipe
        self._lines: deque[str] = deque()
        self._changed = threading.Condition()
        self._writing = self._over = False

    def put(self, line: str) -> bool:
        """Have a line written after all that wait; return whether it may still be."""
        with self._changed:
            if not self._over:
                self._lines.append(line)
                self._changed.notify()
            return not self._over

    def beat(self, line: str) -> None:
        """Have a line written that is worth nothing later: it is left out where others wait."""
        with self._changed:
            if not (self._over or self._lines or self._writing):
                self._lines.append(line)
                self._changed.notify()

    def close(self) -> None:
        """Write what waits, and no more."""
        with self._changed:
            self._over = True
            self._changed.notify()

    def run(self) -> None:
        """Write until there is an end."""
        with suppress(OSError, ValueError), self._pipe as pipe:
            while (line := self._next()) is not None:
                rest = memoryview(line.encode() + b"\n")
                while rest:  # past its buffer, whose lock whoever ends the program would wait for
                    rest = rest[os.write(pipe.fileno(), rest) :]
        self.close()

    def _next(self) -> str | None:
        with self._changed:
            self._writing = False
            self._changed.wait_for(lambda: self._lines or self._over)
            self._writing = bool(self._lines)
            return self._lines.popleft() if self._lines else None
