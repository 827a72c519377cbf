"""The injections of a game, and since when each could be noticed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from tangy_sim.worlds.injection import AT_ONCE, Kind


@dataclass
class Injected:
    """A fault that occurred: its kind, at which step, and after how many s of the world's time.

    `could_show` is the first step from which it could be noticed, None as long as it could not, or
    if it was gone before.
    """

    kind: Kind
    step: int
    seconds: float
    could_show: int | None = None


class InjectionLog:
    """The faults of one game, in the order in which they came."""

    def __init__(self) -> None:
        self.all: list[Injected] = []

    def came(self, kind: Kind, step: int, seconds: float) -> None:
        """Note that a fault came with a step, at a time in s; one of a device shows at once."""
        shows = step if kind.shows == AT_ONCE else None
        self.all.append(Injected(kind, step, seconds, shows))

    def look(self, step: int, can_show: Callable[[Kind], bool]) -> None:
        """Note which of them can be noticed with the step that is about to be done."""
        for one in self.all:
            if one.could_show is None and can_show(one.kind):
                one.could_show = step
