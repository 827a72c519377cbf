"""Worlds that tell what goes on during a behaviour, before it is over."""

from __future__ import annotations

from typing import Protocol, runtime_checkable

from tangy_profiles.state import ActivityState


@runtime_checkable
class PresentMoment(Protocol):
    """A world that knows the speech in progress, and the state that it leads to."""

    saying: str
    """The speech of the behaviour in progress or of the last one, with people by their ids."""

    @property
    def moment(self) -> ActivityState:
        """The joint state with the behaviour in progress, without a new observation."""
        ...


def as_present(world: object) -> PresentMoment | None:
    """Return the world if it tells what goes on during a behaviour, else None."""
    return world if isinstance(world, PresentMoment) else None
