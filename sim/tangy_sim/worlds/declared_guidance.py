"""A guided game of any declared activity: it brings about situations not demonstrated yet.

By chance, some situations occur only once in many games. A search in the interpreter finds the
events that lead to the nearest missing situation. Some situations occur only once in a game: after
the teacher has ended it, the game continues from an earlier moment until nothing is missing.
"""

from __future__ import annotations

from collections.abc import Sequence

from tangy_profiles.behaviour import Action
from tangy_profiles.declared.activity import DeclaredActivity
from tangy_profiles.declared.ahead import EventPathStep, moment_key, nearest_way
from tangy_profiles.declared.demonstrated_moves import DemonstratedMoves
from tangy_profiles.declared.game import DeclaredGame
from tangy_profiles.declared.search import SOON
from tangy_profiles.declared.search_way import Event
from tangy_profiles.scene import ArrangedSituation
from tangy_profiles.state import EVERYBODY, ActivityState, Outcome, Situation
from tangy_sim.worlds.declared_world import DeclaredWorld

MOST_BACK = 25
"""Maximum number of times a guided game goes back; the next one covers the rest."""


class GuidedDeclaredWorld(DeclaredWorld):
    """A simulated world in which people bring about situations not demonstrated yet.

    It follows whatever the teacher demonstrates. When nothing is missing, people act at random. The
    same seed, earlier demonstrations and actions give the same states.
    """

    def __init__(
        self,
        activity: DeclaredActivity,
        people: Sequence[str],
        *,
        seed: int,
        shown: DemonstratedMoves,
    ) -> None:
        self._shown = shown
        super().__init__(activity, people, seed=seed)

    def begin(self) -> ActivityState:
        """Begin a new game with the coverage of earlier demonstrations."""
        self.taught = self._shown.copy()
        self.covered = False
        self.coming: ArrangedSituation | None = None
        """What people will bring about after the next command; None if it follows from commands."""
        self._aim: Situation | None = None
        self._moments: list[DeclaredGame] = []
        self._legs: list[EventPathStep] = []
        self._went_back = 0
        return super().begin()

    def execute(self, action: Action) -> Outcome:
        """Execute an action of the robot, then the next event of the plan."""
        if self.over:
            return super().execute(action)
        target = None if action.target == EVERYBODY else action.target
        self.taught.show(self.observe(), action.behaviour.name, target)
        outcome = super().execute(action)
        if self.over:
            self._go_back()
        return outcome

    def _pass(self, seconds: float) -> None:
        """Let no time pass while the robot speaks: the plan advances the time when necessary."""

    def _let_people_act(self, pause: float) -> None:
        self._moments.append(self.game.copy())
        event = None if self.covered else self._next()
        if event is not None:
            self._bring_about(event)
        elif self._went_back:  # the game was ended before
            self._go_back()
        else:
            self.covered = True
            super()._let_people_act(pause)

    def _ask_silent(self, behaviour: str, who: str) -> None:
        """Do not ask again: in a guided game, silence is also to be demonstrated."""

    def _next(self) -> Event | None:
        """Return the next event: the next leg of the plan, or the first of a new plan."""
        key = moment_key(self.game)
        if not (self._legs and self._legs[0].key == key):
            way = nearest_way((self.game,), self.taught)
            self._legs = list(way.legs) if way is not None else []
            self._aim = None if way is None else way.situation
        leg = self._legs.pop(0) if self._legs else None
        soon = len(self._legs) == 1 and self._legs[0].event != SOON
        self.coming = ArrangedSituation(self._aim) if soon and self._aim is not None else None
        return None if leg is None else leg.event

    def _go_back(self) -> None:
        """Go back to the moment nearest to a missing situation; end the game if there is none."""
        latest = tuple(reversed(self._moments))
        way = nearest_way(latest, self.taught) if self._went_back < MOST_BACK else None
        if way is None:
            self.over, self.covered, self.coming = True, True, None
            return
        step = self.game.step
        self.game = latest[way.start].copy()
        self.game.step, self.over = step, False
        self._went_back += 1
        self._legs, self._aim = list(way.legs), None  # it is announced now
        self.coming = ArrangedSituation(way.situation, goes_back=True)
        self._bring_about(self._legs.pop(0).event)

    def _bring_about(self, event: Event) -> None:
        if isinstance(event, float):
            self.game.now += event
            return
        for act in event:
            self._take_in(act)
