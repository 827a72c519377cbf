"""The shortest way of a search to one of its states: behaviours, and what happens after each."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping
from dataclasses import dataclass

from tangy_profiles.declared.acts import Act
from tangy_profiles.declared.shown_moves import Move
from tangy_profiles.state import Situation

Node = tuple[bool, Hashable]
"""Whether it is the robot's move, and the state."""
Event = tuple[Act, ...] | float
"""An event after a behaviour: an act of a person, or a number of s without one."""


@dataclass(frozen=True, slots=True)
class Came:
    """How a search first came to a node: from which one, by a move, an event, or neither."""

    earlier: Node
    move: Move | None
    event: Event | None


@dataclass(frozen=True, slots=True)
class WayStep:
    """A behaviour, the situation in which it is done, and what happens after it, in order."""

    situation: Situation
    behaviour: str
    whom: str | None
    then: tuple[Event, ...]


@dataclass(frozen=True, slots=True)
class Trap:
    """Situations from which no game ends, with the behaviours possible there, and the way there.

    The way leads to the first of them.
    """

    way: tuple[WayStep, ...]
    possible: Mapping[Situation, tuple[str, ...]]

    @property
    def situation(self) -> Situation:
        """The first of them."""
        return next(iter(self.possible))


def way_to(
    node: Node, came: Mapping[Node, Came], situation: Callable[[Node], Situation]
) -> tuple[WayStep, ...]:
    """Return the way on which a search first came to a node.

    Args:
        node: where the way ends.
        came: how the search came to each node but the first.
        situation: gives the situation of a node.
    """
    steps: list[WayStep] = []
    then: list[Event] = []
    while node in came:
        by = came[node]
        node = by.earlier
        if by.event is not None:
            then.append(by.event)
        if by.move is not None:
            steps.append(WayStep(situation(node), *by.move, tuple(reversed(then))))
            then = []
    return tuple(reversed(steps))
