"""Search through all possible games: the next situation to show, and the reachable ones.

A search follows the interpreter from state to state: a behaviour, then one thing that happens.
States that differ in nothing that any condition, selector or stage looks at count as one.
"""

from __future__ import annotations

from bisect import bisect_right
from collections import deque
from collections.abc import Callable, Hashable, Iterator, Sequence
from dataclasses import dataclass, field
from time import thread_time
from typing import Literal

from tangy_profiles.declared.acts import Act, acts, take_in
from tangy_profiles.declared.game import DeclaredGame
from tangy_profiles.declared.model import Declaration, Fact
from tangy_profiles.declared.shown_moves import UNDECIDED, Move, ShownMoves
from tangy_profiles.declared.vocabulary import ASKING
from tangy_profiles.state import FRONT, Situation

Event = tuple[Act, ...] | float
"""An event after a behaviour: an act of a person, or a number of s without one."""
FEW = 2
_Node = tuple[bool, Hashable]
"""Whether it is the robot's move, and the state."""
SOON = 1.0
"""So many s pass where nothing in particular is to happen."""
MOST_ASKING = 2
"""More do not ask at once in a search."""
FEWEST_ROUNDS = 2
Cut = Literal["", "states", "time"]
"""Why a search ended before it had seen everything ("": it has)."""
LOOKS_AT_CLOCK = 32
"""After so many states a search looks at the time."""


@dataclass(frozen=True, slots=True)
class Limit:
    """How far a search may go: in states, people's acts and the robot's moves apart, and CPU s."""

    states: int = 60_000
    seconds: float = 10.0


USUAL = Limit()


