"""How often a second data comes."""

from __future__ import annotations

from collections import deque

WINDOW = 2.0  # s of late that count; a chest screen answers five times in them
FIRST = 1.0  # s after the first that came, before which it cannot be told


class RateEstimator:
    """Counts what comes, by a time that whoever counts gives, in s."""

    def __init__(self) -> None:
        """Begin with nothing."""
        self.restart()

    def restart(self) -> None:
        """Forget what came."""
        self._came: deque[tuple[float, int]] = deque()
        self._number = 0
        self._began: float | None = None

    def count(self, now: float, number: int = 1) -> None:
        """Count something that comes now (in s), or so many at once."""
        if self._began is None:
            self._began = now
        self._came.append((now, number))
        self._number += number
        self._forget(now - WINDOW)

    def rate(self, now: float) -> float | None:
        """Return how many came in a second, of late; None: that cannot be told yet."""
        if self._began is None or now - self._began < FIRST:
            return None
        since = max(self._began, now - WINDOW)
        self._forget(since)
        return self._number / (now - since)

    def _forget(self, until: float) -> None:
        while self._came and self._came[0][0] <= until:
            self._number -= self._came.popleft()[1]
