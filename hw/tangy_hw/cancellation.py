"""The start of a robot, as another thread sees it: what starts now, and cancelling that.

Opening takes seconds and starts processes. Each step looks first whether it was called off, and
each process, as soon as it is started, names what ends it.
"""

from __future__ import annotations

import threading
from collections.abc import Callable

from tangy_profiles.errors import TangyError

PARTS = ("bench", "faces", "program", "senses", "first words")
"""What is started beside devices.

The simulated devices, the pictures of faces, the process in the robot, what reads cards and faces;
the last one waits for each device to have said something.
"""


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
        self.parts: tuple[str, ...] = ()
        """What was started so far: names of devices and of `PARTS`; the last is being started."""
        self.done: tuple[int, int] | None = None
        """How many pieces of the last part are done, of how many; None: it has none."""

    def starts(self, part: str, done: int = 0, of: int = 0) -> None:
        """Say what is being started now, and how many of its pieces are done."""
        self.done = (done, of) if of else None
        if self.parts[-1:] != (part,):
            self.parts = (*self.parts, part)

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
