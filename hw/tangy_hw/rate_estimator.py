"""Estimates the rate of data."""

from __future__ import annotations

from collections import deque

WINDOW = 2.0  # s of the sliding window; a chest screen answers five times in it
FIRST = 1.0  # s after the first data, before which the rate is unknown


class RateEstimator:
    """Counts arrivals, with times in s from the caller."""

    def __init__(self) -> None:
        """Start without arrivals."""
        self.restart()

    def restart(self) -> None:
        """Forget all arrivals."""
        self._came: deque[tuple[float, int]] = deque()
        self._number = 0
        self._began: float | None = None

    def count(self, now: float, number: int = 1) -> None:
        """Count one arrival, or several, at a time in s."""
        if self._began is None:
            self._began = now
        self._came.append((now, number))
        self._number += number
        self._forget(now - WINDOW)

    def rate(self, now: float) -> float | None:
        """Return the recent arrivals per second; None if unknown yet."""
        if self._began is None or now - self._began < FIRST:
            return None
        since = max(self._began, now - WINDOW)
        self._forget(since)
        return self._number / (now - since)

    def _forget(self, until: float) -> None:
        while self._came and self._came[0][0] <= until:
            self._number -= self._came.popleft()[1]
