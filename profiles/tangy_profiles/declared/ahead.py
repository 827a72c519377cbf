"""Looking ahead in a game: what has to happen so that something comes about that was not shown."""

from __future__ import annotations

from collections import deque
from collections.abc import Hashable, Iterator, Sequence
from dataclasses import dataclass

from tangy_profiles.declared.game import DeclaredGame
from tangy_profiles.declared.search import Event, done_move, events, happen, state_key
from tangy_profiles.declared.shown_moves import UNDECIDED, ShownMoves
from tangy_profiles.state import Situation

MOST_AHEAD = 3_000
"""The most states that the search for the next situation visits."""


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
class _Node:
    game: DeclaredGame
    start: int
    leg: Leg
    before: _Node | None

    def way(self, situation: Situation) -> Way:
        legs, node = [self.leg], self.before
        while node is not None:
            legs.append(node.leg)
            node = node.before
        return Way(self.start, tuple(reversed(legs)), situation)


def nearest_way(
    moments: Sequence[DeclaredGame], taught: ShownMoves, most: int = MOST_AHEAD
) -> Way | None:
    """Return the shortest way to a situation that was not shown, by what was taught.

    What ends a game comes last.

    Args:
        moments: states right after a behaviour, from which the game may go on.
        taught: what follows in which situation.
        most: the states that are looked at.

    Returns:
        The way; None where none is found.
    """
    for last in (False, True):
        found = _nearest(moments, taught, last, most)
        if found is not None:
            return found
    return None


def moment_key(game: DeclaredGame) -> Hashable:
    """Return all that a way goes by: the state, and which player it is about."""
    return state_key(game), game.turn, game.place, game.addressed, tuple(game.queue)


def _nearest(
    moments: Sequence[DeclaredGame], taught: ShownMoves, last: bool, most: int
) -> Way | None:
    known: set[Hashable] = set()
    waiting: deque[_Node] = deque()
    for start, game in enumerate(moments):
        waiting.extend(_after(game, start, None, last))
    while waiting and len(known) < most:
        node = waiting.popleft()
        key = state_key(node.game)
        if key in known:
            continue
        known.add(key)
        move = taught.move(node.game)
        if move is None or move[0] == UNDECIDED:
            return node.way(taught.situation(node.game))
        done = done_move(node.game, move)
        if not done.over:
            waiting.extend(_after(done, node.start, node, last))
    return None


def _after(game: DeclaredGame, start: int, before: _Node | None, last: bool) -> Iterator[_Node]:
    key = moment_key(game)
    for event in events(game, last=last, few=True):
        other = game.copy()
        happen(other, event)
        yield _Node(other, start, Leg(key, event), before)
