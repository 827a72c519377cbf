"""Looking ahead in a game: what has to happen so that something comes about that was not shown."""

from __future__ import annotations

from collections import deque
from collections.abc import Hashable, Sequence
from dataclasses import dataclass

from tangy_profiles.declared.game import DeclaredGame
from tangy_profiles.declared.search import done_move, ends_game, events, happen
from tangy_profiles.declared.search_way import Event
from tangy_profiles.declared.shown_moves import UNDECIDED, ShownMoves
from tangy_profiles.declared.state_keys import rough_key, state_key
from tangy_profiles.state import Situation

MOST_AHEAD = 1_200
"""The most states that the search for the next situation looks at, for up to `FEW_PLAYERS`."""
MOST_TRIED = 4
"""So many things that can happen are tried for each of them; most lead to a state that is known."""
FEW_PLAYERS = 4
"""With more players a state costs more time, and fewer are looked at."""


@dataclass(frozen=True, slots=True)
class Leg:
    """One thing that has to happen in a state, as the search has met it."""

    key: Hashable
    event: Event


@dataclass(frozen=True, slots=True)
class Way:
    """What has to happen from one of several moments on, and the situation that it leads to."""

    start: int
    legs: tuple[Leg, ...]
    situation: Situation


@dataclass(frozen=True, slots=True)
class _Step:
    """Something that can happen in a game, and the step that led to that game."""

    game: DeclaredGame
    event: Event
    start: int
    before: _Step | None

    def way(self, situation: Situation) -> Way:
        legs, step = list[Leg](), self
        while True:
            legs.append(Leg(moment_key(step.game), step.event))
            if step.before is None:
                return Way(self.start, tuple(reversed(legs)), situation)
            step = step.before


def nearest_way(
    moments: Sequence[DeclaredGame], taught: ShownMoves, most: int | None = None
) -> Way | None:
    """Return a shortest way, along taught steps, to a situation not shown yet.

    What ends a game comes last: it is tried once nothing is found without it. Players whom no
    selector names count as alike. The limits are numbers of states rather than times, so that the
    same game is always guided in the same way.

    Args:
        moments: states right after a behaviour, from which the game may go on.
        taught: what follows in which situation.
        most: the states that are looked at without what ends a game, and again with it (default:
            by the number of players).

    Returns:
        The way; None where none is found.
    """
    if most is None:
        players = max((len(game.players) for game in moments), default=1)
        most = MOST_AHEAD * FEW_PLAYERS // max(FEW_PLAYERS, players)
    search = _Search(taught, most)
    for start, game in enumerate(moments):
        search.expand(game, start, None, search.soon)
    return search.run(search.soon) or search.run(search.late)


def moment_key(game: DeclaredGame) -> Hashable:
    """Return all that a way goes by: the state, and which player it is about."""
    return state_key(game), game.turn, game.place, game.addressed, tuple(game.queue)


class _Search:
    """A breadth-first search: `late` begins with what ends a game, `soon` has none of it."""

    def __init__(self, taught: ShownMoves, most: int) -> None:
        self._taught = taught
        self._most = most
        self._known: set[Hashable] = set()
        self.soon: deque[_Step] = deque()
        self.late: deque[_Step] = deque()

    def run(self, steps: deque[_Step]) -> Way | None:
        """Follow steps until one reaches a situation not shown; None within a limit of steps."""
        looked = tried = 0
        while steps and looked < self._most and tried < MOST_TRIED * self._most:
            step = steps.popleft()
            tried += 1
            game = step.game.copy()
            happen(game, step.event)
            key = rough_key(game)
            if key in self._known:
                continue
            self._known.add(key)
            looked += 1
            move = self._taught.move(game)
            if move is None or move[0] == UNDECIDED:
                return step.way(self._taught.situation(game))
            done = done_move(game, move)
            if not done.over:
                self.expand(done, step.start, step, steps)
        return None

    def expand(
        self, game: DeclaredGame, start: int, before: _Step | None, steps: deque[_Step]
    ) -> None:
        """Add what can happen after a behaviour."""
        for event in events(game, last=True, few=True):
            late = ends_game(game.declaration, event)
            (self.late if late else steps).append(_Step(game, event, start, before))
