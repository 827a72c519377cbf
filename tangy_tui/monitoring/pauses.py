"""How often staff paused a game, and for how long, from its logged actions."""

from __future__ import annotations

from typing import Literal

from tangy_profiles.staff_records import StaffActionKind

BEGIN: tuple[StaffActionKind, ...] = ("paused", "stopped", "program frozen")
END: tuple[StaffActionKind, ...] = ("went on", "let go on", "took over")


class Pauses:
    """Adds up the pauses of a game. Times are in s of the game, and do not decrease."""

    def __init__(self) -> None:
        """Begin with a game that is going."""
        self._since: float | None = None
        self._by: Literal["staff", "resume"] = "staff"
        self._count, self._seconds = 0, 0.0

    def did(self, did: StaffActionKind, at: float) -> None:
        """Add an action of staff."""
        if did in BEGIN:
            self._by = "staff"
            self._since = at if self._since is None else self._since
        elif did in END:
            self._end(at)

    def resumed(self, at: float) -> None:
        """Add that the game was resumed after an interruption: it is paused then."""
        if self._since is None:
            self._since, self._by = at, "resume"

    def step(self, begun: float) -> None:
        """Add a behaviour: old logs do not say when staff let a resumed game go on."""
        if self._by == "resume":
            self._end(begun)

    def total(self, over: float) -> tuple[int, float]:
        """Return the number of pauses, and how long they lasted in all, when a game is over."""
        self._end(over)
        return self._count, self._seconds

    def _end(self, at: float) -> None:
        if self._since is not None:
            self._count += 1
            self._seconds += max(0.0, at - self._since)
        self._since, self._by = None, "staff"
