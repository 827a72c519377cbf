"""Keys of game states for searches; states with equal keys are equivalent.

States that differ only in what no condition, selector or stage uses have equal keys.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Hashable, Sequence
from dataclasses import dataclass

from tangy_profiles.declared.game import DeclaredGame
from tangy_profiles.declared.model import Declaration, Fact
from tangy_profiles.declared.vocabulary import ADDRESSED, ASKING, ITEMS, PLACE, TURN
from tangy_profiles.state import FRONT

TELLING = 1.5
"""The lowest factor of states that is reported."""
PARTS = (ITEMS, TURN, ASKING, PLACE, ADDRESSED, "last to act", "quietest")
"""The parts of a key after the facts of the file: built-in facts, and two selectors' memory."""


def rough_key(game: DeclaredGame) -> Hashable:
    """Return a key that also ignores which player is which, except for those in a role.

    States with the same key may differ in the order of players. A search that skips one of them can
    miss paths, but every path it finds is valid.
    """
    group: list[object] = []
    own: list[list[object]] = [[] for _ in game.players]
    for fact, bounds in game.declaration.looked_at:
        if not fact.per_player:
            group.append(_kept(game, fact, bounds, ""))
            continue
        for player, facts in zip(game.players, own, strict=True):
            facts.append(_kept(game, fact, bounds, player))
    after = game.players[(game.turn + 1) % len(game.players)]
    least = min(game.acts.values()) if "quietest" in game.declaration.selectors else 0
    remembers = game.declaration.remembers_addressed
    named = (
        game.players[game.turn],
        game.place,
        game.addressed if remembers else None,
        game.actor if "last to act" in game.declaration.selectors else None,
        after,
        *(game.whom(selector) for selector in game.declaration.whose),
    )
    several = len(game.players) > 1
    for player, facts in zip(game.players, own, strict=True):
        roles = sum(2**place for place, one in enumerate(named) if one == player)
        asks = game.queue.index(player) + 1 if player in game.queue else 0
        quiet = least and min(game.acts[player] - least, 2)
        facts += [roles if several else 0, asks, quiet]
    order = sorted(map(repr, own))
    return tuple(group), tuple(order), game.round, game.place == FRONT, game.over


def _kept(
    game: DeclaredGame, fact: Fact, bounds: tuple[int, ...], player: str
) -> str | int | float | None:
    """Return the part of a fact that conditions can distinguish."""
    if fact.kind in ("flag", "choice"):
        value = game.values.get((fact.name, player))
        return None if value == fact.values[0] else value
    kept = game.counts.get((fact.name, player))
    timer = fact.kind == "timer"
    if kept is None:
        return None if timer else 0
    if timer:
        return bisect_right(bounds, game.now - kept)
    return min(kept, bounds[-1]) if bounds else 0


def state_key(game: DeclaredGame) -> Hashable:
    """Return a key of everything that can influence the rest of the game."""
    declaration, turn, order = game.declaration, game.turn, game.players
    if not declaration.selectors & {"quietest", "next in circle"}:
        order, turn = (*order[turn:], *order[:turn]), 0
    place = {player: number for number, player in enumerate(order)}
    facts = list[object]()
    for fact, bounds in declaration.looked_at:
        for player in order if fact.per_player else ("",):
            facts.append(_kept(game, fact, bounds, player))
    named = {condition.fact for condition in declaration.whose.values()}
    since = tuple(
        place[one]
        for (name, one), value in game.values.items()
        if name in named and one in place and value != declaration.facts[name].values[0]
    )
    acts_of: tuple[int, ...] = ()
    if "quietest" in declaration.selectors:
        least = min(game.acts.values())
        acts_of = tuple(min(game.acts[one] - least, 2) for one in order)
    return (
        tuple(facts),
        game.round,
        turn,
        tuple(place[one] for one in game.queue),
        game.place if game.place == FRONT else place[game.place],
        place.get(game.addressed or "", -1) if declaration.remembers_addressed else -1,
        place.get(game.actor or "", -1) if "last to act" in declaration.selectors else -1,
        (acts_of, since),
        game.over,
    )


@dataclass(frozen=True, slots=True)
class StateFactor:
    """The factor by which one fact (or part of `PARTS`) multiplies the number of states."""

    name: str
    times: float


def shares(
    declaration: Declaration, keys: Sequence[Hashable], players: int
) -> tuple[StateFactor, ...]:
    """Return what multiplies the states most, the largest factor first.

    Args:
        declaration: the activity.
        keys: distinct keys, as returned by `state_key`.
        players: the number of players.
    """
    found: list[StateFactor] = []
    flat = [(*key[0], *key[1:-1]) for key in keys if isinstance(key, tuple)]
    begin = 0
    widths = [(fact.name, players if fact.per_player else 1) for fact, _ in declaration.looked_at]
    for name, width in (*widths, *((part, 1) for part in PARTS)):
        without = {(*one[:begin], *one[begin + width :]) for one in flat}
        found.append(StateFactor(name, len(flat) / max(1, len(without))))
        begin += width
    found.sort(key=lambda one: -one.times)
    return tuple(one for one in found if one.times >= TELLING)
