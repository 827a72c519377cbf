"""A declared activity on the bench: scripted staff report what its simulated people say and do."""

from __future__ import annotations

from tangy_hw.robot_client.declared_live_world import DeclaredLiveWorld
from tangy_hw.robot_client.fact_observation import FactObservation
from tangy_profiles.behaviour import Action
from tangy_profiles.codec import encode
from tangy_profiles.declared.speech import media
from tangy_profiles.declared.typed_observations import TypedObservation
from tangy_profiles.past_game import PastGame
from tangy_profiles.state import ActivityState
from tangy_sim.worlds import injection
from tangy_sim.worlds.injection import FaultKind
from tangy_tui.app.simulated_devices_world import BenchedWorld

WITH_CARDS = {injection.LOOKING, injection.ASKING, injection.CLOSING, injection.MOVING_ON}
"""The occasions of faults that concern cards."""


class BenchedDeclaredWorld(BenchedWorld, DeclaredLiveWorld):
    """A game on the bench in which scripted staff pass on what the simulated people say and do."""

    sees_all = True

    def begin(self) -> ActivityState:
        """Begin a game on the bench."""
        self._passed_on = 0
        return super().begin()

    def resume(self, past: PastGame) -> ActivityState:
        """Resume an interrupted game; the simulated people get the state of the game too."""
        self._passed_on = 0
        memory = past.steps[-1].memory
        if memory is not None:
            self.bench.do("rules", memory=encode(memory))
        return super().resume(past)

    def _perform(self, action: Action, whom: str | None) -> tuple[str, str]:
        """Speak, show and play; the simulated people learn what they see and hear."""
        after = self.game.copy()
        after.execute(action.behaviour.name, whom)
        if any(media(after, action.behaviour.name)):
            self.bench.do("rules", rows=[after.row])
        return super()._perform(action, whom)

    def can_show(self, kind: FaultKind, action: Action) -> bool:
        """Return whether a fault of this kind would be noticed if it came with an action."""
        return kind.shows not in WITH_CARDS and super().can_show(kind, action)

    def _listen(self) -> None:
        """Pass on what the simulated people have done since the last call, and see their signs."""
        super()._listen()
        acts = self.truth()["acts"]
        for fact, who, raw, sure in acts[self._passed_on :]:
            self.take(FactObservation(TypedObservation(fact, who or None, raw), sure, "staff"))
        self._passed_on = len(acts)
