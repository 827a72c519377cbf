"""Observation in a game, with second looks where one look contradicts the expectation.

A picture may be late, a card be misread or not be read at all. What such a look says is no reason
to accuse anybody, to ask anybody, or to call it a fault: another look, of another moment, is taken
first, and what it takes back was never there.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from typing import Protocol, runtime_checkable

from tangy_profiles.state import ActivityState
from tangy_tui.interaction.reading_error import FusedLook, ReadingError
from tangy_tui.world import World

ACQUITS = 2
"""Looks that have to agree on what was to be expected. How many have to agree on what contradicts
it follows from how often a look is wrong (`ReadingError.needed`): four if 5% of all looks are."""

MORE_LOOKS = 2
"""So many looks are taken at most beyond those that have to agree; each takes about a second."""


@runtime_checkable
class FusesLooks(Protocol):
    """A world that fuses looks at cards itself: how many must agree, and what became of them."""

    agreeing: int
    fused_looks: tuple[int, int]


class Observation:
    """Observes the state of a game. `begin` each game."""

    def __init__(self, world: World, error: ReadingError | None = None) -> None:
        """Take the world, and how often looks were wrong so far."""
        self._world = world
        self._last: ActivityState | None = None
        self.error = error or ReadingError()
        self.fused: FusedLook | None = None
        """What the last state that contradicted the expectation rests on; None: on one look."""
        self.counted = ReadingError()
        """The looks of this game alone."""
        self._fused_before = (0, 0)

    def begin(self, state: ActivityState) -> None:
        """Take note of how a game begins."""
        self._last, self.fused = state, None
        self.counted = ReadingError()

    def before(self, doubtful: Callable[[ActivityState], bool]) -> ActivityState:
        """Return the state before a behaviour; it should be as it was after the last one.

        Args:
            doubtful: says of a state that a game should not get into it.
        """
        state = self._world.observe()
        if doubtful(state):
            state = self._again(state, doubtful, self._look_again)
        elif state != self._last:
            # What has become otherwise meanwhile the world tells by itself.
            state = self._again(state, lambda seen: seen != self._last, self._world.observe)
        self._last = state
        return state

    def after(self, contradicts: Callable[[ActivityState], bool]) -> ActivityState:
        """Return the state after a behaviour.

        Args:
            contradicts: says of a state that it is not what was to be expected.
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
        """Say whether the state is as wanted; that it is not, one look alone does not tell."""
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
        """Look again until looks agree, or for as often as is sensible."""
        seen, needed = Counter((state,)), self.error.needed
        for _ in range(needed + MORE_LOOKS - 1):
            state = look()
            seen[state] += 1
            if seen[state] >= (needed if contradicts(state) else ACQUITS):
                break
        else:
            state = seen.most_common(1)[0][0]
        if look == self._look_again:
            self.fused = FusedLook(seen[state], seen.total(), self.error.rate)
            self._count(state, seen[state], seen.total())
        return state

    def _count_fused(self) -> None:
        """Count the looks that the world has fused since, and tell it how many have to agree."""
        world = self._world
        if isinstance(world, FusesLooks):
            (taken, wrong), before = world.fused_looks, self._fused_before
            taken, wrong = taken - before[0], wrong - before[1]
            self._fused_before = world.fused_looks
            for counted in (self.error, self.counted):
                counted.add(taken - wrong, taken)
            world.agreeing = self.error.needed

    def _count(self, state: ActivityState, agreeing: int, taken: int) -> None:
        """Count looks at what a person has; of others nothing can be misread."""
        if state.attended is not None and state.place == state.attended:
            self.error.add(agreeing, taken)
            self.counted.add(agreeing, taken)

    def _look_again(self) -> ActivityState:
        """Take another look; a world that has to do something for that says how."""
        look = getattr(self._world, "look_again", self._world.observe)
        state: ActivityState = look()
        return state
