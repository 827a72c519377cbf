"""Log of the faults injected in a game, and when each could be noticed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from tangy_sim.worlds.injection import AT_ONCE, FaultKind


@dataclass
class Injected:
    """A fault that occurred: its kind, its step, and its time in s of the world's clock.

    `could_show` is the first step at which it could be noticed, None if it never could.
    """

    kind: FaultKind
    step: int
    seconds: float
    could_show: int | None = None


class InjectionLog:
    """Faults of one game, in the order of their start."""

    def __init__(self) -> None:
        self.all: list[Injected] = []

    def came(self, kind: FaultKind, step: int, seconds: float) -> None:
        """Record a fault's start at a step and a time in s; device faults show at once."""
        shows = step if kind.shows == AT_ONCE else None
        self.all.append(Injected(kind, step, seconds, shows))

    def look(self, step: int, can_show: Callable[[FaultKind], bool]) -> None:
        """Record which faults can be noticed in the coming step."""
        for one in self.all:
            if one.could_show is None and can_show(one.kind):
                one.could_show = step
