"""Pending faults of a game, and when each of them starts."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from tangy_sim.worlds.injection import FaultKind, Injection


class ToCome:
    """Pending injections of one game."""

    def __init__(self, injections: Sequence[Injection], chance: Callable[[], float]) -> None:
        """Start a game; `chance` draws a number from 0 to 1 for random injections."""
        self._given = tuple(injections)
        self._left = list(injections)
        self._chance = chance

    @property
    def left(self) -> tuple[Injection, ...]:
        """Injections that have not occurred, with all random ones."""
        return tuple(self._left)

    @property
    def words(self) -> list[str]:
        """Injections that have not occurred, except random ones."""
        return [str(one) for one in self._left if one.chance is None]

    def add(self, kind: FaultKind) -> None:
        """Add a fault that starts as soon as it can show."""
        self._left.append(Injection(kind))

    def drop(self, kind: str) -> None:
        """Drop an added fault; those given at the start stay."""
        self._left = [i for i in self._left if i.kind.name != kind or i in self._given]

    def due(self, step: int, can_show: Callable[[FaultKind], bool]) -> list[FaultKind]:
        """Return the faults that start at a step, by `can_show` if that decides."""
        come, left = list[FaultKind](), list[Injection]()
        for one in self._left:
            if one.chance is not None:
                comes = self._chance() < one.chance
            elif one.step is not None:
                comes = one.step == step
            else:
                comes = not one.in_recovery and can_show(one.kind)
            if comes:
                come.append(one.kind)
            if one.chance is not None or not comes:
                left.append(one)
        self._left = left
        return come

    def due_in_recovery(self) -> list[FaultKind]:
        """Return the faults that start during the recovery from another one."""
        come = [one for one in self._left if one.in_recovery]
        self._left = [one for one in self._left if not one.in_recovery]
        return [one.kind for one in come]
