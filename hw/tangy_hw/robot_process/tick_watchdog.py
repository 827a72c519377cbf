"""Detects from very late ticks that the robot's control was frozen."""

from __future__ import annotations

import time
from collections.abc import Callable

LATE_SECONDS = 1.5
"""Maximum time between ticks: a busy machine delays them by some tenths; after a longer delay, the
robot was without control, and the room may have changed."""


def time_awake_and_asleep() -> float:
    """Return a monotonic time in s that includes sleep of the machine."""
    if hasattr(time, "CLOCK_BOOTTIME"):
        return time.clock_gettime(time.CLOCK_BOOTTIME)
    return time.monotonic()


class TickWatch:
    """Watches the time between ticks, once `begin` was called."""

    def __init__(
        self, clock: Callable[[], float] = time_awake_and_asleep, late: float = LATE_SECONDS
    ) -> None:
        """Prepare the watch; a tick more than `late` s after the last one is too late."""
        self.frozen = 0.0
        """For how many s control was frozen, until staff acknowledge it."""
        self._clock = clock
        self._late = late
        self._last: float | None = None

    def begin(self) -> None:
        """Start to watch, without a known freeze."""
        self.frozen, self._last = 0.0, self._clock()

    @property
    def overdue(self) -> bool:
        """Whether the next tick is overdue, so that all data is old."""
        return self._last is not None and self._clock() - self._last > self._late

    def tick(self) -> bool:
        """Record a tick; return whether control was frozen before it."""
        if self._last is None:
            return False
        now = self._clock()
        late, self._last = now - self._last, now
        if late <= self._late:
            return False
        self.frozen = max(self.frozen, late)
        return True
