"""Schedule of events on the bench."""

from __future__ import annotations

import heapq
from collections.abc import Callable
from itertools import count


class Agenda:
    """A queue of events by time; simultaneous events run in the order of their insertion."""

    def __init__(self) -> None:
        self._coming: list[tuple[float, int, Callable[[], object]]] = []
        self._numbers = count()

    def at(self, time: float, happens: Callable[[], object]) -> None:
        """Schedule an event at a time (s)."""
        heapq.heappush(self._coming, (time, next(self._numbers), happens))

    def run(self, now: float) -> None:
        """Run all events due at a time (s), including due events that they schedule."""
        while self._coming and self._coming[0][0] <= now:
            heapq.heappop(self._coming)[2]()

    def clear(self) -> None:
        """Drop all events."""
        self._coming.clear()
