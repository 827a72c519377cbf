"""The shortest path of a search to a state: behaviours, and the events after each."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping
from dataclasses import dataclass

from tangy_profiles.declared.acts import Act
from tangy_profiles.declared.demonstrated_moves import Move
from tangy_profiles.state import Situation

Node = tuple[bool, Hashable]
"""Whether it is the robot's move, and the state."""
Event = tuple[Act, ...] | float
"""An event after a behaviour: acts of people, or a number of s without any."""


@dataclass(frozen=True, slots=True)
class Arrival:
    """How a search first reached a node: the previous node, and a move, an event, or neither."""

    earlier: Node
    move: Move | None
    event: Event | None


@dataclass(frozen=True, slots=True)
class WayStep:
    """A behaviour, its situation, and the events after it, in order."""

    situation: Situation
    behaviour: str
    whom: str | None
    then: tuple[Event, ...]


@dataclass(frozen=True, slots=True)
class Counterexample:
    """Situations from which no game ends, with the possible behaviours, and the path there."""

    way: tuple[WayStep, ...]
    possible: Mapping[Situation, tuple[str, ...]]

    @property
    def situation(self) -> Situation:
        """The first of them."""
        return next(iter(self.possible))


def way_to(
    node: Node, came: Mapping[Node, Arrival], situation: Callable[[Node], Situation]
) -> tuple[WayStep, ...]:
    """Return the path on which a search first reached a node.

    Args:
        node: the end of the path.
        came: how the search reached each node except the first.
        situation: returns the situation of a node.
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
