"""When an active fault can show, given the robot's next action."""

from __future__ import annotations

from dataclasses import dataclass

from tangy_profiles.behaviour import Action, Behaviour
from tangy_sim.worlds import injection
from tangy_sim.worlds.injection import FaultKind
from tangy_sim.worlds.world import SimulatedWorld


@dataclass
class PresentFault:
    """An active fault: its start (s), the person it concerns, and whether it has shown."""

    kind: FaultKind
    since: float
    person: str | None = None
    shown: bool = False


class OccasionWorld(SimulatedWorld):
    """A simulated world that knows when each of its faults can show."""

    present: dict[str, PresentFault]
    """Active faults by kind."""

    def can_show(self, kind: FaultKind, action: Action) -> bool:
        """Return whether a fault of a kind would show during an action."""
        tracker, behaviour = self.tracker, action.behaviour
        asked = tracker.place in tracker.queue
        there = self.present.get(kind.name)
        theirs = there is None or there.person in (None, tracker.place)  # it concerns one person
        match kind.shows:
            case injection.DRIVING:
                return behaviour.drives
            case injection.LOOKING if self._never_complies(tracker.place):
                return False  # a refusing person's card is not expected to change
            case injection.LOOKING:
                if tracker.seen is None:
                    return theirs and asked and behaviour.shows_card
                return theirs and behaviour.corrects
            case injection.ASKING:
                about = behaviour.about_card and tracker.allows(behaviour)
                return theirs and asked and about
            case injection.CLOSING:
                seen = tracker.seen is not None
                return theirs and asked and seen and self._closes(behaviour)
            case injection.MOVING_ON:
                return self._moves_on(behaviour)
            case injection.WAITING if "requests-silent" in self.present:
                return False  # no sensor sees that a sign goes down
            case injection.WAITING:
                return len(tracker.queue) > 1 and tracker.state().attended is not None
            case _:
                return True

    def _closes(self, behaviour: Behaviour) -> bool:
        """Return whether a behaviour would close the request of the person beside the robot."""
        if behaviour.closes != "when correct":
            return behaviour.closes == "always" and self.tracker.seen == self._settled
        if self._never_complies(self.tracker.place):
            return False  # nothing is corrected, so the request stays open
        player = self.players[self.tracker.place]
        wrong, missing = player.marked & ~player.called, player.called & ~player.marked
        left = missing if behaviour.clears_marks else wrong
        mended = wrong if behaviour.clears_marks else missing
        if not mended or left:
            return False
        return not any(player.called & line == line for line in self.activity.deck.lines)

    def _moves_on(self, behaviour: Behaviour) -> bool:
        """Return whether stage, place or request would reveal that a behaviour had no effect."""
        tracker = self.tracker
        if behaviour.drives:
            return True
        if tracker.place in tracker.queue and tracker.seen is not None and behaviour.attends:
            # With nothing left to correct, it would look like a request that stays open.
            left = behaviour.closes != "always" or tracker.seen != self._settled
            return tracker.allows(behaviour) and left
        stage = tracker.state().stage
        if self._now + 1.0 >= self._next_ask:
            return False  # the stage may change anyway, because somebody asks
        return any(
            r.stage == stage
            and (
                (r.condition == "before" and r.behaviour == behaviour.name)
                or (r.condition == "count" and r.since == behaviour.name)
            )
            for r in self.activity.stage_rules
        )

    def _never_complies(self, person: str) -> bool:
        fault = self.present.get("never-complies")
        return fault is not None and fault.person in (None, person)

    @property
    def _settled(self) -> str:
        return self.activity.card_states[-1].name
