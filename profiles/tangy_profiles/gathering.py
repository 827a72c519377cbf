"""Worlds whose games people can join and leave."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol, runtime_checkable

from tangy_profiles.game_rules import GamePlan
from tangy_profiles.state import ActivityState

if TYPE_CHECKING:
    from tangy_profiles.game_records import GameChange


@runtime_checkable
class Gathering(Protocol):
    """A world that knows who is absent."""

    people: tuple[str, ...]
    away: frozenset[str]
    """The people absent from the current game."""
    game_plan: GamePlan
    """The plan of the next game."""

    def choose(self, plan: GamePlan) -> None:
        """Set the plan of the next game."""
        ...

    def change(self, change: GameChange) -> None:
        """Record that a person left or came, in this game and the following ones."""
        ...

    def observe(self) -> ActivityState:
        """Return the joint state as it is observed now."""
        ...


def as_gathering(world: object) -> Gathering | None:
    """Return the world if people can leave its games, else None."""
    return world if isinstance(world, Gathering) else None
