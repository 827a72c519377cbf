"""Converts a device's time stamps to the robot's clock.

The clocks differ by an unknown constant, and messages take a varying time to arrive. The one that
arrived soonest shows the constant best, so a message that the network delayed is not taken for a
newer one.

Some drivers write whole seconds or a constant into each header, and some clocks run at another
speed. Such stamps repeat, or jump again and again: then the times of arrival count.
"""

from __future__ import annotations

from math import inf

WINDOW = 30.0  # s in which the soonest message counts, as clocks drift apart
JUMP = 2.0  # s by which a message may be later than the soonest one; above it, the clock was set


class SourceClock:
    """The clock of one device."""

    def __init__(self) -> None:
        self._soonest = self._before = inf  # in this window, and in the one before
        self._since = self._doubted = -inf
        self._last: float | None = None
        self._jumped = -inf

    def measured(self, stamp: float, arrived: float) -> float | None:
        """Return when a message was measured, on the robot's clock (s); None if it does not tell.

        Args:
            stamp: its time on the device's clock, in s.
            arrived: when it arrived on the robot's clock, in s.
        """
        took = arrived - stamp
        if stamp == self._last:
            self._doubted = arrived
        if abs(took - min(self._soonest, self._before)) > JUMP:
            if self._last is not None:
                self._doubted = arrived if arrived - self._jumped < WINDOW else self._doubted
                self._jumped = arrived
            self._soonest = self._before = inf
            self._since = arrived
        elif arrived - self._since > WINDOW:
            self._soonest, self._before, self._since = inf, self._soonest, arrived
        self._soonest = min(self._soonest, took)
        self._last = stamp
        if arrived - self._doubted < WINDOW:
            return None
        return stamp + min(self._soonest, self._before)
