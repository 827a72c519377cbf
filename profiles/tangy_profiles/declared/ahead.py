"""Look-ahead in a game: which events lead to a situation that was not shown yet."""

from __future__ import annotations

from collections import deque
from collections.abc import Hashable, Sequence
from dataclasses import dataclass

from tangy_profiles.declared.demonstrated_moves import UNDECIDED, DemonstratedMoves
from tangy_profiles.declared.game import DeclaredGame
from tangy_profiles.declared.search import done_move, ends_game, events, happen
from tangy_profiles.declared.search_way import Event
from tangy_profiles.declared.state_keys import rough_key, state_key
from tangy_profiles.state import Situation

MOST_AHEAD = 1_200
"""The most states to visit in a search, for up to `FEW_PLAYERS`."""
MOST_TRIED = 4
"""The most events to try per state; most lead to a known state."""
FEW_PLAYERS = 4
"""With more players a state takes longer, and fewer are visited."""


@dataclass(frozen=True, slots=True)
class EventPathStep:
    """An event in a state, as visited by the search."""

    key: Hashable
    event: Event


@dataclass(frozen=True, slots=True)
class EventPath:
    """A path of events from one of several start states to a situation."""

    start: int
    legs: tuple[EventPathStep, ...]
    situation: Situation


@dataclass(frozen=True, slots=True)
class _Step:
    """An event in a game, with the step that led to that game."""

    game: DeclaredGame
    event: Event
    start: int
    before: _Step | None

    def way(self, situation: Situation) -> EventPath:
        legs, step = list[EventPathStep](), self
        while True:
            legs.append(EventPathStep(moment_key(step.game), step.event))
            if step.before is None:
                return EventPath(self.start, tuple(reversed(legs)), situation)
            step = step.before


def nearest_way(
    moments: Sequence[DeclaredGame], taught: DemonstratedMoves, most: int | None = None
) -> EventPath | None:
    """Return a shortest path, along demonstrated moves, to a situation not shown yet.

    Events that end a game are only tried if there is no path without them. Players whom no selector
    names are interchangeable. The limits are numbers of states, not times, so that the guidance is
    reproducible.

    Args:
        moments: states right after a behaviour, from which the game may continue.
        taught: the demonstrated moves.
        most: the states to visit without events that end a game, and again with them (default: by
            the number of players).

    Returns:
        The path, or None.
    """
    if most is None:
        players = max((len(game.players) for game in moments), default=1)
        most = MOST_AHEAD * FEW_PLAYERS // max(FEW_PLAYERS, players)
    search = _Search(taught, most)
    for start, game in enumerate(moments):
        search.expand(game, start, None, search.soon)
    return search.run(search.soon) or search.run(search.late)


def moment_key(game: DeclaredGame) -> Hashable:
    """Return the key of a state in a path: its state key, and the players in their roles."""
    return state_key(game), game.turn, game.place, game.addressed, tuple(game.queue)


class _Search:
    """A breadth-first search of paths: in `late` with events that end a game, in `soon` without."""

    def __init__(self, taught: DemonstratedMoves, most: int) -> None:
        self._taught = taught
        self._most = most
        self._known: set[Hashable] = set()
        self.soon: deque[_Step] = deque()
        self.late: deque[_Step] = deque()

    def run(self, steps: deque[_Step]) -> EventPath | None:
        """Expand steps until one reaches a situation not shown; return None at the limit."""
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
        """Add the events that are possible after a behaviour."""
        for event in events(game, last=True, few=True):
            late = ends_game(game.declaration, event)
            (self.late if late else steps).append(_Step(game, event, start, before))
