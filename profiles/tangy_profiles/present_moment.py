"""Worlds that tell what goes on during a behaviour, before it is over."""

from __future__ import annotations

from typing import Protocol, runtime_checkable

from tangy_profiles.declared.game import DeclaredGame


@runtime_checkable
class PresentMoment(Protocol):
    """A world that knows the speech in progress, and where it leads."""

    saying: str
    """The speech of the behaviour in progress or of the last one, with people by their ids."""

    said_before: str
    """What stays on the chest screen of a resumed game, as it was said; "" once it says more."""

    ahead: DeclaredGame
    """The game as it will be after the behaviour in progress, or else as it is."""


def as_present(world: object) -> PresentMoment | None:
    """Return the world if it tells what goes on during a behaviour, else None."""
    return world if isinstance(world, PresentMoment) else None
