"""Cancelling the start of a robot from another thread.

Opening takes seconds and starts processes. Each step looks first whether it was called off, and
each process, as soon as it is started, names what ends it.
"""

from __future__ import annotations

import threading
from collections.abc import Callable

from tangy_profiles.errors import TangyError


class Cancelled(TangyError):
    """The start was cancelled."""

    def __init__(self) -> None:
        super().__init__("It was called off while it was being switched on.")


class Cancellation:
    """One opening, which may be called off until it is complete."""

    def __init__(self) -> None:
        """Begin an opening."""
        self._lock = threading.Lock()
        self._ends: list[Callable[[], None]] = []
        self._cancelled = self._complete = False

    @property
    def cancelled(self) -> bool:
        """Whether it was called off."""
        return self._cancelled

    def check(self) -> None:
        """Go on only if it was not called off.

        Raises:
            Cancelled: it was.
        """
        if self._cancelled:
            raise Cancelled

    def register(self, end: Callable[[], None]) -> None:
        """Have something ended when this is called off; at once, where it was already.

        Args:
            end: is called from any thread, and must not wait.
        """
        with self._lock:
            if self._complete:
                return
            if not self._cancelled:
                self._ends.append(end)
                return
        end()

    def complete(self) -> None:
        """Say that all is open: from now on there is nothing to call off.

        Raises:
            Cancelled: it was called off before.
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
