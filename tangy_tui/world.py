"""The interface between the program and a world; the simulated and the real world implement it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Protocol, runtime_checkable

from tangy_profiles.activity import Activity
from tangy_profiles.behaviour import Action
from tangy_profiles.declared.memory import GameMemory
from tangy_profiles.faults import Remedy
from tangy_profiles.game_world import GameWorld
from tangy_profiles.health import Health
from tangy_profiles.past_game import PastGame
from tangy_profiles.scene import ArrangedCard, ArrangedSituation, Scene
from tangy_profiles.state import ActivityState, Outcome


class World(Protocol):
    """A room with people and a robot, in which games are played in turn."""

    activity: Activity
    people: tuple[str, ...]
    played_in: GameWorld
    """Whether its games are simulated, on the bench or live: beliefs are kept for each."""
    over: bool
    """Whether the game that was begun last has ended."""

    @property
    def seconds(self) -> float:
        """The world's own time, in s, from any starting point."""
        ...

    @property
    def pauses(self) -> tuple[int, float]:
        """The number of waits for late data in this game, and their total in s."""
        ...

    def begin(self) -> ActivityState:
        """Begin a new game and return its first state."""
        ...

    def resume(self, past: PastGame) -> ActivityState:
        """Continue an interrupted game; return its state.

        Raises:
            NotResumable: the log does not lead to this game.
        """
        ...

    def observe(self) -> ActivityState:
        """Return the observed joint state (III-B-1)."""
        ...

    def execute(self, action: Action) -> Outcome:
        """Carry out an action and return its outcome."""
        ...

    def who(self, place: str) -> str:
        """Return the person who sits at a person's place, usually its owner."""
        ...

    def scene(self) -> Scene:
        """Return the visible scene for a screen to draw."""
        ...

    def health(self) -> Health:
        """Return the reports of the robot's devices (III-C)."""
        ...

    def recover(self, remedy: Remedy) -> float:
        """Carry out a remedy for a fault; return the time taken, in s."""
        ...


@runtime_checkable
class Arranging(Protocol):
    """A world that arranges missing situations, and announces the next one."""

    @property
    def coming(self) -> ArrangedCard | ArrangedSituation | None:
        """The next arranged event or situation; None if there is none."""
        ...


@runtime_checkable
class Remembering(Protocol):
    """A world whose games cannot be replayed from their steps, so that their facts are logged."""

    @property
    def memory(self) -> GameMemory:
        """All current facts of the game."""
        ...


@runtime_checkable
class Queueing(Protocol):
    """A world in which people ask for help whenever they like, as no replay can tell."""

    @property
    def queue(self) -> tuple[str, ...]:
        """Who asks for help, in the order in which they are served."""
        ...

    @property
    def asked_at(self) -> Mapping[str, float]:
        """When each of them asked, in s of the world's time."""
        ...


def queue_of(world: World) -> tuple[str, ...] | None:
    """Return who asks for help, to be logged; None if the steps are enough."""
    return world.queue if isinstance(world, Queueing) else None


def since_when(world: World, asking: Sequence[str] | None, began: float) -> tuple[float, ...]:
    """Return when each of these people asked, in s since a game began at a time of the world."""
    if not asking or not isinstance(world, Queueing):
        return ()
    asked = world.asked_at
    return tuple(round(asked.get(person, world.seconds) - began, 3) for person in asking)


def remembered(world: World) -> GameMemory | None:
    """Return the facts of a game to be logged; None if its steps are enough."""
    return world.memory if isinstance(world, Remembering) else None
