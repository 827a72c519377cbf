"""Worlds whose games people can leave and come to, with cards or by facts."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol, runtime_checkable

from tangy_profiles.game_rules import GamePlan
from tangy_profiles.state import ActivityState

if TYPE_CHECKING:
    from tangy_profiles.game_records import GameChange


@runtime_checkable
class Gathering(Protocol):
    """A world that knows who has left, or has not come yet."""

    people: tuple[str, ...]
    away: frozenset[str]
    """Who is not here in the present game."""
    game_plan: GamePlan
    """What is chosen for the next game."""

    def choose(self, plan: GamePlan) -> None:
        """Play the next game by a plan."""
        ...

    def change(self, change: GameChange) -> None:
        """Let somebody leave or come in the present game, and in those that follow."""
        ...

    def observe(self) -> ActivityState:
        """Return the joint state as it is observed now."""
        ...


def as_gathering(world: object) -> Gathering | None:
    """Return a world whose games people can leave; None if they cannot."""
    return world if isinstance(world, Gathering) else None
