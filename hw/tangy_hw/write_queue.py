"""Lines to a process, written by a thread of its own, so that callers never block.

A process that hangs reads nothing, and its pipe is full after a while. What is said then waits
here, in order, and is written when it reads again.
"""

from __future__ import annotations

import os
import threading
from collections import deque
from concurrent.futures import Future
from contextlib import suppress
from typing import IO


class WriteQueue:
    """The queue of one pipe; `run` writes it until `close`, or until the reader is gone."""

    def __init__(self, pipe: IO[bytes]) -> None:
        """Take the pipe, which is closed at the end."""
        self._pipe = pipe
        self.lines: deque[tuple[str, Future[None]]] = deque()
        self._changed = threading.Condition()
        self.writing = self._over = False

    def put(self, line: str) -> Future[None] | None:
        """Queue a line.

        Returns:
            What is done when it is written, or never will be; None where no more is written.
        """
        with self._changed:
            if self._over:
                return None
            return self._append(line)

    def beat(self, line: str) -> None:
        """Have a line written that is worth nothing later: it is left out where others wait."""
        with self._changed:
            if not (self._over or self.lines or self.writing):
                self._append(line)

    def close(self) -> None:
        """Write what waits, and no more."""
        with self._changed:
            self._over = True
            self._changed.notify()

    def run(self) -> None:
        """Write until there is an end."""
        with suppress(OSError, ValueError), self._pipe as pipe:
            while (waits := self._next()) is not None:
                line, written = waits
                rest = memoryview(line.encode() + b"\n")
                try:
                    while rest:  # past its buffer, for whose lock the end of the program would wait
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
