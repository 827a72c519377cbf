"""A game on the bench of an activity that is declared by facts: its people are listened to."""

from __future__ import annotations

from tangy_hw.robot_client.declared_live_world import DeclaredLiveWorld, Observed
from tangy_profiles.behaviour import Action
from tangy_profiles.codec import written
from tangy_profiles.declared.speech import media
from tangy_profiles.declared.typed_observations import TypedObservation
from tangy_profiles.past_game import PastGame
from tangy_profiles.state import ActivityState
from tangy_sim.worlds import injection
from tangy_sim.worlds.injection import Kind
from tangy_tui.app.simulated_devices_world import BenchedWorld

WITH_CARDS = {injection.LOOKING, injection.ASKING, injection.CLOSING, injection.MOVING_ON}
"""When faults show that have to do with a card."""


class BenchedDeclaredWorld(BenchedWorld, DeclaredLiveWorld):
    """Such a game, in which scripted staff pass on what the bench's people say and do."""

    sees_all = True

    def begin(self) -> ActivityState:
        """Begin a game on the bench."""
        self._passed_on = 0
        return super().begin()

    def resume(self, past: PastGame) -> ActivityState:
        """Go on where a game was interrupted; the people on the bench know where it stood."""
        self._passed_on = 0
        memory = past.steps[-1].memory
        if memory is not None:
            self.bench.do("rules", memory=written(memory))
        return super().resume(past)

    def _perform(self, action: Action, whom: str | None) -> tuple[str, str]:
        """Speak, show and play; people on the bench know what they see and hear."""
        after = self.game.copy()
        after.execute(action.behaviour.name, whom)
        if any(media(after, action.behaviour.name)):
            self.bench.do("rules", rows=[after.row])
        return super()._perform(action, whom)

    def can_show(self, kind: Kind, action: Action) -> bool:
        """Say whether a fault of a kind would be seen if it came with an action."""
        return kind.shows not in WITH_CARDS and super().can_show(kind, action)

    def _listen(self) -> None:
        """Hear what people of the bench have done since."""
        acts = self.truth()["acts"]
        for fact, who, raw, sure in acts[self._passed_on :]:
            self.take(Observed(TypedObservation(fact, who or None, raw), sure, "staff"))
        self._passed_on = len(acts)
