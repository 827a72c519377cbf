"""The count-down to the next call of a live game, which staff can hold."""

from __future__ import annotations

from collections.abc import Callable
from threading import Lock


class CountDown:
    """Counts down from a call to the next one. Any thread may call it."""

    def __init__(self, clock: Callable[[], float]) -> None:
        """Begin at zero; `clock` returns the robot's time in s."""
        self._clock = clock
        self._due = 0.0
        self._held_since: float | None = None
        self._changes = Lock()
        """The game begins count-downs in its thread, while a screen holds them in its own."""

    @property
    def seconds(self) -> float:
        """The s until the next number may be called."""
        with self._changes:
            since = self._held_since
            return max(0.0, self._due - (self._clock() if since is None else since))

    def begin(self, seconds: float) -> None:
        """Count down some s from now, also while staff hold the count-down."""
        with self._changes:
            self._due = self._clock() + seconds
            if self._held_since is not None:
                self._held_since = self._clock()

    def lengthen(self, seconds: float) -> None:
        """Add some s, also negative ones."""
        with self._changes:
            self._due += seconds

    def hold(self, *, held: bool) -> None:
        """Hold the count-down, or let it go on where it was."""
        with self._changes:
            if held and self._held_since is None:
                self._held_since = self._clock()
            elif not held and self._held_since is not None:
                self._due += self._clock() - self._held_since
                self._held_since = None
