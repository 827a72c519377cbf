"""A game that is declared by facts, as those parts know it that know a `Tracker`."""

from __future__ import annotations

from tangy_profiles.declared.activity import DeclaredActivity
from tangy_profiles.declared.game import DeclaredGame
from tangy_profiles.declared.joint_state import joint_state
from tangy_profiles.declared.vocabulary import ASKING, NO, YES
from tangy_profiles.state import ActivityState
from tangy_profiles.tracker import Tracker


class DeclaredTracker(Tracker):
    """A view of the interpreter's game: whatever changes a fact goes through its `observe`."""

    def __init__(self, activity: DeclaredActivity, game: DeclaredGame) -> None:
        """Take the game that this is a view of."""
        self._game = game
        super().__init__(activity, game.players)

    @property
    def place(self) -> str:
        """Where the robot is in the game."""
        return self._game.place

    @place.setter
    def place(self, place: str) -> None:
        self._game.place = place

    @property
    def queue(self) -> list[str]:
        """Who asks, first come first; a copy."""
        return list(self._game.queue)

    @queue.setter
    def queue(self, _: list[str]) -> None:
        pass  # the game keeps it

    @property
    def step(self) -> int:
        """How many behaviours were carried out, or begun in vain."""
        return self._game.step

    @step.setter
    def step(self, _: int) -> None:
        pass  # the game counts

    def ask(self, person: str) -> bool:
        """A person asks for help. Returns False if that request was open already."""
        return self._game.observe(ASKING, person, YES)

    def withdraw(self, person: str) -> None:
        """A person who asked does not ask any more."""
        self._game.observe(ASKING, person, NO)

    def state(self) -> ActivityState:
        """Return the joint state as the facts have it now."""
        return joint_state(self._game)
