"""Adapter that shows a game declared by facts as a `Tracker`."""

from __future__ import annotations

from tangy_profiles.declared.activity import DeclaredActivity
from tangy_profiles.declared.game import DeclaredGame
from tangy_profiles.declared.joint_state import joint_state
from tangy_profiles.declared.vocabulary import ASKING, NO, YES
from tangy_profiles.state import ActivityState
from tangy_profiles.tracker import Tracker


class DeclaredTracker(Tracker):
    """A view of the interpreter's game; changes of facts go through its `observe`."""

    def __init__(self, activity: DeclaredActivity, game: DeclaredGame) -> None:
        """Set the game."""
        self._game = game
        super().__init__(activity, game.players)

    @property
    def place(self) -> str:
        """Place of the robot in the game."""
        return self._game.place

    @place.setter
    def place(self, place: str) -> None:
        self._game.place = place

    @property
    def queue(self) -> list[str]:
        """Asking people, first come first served; a copy."""
        return list(self._game.queue)

    @queue.setter
    def queue(self, _: list[str]) -> None:
        pass  # the game keeps it

    @property
    def step(self) -> int:
        """Number of behaviours carried out or attempted."""
        return self._game.step

    @step.setter
    def step(self, _: int) -> None:
        pass  # the game counts

    def ask(self, person: str) -> bool:
        """Record a request for help; return False if it was already open."""
        return self._game.observe(ASKING, person, YES)

    def withdraw(self, person: str) -> None:
        """Record that a person withdraws their request."""
        self._game.observe(ASKING, person, NO)

    def state(self) -> ActivityState:
        """Return the current joint state by the facts."""
        return joint_state(self._game)
