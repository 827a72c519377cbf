"""Moves demonstrated so far in a declared activity, for searches."""

from __future__ import annotations

from collections.abc import Mapping

from tangy_profiles.behaviour import Behaviour
from tangy_profiles.declared.game import DeclaredGame
from tangy_profiles.declared.situations import situation_of
from tangy_profiles.declared.whom import named_by
from tangy_profiles.state import EVERYBODY, ActivityState, Situation

Move = tuple[str, str | None]
"""A behaviour, and its person (None: the group)."""
UNDECIDED = "?"


class DemonstratedMoves:
    """The last behaviour shown in each situation; selectors for each stage and behaviour."""

    def __init__(self, behaviours: Mapping[str, Behaviour]) -> None:
        """Start without demonstrations.

        Args:
            behaviours: the behaviours of the activity.
        """
        self.shown: dict[Situation, str] = {}
        self.whom: dict[tuple[str, str], tuple[str, ...]] = {}
        self._behaviours = behaviours
        self._situations: dict[tuple[str, tuple[str, ...]], Situation] = {}

    def copy(self) -> DemonstratedMoves:
        """Return an independent copy of the demonstrated moves."""
        other = DemonstratedMoves(self._behaviours)
        other.shown, other.whom = dict(self.shown), dict(self.whom)
        return other

    def show(self, state: ActivityState, behaviour: str, target: str | None) -> None:
        """Add one step of a demonstration; ignore a behaviour that the activity no longer has."""
        known = self._behaviours.get(behaviour)
        if known is None:
            return
        self.shown[state.situation] = behaviour
        if len(known.to) < 2:
            return
        named = named_by(known, state, target)
        if named:
            key = (state.stage, behaviour)
            left = tuple(one for one in self.whom.get(key, named) if one in named)
            self.whom[key] = left or named

    def situation(self, game: DeclaredGame) -> Situation:
        """Return the situation of a game."""
        seen = game.seen()
        if seen not in self._situations:
            self._situations[seen] = situation_of(game.declaration, *seen)
        return self._situations[seen]

    def move(self, game: DeclaredGame) -> Move | None:
        """Return the demonstrated move of a game's situation, or None.

        A behaviour whose selectors name different people is (UNDECIDED, None).
        """
        situation = self.situation(game)
        name = self.shown.get(situation)
        if name is None:
            return None
        selectors = self.whom.get((situation.stage, name), self._behaviours[name].to)
        to = game.declaration.behaviours[name].to
        people = [game.whom(one) for one in to if one in selectors and one != "group"]
        found: set[str | None] = {person for person in people if person is not None}
        if EVERYBODY in selectors:
            found.add(None)
        if len(found) > 1:
            return UNDECIDED, None
        return name, next(iter(found), None)
