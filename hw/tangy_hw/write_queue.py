"""Queue of lines to a process, written by its own thread, so that callers never block.

A process that hangs reads nothing, and its pipe fills up. Lines then wait here, in order, until it
reads again.
"""

from __future__ import annotations

import os
import threading
from collections import deque
from concurrent.futures import Future
from contextlib import suppress
from typing import IO


class WriteQueue:
    """Queue of one pipe; `run` writes it until `close`, or until the reader is gone."""

    def __init__(self, pipe: IO[bytes]) -> None:
        """Set the pipe, which is closed at the end."""
        self._pipe = pipe
        self.lines: deque[tuple[str, Future[None]]] = deque()
        self._changed = threading.Condition()
        self.writing = self._over = False

    def put(self, line: str) -> Future[None] | None:
        """Queue a line.

        Returns:
            A future, done when the line is written or never will be; None if the queue is closed.
        """
        with self._changed:
            if self._over:
                return None
            return self._append(line)

    def beat(self, line: str) -> None:
        """Send a line that is only useful now: it is dropped if others are queued."""
        with self._changed:
            if not (self._over or self.lines or self.writing):
                self._append(line)

    def close(self) -> None:
        """Write the queued lines, and accept no more."""
        with self._changed:
            self._over = True
            self._changed.notify()

    def run(self) -> None:
        """Write lines until the queue is closed and empty."""
        with suppress(OSError, ValueError), self._pipe as pipe:
            while (waits := self._next()) is not None:
                line, written = waits
                rest = memoryview(line.encode() + b"\n")
                try:
                    while rest:  # bypasses its buffer, whose lock would delay the program's exit
                        rest = rest[os.write(pipe.fileno(), rest) :]
                finally:
                    _done(written)
        self.close()
        for _, never in self.lines:
            _done(never)

    def _append(self, line: str) -> Future[None]:
        written: Future[None] = Future()
        self.lines.append((line, written))
        self._changed.notify()
        return written

    def _next(self) -> tuple[str, Future[None]] | None:
        with self._changed:
            self.writing = False
            self._changed.wait_for(lambda: self.lines or self._over)
            self.writing = bool(self.lines)
            return self.lines.popleft() if self.lines else None


def _done(written: Future[None]) -> None:
    if written.set_running_or_notify_cancel():
        written.set_result(None)
