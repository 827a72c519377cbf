"""Who waits for the robot, derived from the steps and changes of a game."""

from __future__ import annotations

from tangy_profiles.game_records import GameChange
from tangy_profiles.state import FRONT, ActivityState


class OpenRequests:
    """The open requests of a game, brought forward step by step.

    While the robot first calls some numbers, the state shows no requests, but they stay open.
    """

    def __init__(self) -> None:
        """Begin a game in which nobody has asked."""
        self.people = frozenset[str]()
        self._calls = 0  # to come before the next visit

    def change(self, change: GameChange) -> None:
        """Apply a change of the game."""
        if change.what == "calls first":
            self._calls = change.number
        elif change.what == "all called":
            self._calls = 0

    def step(self, before: ActivityState, after: ActivityState, *, called: bool) -> None:
        """Apply a step that led from a state to the next, and whether it called a number."""
        if after.place not in (FRONT, before.place):
            self._calls = 0
        if called:
            self._calls = max(0, self._calls - 1)
        if not self._calls:
            self.people = frozenset(user.id for user in after.users if user.request == "AR")
