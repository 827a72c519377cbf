"""Whether a robot's control was frozen: ticks that come much too late tell."""

from __future__ import annotations

import time
from collections.abc import Callable

LATE_SECONDS = 1.5
"""From one tick to the next: a busy machine makes them late by a few tenths; what takes longer has
left a robot without control, and the room is not as it was."""


def time_awake_and_asleep() -> float:
    """Return the time in s, in which that counts for which the whole machine slept."""
    if hasattr(time, "CLOCK_BOOTTIME"):
        return time.clock_gettime(time.CLOCK_BOOTTIME)
    return time.monotonic()


class TickWatch:
    """Watches how long after one another ticks come, once it is begun."""

    def __init__(
        self, clock: Callable[[], float] = time_awake_and_asleep, late: float = LATE_SECONDS
    ) -> None:
        """Prepare; a tick that comes more than `late` s after the last is much too late."""
        self.frozen = 0.0
        """For how many s control was frozen, until staff have seen to it."""
        self._clock = clock
        self._late = late
        self._last: float | None = None

    def begin(self) -> None:
        """Watch from now on, with nothing known to be amiss."""
        self.frozen, self._last = 0.0, self._clock()

    @property
    def overdue(self) -> bool:
        """Whether the next tick is overdue, so that all data is old."""
        return self._last is not None and self._clock() - self._last > self._late

    def tick(self) -> bool:
        """Take note of a tick; return whether control was frozen before it."""
        if self._last is None:
            return False
        now = self._clock()
        late, self._last = now - self._last, now
        if late <= self._late:
            return False
        self.frozen = max(self.frozen, late)
        return True
