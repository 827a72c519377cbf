"""Start-up of a robot as seen from another thread: its progress, and its cancellation.

Start-up takes seconds and starts processes. Each step first checks whether it was cancelled, and
each started process registers how to end it.
"""

from __future__ import annotations

import threading
from collections.abc import Callable

from tangy_profiles.errors import TangyError


class Cancelled(TangyError):
    """Start-up was cancelled."""

    def __init__(self) -> None:
        super().__init__("It was called off while it was being switched on.")


class Cancellation:
    """Progress of one start-up, which can be cancelled until it is complete."""

    def __init__(self) -> None:
        """Begin a start-up."""
        self._lock = threading.Lock()
        self._ends: list[Callable[[], None]] = []
        self._cancelled = self._complete = False
        self.parts: tuple[str, ...] = ()
        """Parts started so far, the last one in progress: devices, "bench", "faces", "program",
        "senses" (the readers of cards and faces), "first words" (the first data of each device)."""
        self.done: tuple[int, int] | None = None
        """Finished and total pieces of the current part; None if it has none."""

    def starts(self, part: str, done: int = 0, of: int = 0) -> None:
        """Report the part being started, and how many of its pieces are done."""
        self.done = (done, of) if of else None
        if self.parts[-1:] != (part,):
            self.parts = (*self.parts, part)

    @property
    def cancelled(self) -> bool:
        """Whether it was cancelled."""
        return self._cancelled

    def check(self) -> None:
        """Check that start-up may go on.

        Raises:
            Cancelled: it was cancelled.
        """
        if self._cancelled:
            raise Cancelled

    def register(self, end: Callable[[], None]) -> None:
        """Register a callback for cancellation; call it at once if already cancelled.

        Args:
            end: the callback, called from any thread; it must not block.
        """
        with self._lock:
            if self._complete:
                return
            if not self._cancelled:
                self._ends.append(end)
                return
        end()

    def complete(self) -> None:
        """Complete the start-up: from now on it cannot be cancelled.

        Raises:
            Cancelled: it was cancelled before.
        """
        with self._lock:
            self.check()
            self._complete = True
            self._ends.clear()

    def cancel(self) -> None:
        """Cancel: end everything started, the newest first, and start nothing more."""
        with self._lock:
            if self._complete or self._cancelled:
                return
            self._cancelled = True
            ends, self._ends = self._ends[::-1], []
        for end in ends:
            end()
