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
    """How often games were paused, for how many s in all, and how many of these were STOPs."""

    count: int = 0
    seconds: float = 0.0
    stops: int = 0

    @classmethod
    def of(cls, each: Iterable[PauseTotal]) -> PauseTotal:
        """Add up the pauses of several games."""
        found = list(each)
        return cls(
            sum(one.count for one in found),
            sum(one.seconds for one in found),
            sum(one.stops for one in found),
        )

    def to_json(self) -> dict[str, float]:
        """Return the totals as `--json` prints them; the time is in s."""
        return {"count": self.count, "seconds": self.seconds}

    def with_stops(self) -> dict[str, float]:
        """Return the same with the number of STOPs among them; the time is in s."""
        return {**self.to_json(), "stops": self.stops}


class PauseClock:
    """Adds up the pauses of a game. Times are in s of the game, and do not decrease."""

    def __init__(self) -> None:
        """Begin with a game that is going."""
        self._since: float | None = None
        self._by: Literal["staff", "resume"] = "staff"
        self._stopped = False
        self._total = PauseTotal()

    def did(self, did: StaffActionKind, at: float) -> None:
        """Add an action of staff at a time in s."""
        if did in BEGIN:
            self._by = "staff"
            if self._since is None:
                self._since, self._stopped = at, did == "stopped"
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
        return self._total

    def _end(self, at: float) -> None:
        if self._since is not None and at > self._since:  # not a stop that ends the game
            ended = PauseTotal(1, at - self._since, int(self._stopped))
            self._total = PauseTotal.of((self._total, ended))
        self._since, self._by, self._stopped = None, "staff", False
