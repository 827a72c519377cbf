"""Observation in a game, with second looks if one look contradicts the expectation.

A picture may be late, or a card misread or unreadable. Such a look alone must not cause a fault, a
question or a count against a person: it is repeated at a later moment first, and forgotten if the
other looks disagree.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from typing import Protocol, runtime_checkable

from tangy_profiles.behaviour import Behaviour
from tangy_profiles.state import ActivityState, Outcome
from tangy_tui.interaction.reading_error import FusedObservation, ReaderErrorRate
from tangy_tui.world import World

ACQUITS = 2
"""Looks that have to agree with the expectation.

How many have to agree against it depends on how often a look is wrong (`ReaderErrorRate.needed`):
four if 5% of all looks are wrong.
"""

MORE_LOOKS = 2
"""Looks at most beyond the number that has to agree; each takes about a second."""


@runtime_checkable
class ObservationFusion(Protocol):
    """A world that fuses looks at cards itself: how many must agree, and counts of the results."""

    agreeing: int
    fused_looks: tuple[int, int]


class Observation:
    """Observes the state of a game; call `begin` for each game."""

    def __init__(self, world: World, error: ReaderErrorRate | None = None) -> None:
        """Observe a world; `error` counts how often earlier looks were wrong."""
        self._world = world
        self._last: ActivityState | None = None
        self.error = error or ReaderErrorRate()
        self.fused: FusedObservation | None = None
        """The looks behind the last contradicting state; None if it rests on one look."""
        self.counted = ReaderErrorRate()
        """The looks of this game alone."""
        self._fused_before = (0, 0)

    def begin(self, state: ActivityState) -> None:
        """Start a game with its first state."""
        self._last, self.fused = state, None
        self.counted = ReaderErrorRate()

    def before(self, doubtful: Callable[[ActivityState], bool]) -> ActivityState:
        """Return the state before a behaviour; it should equal the state after the last one.

        Args:
            doubtful: returns whether a state is one that a game should not get into.
        """
        state = self._world.observe()
        if doubtful(state):
            state = self._again(state, doubtful, self._look_again)
        elif state != self._last:
            # The world reports by itself what has changed meanwhile.
            state = self._again(state, lambda seen: seen != self._last, self._world.observe)
        self._last = state
        return state

    def after(self, contradicts: Callable[[ActivityState], bool]) -> ActivityState:
        """Return the state after a behaviour.

        Args:
            contradicts: returns whether a state differs from the expected one.
        """
        state, self.fused = self._world.observe(), None
        self._count_fused()
        if contradicts(state):
            state = self._again(state, contradicts, self._look_again)
        else:
            self._count(state, 1, 1)
        self._last = state
        return state

    def shows(self, wanted: Callable[[ActivityState], bool]) -> bool:
        """Return whether the state is as wanted; look again before returning False."""
        state = self._world.observe()
        if wanted(state):
            return True
        return wanted(self._again(state, lambda seen: not wanted(seen), self._look_again))

    def _again(
        self,
        state: ActivityState,
        contradicts: Callable[[ActivityState], bool],
        look: Callable[[], ActivityState],
    ) -> ActivityState:
        """Look again until enough looks agree, or the limit is reached."""
        seen, needed = Counter((state,)), self.error.needed
        for _ in range(needed + MORE_LOOKS - 1):
            state = look()
            seen[state] += 1
            if seen[state] >= (needed if contradicts(state) else ACQUITS):
                break
        else:
            state = seen.most_common(1)[0][0]
        if look == self._look_again:
            self.fused = FusedObservation(seen[state], seen.total(), self.error.rate)
            self._count(state, seen[state], seen.total())
        return state

    def _count_fused(self) -> None:
        """Count the looks that the world fused since the last call, and set how many must agree."""
        world = self._world
        if isinstance(world, ObservationFusion):
            (taken, wrong), before = world.fused_looks, self._fused_before
            taken, wrong = taken - before[0], wrong - before[1]
            self._fused_before = world.fused_looks
            for counted in (self.error, self.counted):
                counted.add(taken - wrong, taken)
            world.agreeing = self.error.needed

    def _count(self, state: ActivityState, agreeing: int, taken: int) -> None:
        """Count looks at the card of an attended person; nothing else can be misread."""
        if state.attended is not None and state.place == state.attended:
            self.error.add(agreeing, taken)
            self.counted.add(agreeing, taken)

    def _look_again(self) -> ActivityState:
        """Take another look, by the world's own method if it has one."""
        look = getattr(self._world, "look_again", self._world.observe)
        state: ActivityState = look()
        return state


def refused(
    behaviour: Behaviour, before: ActivityState, outcome: Outcome, after: ActivityState
) -> bool:
    """Return whether the attended person did not do what a behaviour asked for.

    If no response was seen, an unchanged state counts as a refusal, so that people are not asked
    endlessly because their card is out of sight.
    """
    if not behaviour.persuades or before.attended is None or not outcome.completed:
        return False
    if outcome.response is not None:
        return not outcome.response.followed
    person = before.attended
    return not behaviour.only_talks and after.user(person) == before.user(person)
