"""The events scheduled on the bench."""

from __future__ import annotations

import heapq
from collections.abc import Callable
from itertools import count


class Agenda:
    """Things that happen later: each at its time, those of one time in the order they were made."""

    def __init__(self) -> None:
        self._coming: list[tuple[float, int, Callable[[], object]]] = []
        self._numbers = count()

    def at(self, time: float, happens: Callable[[], object]) -> None:
        """Let something happen at a time (s)."""
        heapq.heappush(self._coming, (time, next(self._numbers), happens))

    def run(self, now: float) -> None:
        """Run all events due at a time (s), and those that they schedule if due, too."""
        while self._coming and self._coming[0][0] <= now:
            heapq.heappop(self._coming)[2]()

    def clear(self) -> None:
        """Let nothing of it happen."""
        self._coming.clear()
