"""The door between the program and a world: a simulated and a real one both fit it, unasked."""

from __future__ import annotations

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
    """A room with people and a robot in it, in which one game after another is played."""

    activity: Activity
    people: tuple[str, ...]
    played_in: GameWorld
    """Whether its games are simulated, on the bench or live: beliefs are kept for each."""
    over: bool
    """Whether the game that was begun last has ended."""

    @property
    def seconds(self) -> float:
        """The world's own time, in s; where it began to count is its own matter."""
        ...

    @property
    def pauses(self) -> tuple[int, float]:
        """How often the robot has waited for late data in this game, and for how many s."""
        ...

    def begin(self) -> ActivityState:
        """Begin a new game and return its first state."""
        ...

    def resume(self, past: PastGame) -> ActivityState:
        """Go on where a game was interrupted; return the state that it was in.

        Raises:
            NotResumable: its log does not lead there.
        """
        ...

    def observe(self) -> ActivityState:
        """Return the joint state as it is observed now (III-B-1)."""
        ...

    def execute(self, action: Action) -> Outcome:
        """Carry out an action and return what became of it."""
        ...

    def who(self, place: str) -> str:
        """Return who sits at somebody's place: mostly the one whose place it is."""
        ...

    def scene(self) -> Scene:
        """Return what there is to see, for a screen to draw."""
        ...

    def health(self) -> Health:
        """Return what the robot's devices say of themselves now (III-C)."""
        ...

    def recover(self, remedy: Remedy) -> float:
        """Do something about a fault; return how long that took, in s."""
        ...


@runtime_checkable
class Arranging(Protocol):
    """A world that sees to it that everything comes about, and says what comes next."""

    @property
    def coming(self) -> ArrangedCard | ArrangedSituation | None:
        """What is about to come about, None where nothing is."""
        ...


@runtime_checkable
class Remembering(Protocol):
    """A world whose games cannot be played again from their steps: their facts are logged."""

    @property
    def memory(self) -> GameMemory:
        """Everything that is known of the game now."""
        ...


def remembered(world: World) -> GameMemory | None:
    """Return what has to be logged of a game, None where its steps are enough."""
    return world.memory if isinstance(world, Remembering) else None