def events(game: DeclaredGame, *, last: bool, few: bool = False) -> Iterator[Event]:
    """Yield each possible event of this state.

    Args:
        game: the game.
        last: whether people may do what ends a game as well.
        few: of those who may all do the same, only two, or most or all of them together.
    """
    yield SOON
    ends = game.declaration.last_acts
    able: dict[tuple[str, str], list[Act]] = {}
    for act in acts(game):
        if act.fact == ASKING and len(game.queue) >= MOST_ASKING:
            continue
        if last or (act.fact, act.value) not in ends:
            able.setdefault((act.fact, act.value), []).append(act)
    for (fact, _), same in able.items():
        yield from ((act,) for act in (same[:FEW] if few else same))
        if few and len(same) > 1 and fact != ASKING:
            yield tuple(same)
            if len(same) > FEW:
                yield tuple(same[: len(game.players) // 2 + 1])
    seconds = _until_next_band(game)
    if seconds is not None:
        yield seconds


def ends_game(declaration: Declaration, event: Event) -> bool:
    """Say whether an event is one that ends a game."""
    return not isinstance(event, float) and any(
        (act.fact, act.value) in declaration.last_acts for act in event
    )


def happen(game: DeclaredGame, event: Event) -> None:
    """Let something happen in a game."""
    if isinstance(event, float):
        game.now += event
        return
    for act in event:
        take_in(game, act)


def rough_key(game: DeclaredGame) -> Hashable:
    """Return a game's state as if all players were alike whom no selector names, and their order.

    Two states with the same key may differ in who comes when. A search that skips one of them can
    miss a way, and still every way that it finds is one.
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
    """Return as much of a fact as conditions can tell apart."""
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
    """Return all of a game's state that can matter to how it goes on."""
    declaration, turn, order = game.declaration, game.turn, game.players
    if not declaration.selectors & {"quietest", "next in circle"}:
        order, turn = (*order[turn:], *order[:turn]), 0
    place = {player: number for number, player in enumerate(order)}
    facts = list[object]()
    for fact, bounds in declaration.looked_at:
        for player in order if fact.per_player else ("",):
            facts.append(_kept(game, fact, bounds, player))
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
        acts_of,
        game.over,
    )


@dataclass
class Reach:
    """The reachable situations, under the demonstrations or under any behaviour.

    `open` are those reached in which nothing was shown, or in which selectors disagree. `cut`
    says why the search ended early, if it did: then other situations may be reached as well.
    `stuck` is a situation from which no game ends, if there is one.
    """

    reached: dict[Situation, int] = field(default_factory=dict)
    open: dict[Situation, str] = field(default_factory=dict)
    states: int = 0
    cut: Cut = ""
    stuck: Situation | None = None
    played: dict[str, int] = field(default_factory=dict)

    @property
    def whole(self) -> bool:
        """Whether the search came to its end, so that nothing else can be reached."""
        return not self.cut


def done_move(game: DeclaredGame, move: Move) -> DeclaredGame:
    """Return the game after a behaviour, which people have followed."""
    done = game.copy()
    for person, fact, value in done.execute(*move).invited:
        for one in (person,) if person else done.players:
            take_in(done, Act(fact, one, value))
    return done


def explore(
    game: DeclaredGame,
    moves: Callable[[DeclaredGame], Sequence[Move]],
    situation: Callable[[DeclaredGame], Situation],
    limit: Limit = USUAL,
) -> Reach:
    """Search everything that can be reached from a game.

    Between two behaviours any number of people may act, one after another, and time may pass.

    Args:
        game: where the search begins.
        moves: the behaviours that may be done in a state; none if nothing was shown.
        situation: gives the situation of a state.
        limit: how far the search may go.
    """
    found = Reach()
    until, looked = thread_time() + limit.seconds, 0
    begin = (True, state_key(game))
    waiting: deque[tuple[DeclaredGame, _Node]] = deque([(game, begin)])
    known: dict[_Node, DeclaredGame] = {begin: game}
    before: dict[_Node, list[_Node]] = {}
    ends: list[_Node] = []

    def reach_node(other: DeclaredGame, robot: bool, node: _Node) -> None:
        new = (robot, state_key(other))
        before.setdefault(new, []).append(node)
        if other.over:
            ends.append(new)
        elif new not in known:
            if len(known) >= limit.states:
                found.cut = "states"
                return
            known[new] = other
            waiting.append((other, new))

    while waiting:
        looked += 1
        if looked % LOOKS_AT_CLOCK == 0 and thread_time() > until:
            found.cut = "time"
            break
        one, node = waiting.popleft()
        if not node[0]:  # people act, and then it is the robot's move
            reach_node(one, True, node)
            for event in events(one, last=True):
                other = one.copy()
                happen(other, event)
                reach_node(other, False, node)
            continue
        here = situation(one)
        found.reached[here] = found.reached.get(here, 0) + 1
        able = moves(one)
        if not able or able[0][0] == UNDECIDED:
            found.open[here] = able[0][0] if able else ""
            ends.append(node)  # the answer decides how it goes on
            continue
        for move in able:
            found.played[move[0]] = found.played.get(move[0], 0) + 1
            reach_node(done_move(one, move), False, node)
    found.states = sum(robot for robot, _ in known)
    if found.whole:
        stuck = _stuck(known, before, ends)
        found.stuck = situation(stuck) if stuck is not None else None
    return found


def _stuck(
    known: dict[_Node, DeclaredGame],
    before: dict[_Node, list[_Node]],
    ends: list[_Node],
) -> DeclaredGame | None:
    """Return a state from which no end can be reached, None if there is none."""
    can, waiting = set(ends), deque(ends)
    while waiting:
        for earlier in before.get(waiting.popleft(), ()):
            if earlier not in can:
                can.add(earlier)
                waiting.append(earlier)
    return next((game for node, game in known.items() if node not in can), None)


def search_game(game: DeclaredGame) -> DeclaredGame:
    """Return a game to search: it has no more rounds than conditions can tell apart."""
    most = max(FEWEST_ROUNDS, 1 + game.declaration.most_counted)
    rounds = min(len(game.order), most)
    return DeclaredGame(game.declaration, game.players, game.order[:rounds] or game.order)


def _until_next_band(game: DeclaredGame) -> float | None:
    """Return in how many s a timer comes into its next band, None if none runs to one."""
    left: list[float] = []
    for (name, player), _ in game.counts.items():
        fact = game.declaration.facts[name]
        if fact.kind == "timer":
            number = game.number(fact, player or None)
            bounds = game.declaration.bounds_of(fact)
            left += [bound - number for bound in bounds if bound > number]
    return min(left, default=None)


def reach(
    declaration: Declaration, players: Sequence[str], taught: ShownMoves, limit: Limit = USUAL
) -> Reach:
    """Search every game that can occur under the demonstrations.

    Args:
        declaration: the activity.
        players: those who take turns; states grow with every one of them.
        taught: what to do in which situation.
        limit: how far the search may go.
    """
    game = DeclaredGame(declaration, players, range(declaration.items.rounds))

    def moves(now: DeclaredGame) -> list[Move]:
        move = taught.move(now)
        return [] if move is None else [move]

    return explore(search_game(game), moves, taught.situation, limit)
