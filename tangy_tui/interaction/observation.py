"""What a game observes, looked at again where one look contradicts what was to be expected.

A picture may be late, a card be misread or not be read at all. What such a look says is no reason
to accuse anybody, to ask anybody, or to call it a fault: another look, of another moment, is taken
first, and what it takes back was never there.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable

from tangy_profiles.state import ActivityState
from tangy_tui.world import World

ACQUITS, CONVINCES = 2, 4
"""Looks that have to agree: on what was to be expected, and on what contradicts it. With 5% of all
looks late, two agreeing ones contradict falsely some 20 times in 500 games, three once, and four
never did in 1,000."""

MOST_LOOKS = 6
"""So many looks are taken at most; a look at a card takes a robot about a second."""


class Observation:
    """Observes the state of a game. `begin` each game."""

    def __init__(self, world: World) -> None:
        self._world = world
        self._last: ActivityState | None = None

    def begin(self, state: ActivityState) -> None:
        """Take note of how a game begins."""
        self._last = state

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
        state = self._world.observe()
        if contradicts(state):
            state = self._again(state, contradicts, self._look_again)
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
        seen = Counter((state,))
        for _ in range(MOST_LOOKS - 1):
            state = look()
            seen[state] += 1
            if seen[state] >= (CONVINCES if contradicts(state) else ACQUITS):
                return state
        return seen.most_common(1)[0][0]

    def _look_again(self) -> ActivityState:
        """Take another look; a world that has to do something for that says how."""
        look = getattr(self._world, "look_again", self._world.observe)
        state: ActivityState = look()
        return state
