"""Search of all possible games: the next situation to show, and the reachable ones.

A search uses the interpreter to step from state to state: a behaviour, then an event.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from time import thread_time
from typing import Literal

from tangy_profiles.declared.acts import Act, acts, take_in
from tangy_profiles.declared.dead_ends import loop_in, without_end
from tangy_profiles.declared.demonstrated_moves import UNDECIDED, DemonstratedMoves, Move
from tangy_profiles.declared.game import DeclaredGame
from tangy_profiles.declared.model import Declaration
from tangy_profiles.declared.search_way import Arrival, Counterexample, Event, Node, way_to
from tangy_profiles.declared.state_keys import StateFactor, shares, state_key
from tangy_profiles.declared.vocabulary import ASKING
from tangy_profiles.state import Situation

FEW = 2
SOON = 1.0
"""The s that pass if no particular event happens."""
MOST_ASKING = 2
"""The most people who ask at once in a search."""
FEWEST_ROUNDS = 2
Cut = Literal["", "states", "time"]
"""Why a search ended early ("": it is complete)."""
LOOKS_AT_CLOCK = 32
"""A search checks the time after this many states."""


@dataclass(frozen=True, slots=True)
class Limit:
    """The limits of a search: nodes (a state before an act or before a move), and CPU time in s."""

    states: int = 60_000
    seconds: float = 10.0


USUAL = Limit()


def events(game: DeclaredGame, *, last: bool, few: bool = False) -> Iterator[Event]:
    """Yield each possible event of this state.

    Args:
        game: the game.
        last: include acts that end a game.
        few: of people who can do the same act, only two alone, or most or all of them together.
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
    """Return whether an event is one that ends a game."""
    return not isinstance(event, float) and any(
        (act.fact, act.value) in declaration.last_acts for act in event
    )


def happen(game: DeclaredGame, event: Event) -> None:
    """Apply an event to a game."""
    if isinstance(event, float):
        game.now += event
        return
    for act in event:
        take_in(game, act)


@dataclass
class SearchResult:
    """The reachable situations, under the demonstrations or under any behaviour.

    `open` are those reached that were not shown, or in which selectors disagree. `cut` says why the
    search ended early, if it did: then other situations may be reachable too. If a game can reach a
    dead end, `lost` is the first state without a reachable end, and `loop` the loop in which games
    then stay. `idle` is the first state without a move. `shares` are the facts that contribute most
    states to an incomplete search.
    """

    reached: dict[Situation, int] = field(default_factory=dict)
    open: dict[Situation, str] = field(default_factory=dict)
    states: int = 0
    cut: Cut = ""
    lost: Counterexample | None = None
    loop: Counterexample | None = None
    idle: Counterexample | None = None
    shares: tuple[StateFactor, ...] = ()
    played: dict[str, int] = field(default_factory=dict)

    @property
    def whole(self) -> bool:
        """Whether the search is complete, so that nothing else is reachable."""
        return not self.cut

    @property
    def stuck(self) -> Situation | None:
        """A situation from which no game ends, or None."""
        return None if self.lost is None else self.lost.situation


def done_move(game: DeclaredGame, move: Move) -> DeclaredGame:
    """Return the game after a behaviour whose invitations people followed."""
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
) -> SearchResult:
    """Search everything that is reachable from a game.

    Between two behaviours any number of people may act, one after another, and time may pass.

    Args:
        game: the start.
        moves: returns the possible behaviours of a state; empty if nothing was shown.
        situation: returns the situation of a state.
        limit: the limits of the search.
    """
    found = SearchResult()
    until, looked = thread_time() + limit.seconds, 0
    begin = (True, state_key(game))
    waiting: deque[tuple[DeclaredGame, Node]] = deque([(game, begin)])
    known: dict[Node, DeclaredGame] = {begin: game}
    before: dict[Node, list[Node]] = {}
    came: dict[Node, Arrival] = {}
    ends: list[Node] = []

    def reach_node(
        other: DeclaredGame,
        robot: bool,
        node: Node,
        move: Move | None = None,
        event: Event | None = None,
    ) -> None:
        new = (robot, state_key(other))
        before.setdefault(new, []).append(node)
        if other.over:
            ends.append(new)
        elif new not in known:
            if len(known) >= limit.states:
                found.cut = "states"
                return
            known[new] = other
            came[new] = Arrival(node, move, event)
            waiting.append((other, new))

    def possible(one: DeclaredGame) -> tuple[str, ...]:
        return tuple(dict.fromkeys(name for name, _ in moves(one)))

    def counterexample(nodes: Sequence[Node]) -> Counterexample:
        return Counterexample(
            way_to(nodes[0], came, lambda node: situation(known[node])),
            {situation(known[node]): possible(known[node]) for node in nodes},
        )

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
                reach_node(other, False, node, event=event)
            continue
        here = situation(one)
        found.reached[here] = found.reached.get(here, 0) + 1
        able = moves(one)
        if not able or able[0][0] == UNDECIDED:
            found.open[here] = able[0][0] if able else ""
            if not able and found.idle is None:
                found.idle = counterexample([node])
            ends.append(node)  # how it continues depends on the answer
            continue
        for move in able:
            found.played[move[0]] = found.played.get(move[0], 0) + 1
            reach_node(done_move(one, move), False, node, move)

    keys = [key for robot, key in known if robot]
    found.states = len(keys)
    if found.cut:
        found.shares = shares(game.declaration, keys, len(game.players))
        return found
    stuck = without_end(known, before, ends)
    lost = next((node for node in stuck if node[0]), None)
    if lost is not None:
        found.lost = counterexample([lost])
        found.loop = counterexample([node for node in loop_in(stuck, before) if node[0]])
    return found


def search_game(game: DeclaredGame) -> DeclaredGame:
    """Return a game to search, with no more rounds than conditions can distinguish."""
    most = max(FEWEST_ROUNDS, 1 + game.declaration.most_counted)
    rounds = min(len(game.order), most)
    return DeclaredGame(game.declaration, game.players, game.order[:rounds] or game.order)


def _until_next_band(game: DeclaredGame) -> float | None:
    """Return in how many s the next timer reaches its next band; None if none does."""
    left: list[float] = []
    for (name, player), _ in game.counts.items():
        fact = game.declaration.facts[name]
        if fact.kind == "timer":
            number = game.number(fact, player or None)
            bounds = game.declaration.bounds_of(fact)
            left += [bound - number for bound in bounds if bound > number]
    return min(left, default=None)


def explore_demonstrated(
    declaration: Declaration,
    players: Sequence[str],
    taught: DemonstratedMoves,
    limit: Limit = USUAL,
) -> SearchResult:
    """Search every game that can occur under the demonstrations.

    Args:
        declaration: the activity.
        players: those who take turns; each multiplies the number of states.
        taught: the demonstrated moves.
        limit: the limits of the search.
    """
    game = DeclaredGame(declaration, players, range(declaration.items.rounds))

    def moves(now: DeclaredGame) -> list[Move]:
        move = taught.move(now)
        return [] if move is None else [move]

    return explore(search_game(game), moves, taught.situation, limit)
