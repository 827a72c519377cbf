"""How often staff paused a game, and for how long, from its logged actions."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal

from tangy_profiles.staff_records import StaffActionKind

BEGIN: tuple[StaffActionKind, ...] = ("paused", "stopped", "program frozen")
END: tuple[StaffActionKind, ...] = ("went on", "let go on", "took over")


@dataclass(frozen=True, slots=True)
class PauseTotal:
    """How often games were paused, and for how many s in all."""

    count: int = 0
    seconds: float = 0.0

    @classmethod
    def of(cls, each: Iterable[PauseTotal]) -> PauseTotal:
        """Add up the pauses of several games."""
        found = list(each)
        return cls(sum(one.count for one in found), sum(one.seconds for one in found))

    def to_json(self) -> dict[str, float]:
        """Return the totals as `--json` prints them; the time is in s."""
        return {"count": self.count, "seconds": self.seconds}


class PauseClock:
    """Adds up the pauses of a game. Times are in s of the game, and do not decrease."""

    def __init__(self) -> None:
        """Begin with a game that is going."""
        self._since: float | None = None
        self._by: Literal["staff", "resume"] = "staff"
        self._count, self._seconds = 0, 0.0

    def did(self, did: StaffActionKind, at: float) -> None:
        """Add an action of staff at a time in s."""
        if did in BEGIN:
            self._by = "staff"
            self._since = at if self._since is None else self._since
        elif did in END:
            self._end(at)

    def resumed(self, at: float) -> None:
        """Add that the game was resumed at a time in s, paused, after an interruption."""
        if self._since is None:
            self._since, self._by = at, "resume"

    def step(self, begun: float) -> None:
        """Add a behaviour that began at a time in s.

        Old logs do not say when staff let a resumed game go on.
        """
        if self._by == "resume":
            self._end(begun)

    def total(self, over: float) -> PauseTotal:
        """Return the pauses of a game that is over at a time in s."""
        self._end(over)
        return PauseTotal(self._count, self._seconds)

    def _end(self, at: float) -> None:
        if self._since is not None and at > self._since:  # not a stop that ends the game
            self._count += 1
            self._seconds += at - self._since
        self._since, self._by = None, "staff"
