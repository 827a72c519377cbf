"""A guided game of any declared activity: what happens is what nobody has shown yet.

Left to chance, some situations occur in one game of many. Here a search in the interpreter
finds the events that lead to the nearest situation that was not shown.
"""

from __future__ import annotations

from collections.abc import Sequence

from tangy_profiles.behaviour import Action
from tangy_profiles.declared.activity import DeclaredActivity
from tangy_profiles.declared.search import nearest_event
from tangy_profiles.declared.shown_moves import ShownMoves
from tangy_profiles.state import EVERYBODY, ActivityState, Outcome
from tangy_sim.worlds.declared_world import DeclaredWorld


class GuidedDeclaredWorld(DeclaredWorld):
    """A simulated world in which people do what brings about what was not shown yet.

    It goes by what the teacher shows, whatever that is. Where nothing is left to show, people act
    by chance. The same seed, earlier demonstrations and actions give the same states.
    """

    def __init__(
        self, activity: DeclaredActivity, people: Sequence[str], *, seed: int, shown: ShownMoves
    ) -> None:
        self._shown = shown
        super().__init__(activity, people, seed=seed)

    def begin(self) -> ActivityState:
        """Begin a new game with what earlier demonstrations have shown."""
        self.taught = self._shown.copy()
        self.covered = False
        return super().begin()

    def execute(self, action: Action) -> Outcome:
        """Carry out an action of the robot, then the next event of the plan."""
        if not self.over:
            target = None if action.target == EVERYBODY else action.target
            self.taught.show(self.observe(), action.behaviour.name, target)
        return super().execute(action)

    def _pass(self, seconds: float) -> None:
        """Let no time pass in the game while the robot speaks: it passes when that is needed."""

    def _let_people_act(self) -> None:
        event = None if self.covered else nearest_event(self.game, self.taught)
        if event is None:
            self.covered = True
            super()._let_people_act()
        elif isinstance(event, float):
            self.game.now += event
        else:
            for act in event:
                self._take_in(act)
