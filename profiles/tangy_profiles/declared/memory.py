"""The facts of a declared game, as logged after each step of a live game.

In a live game the steps alone do not determine the facts, because people changed some of them. So
the log has all of them, and an interrupted game continues from there.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from tangy_profiles.codec import Count, Sparse
from tangy_profiles.state import FRONT

if TYPE_CHECKING:
    from tangy_profiles.declared.game import DeclaredGame
    from tangy_profiles.declared.model import Declaration


@dataclass(frozen=True, slots=True)
class GameMemory:
    """The whole state of a game; persons by id, "" for the group."""

    values: tuple[tuple[str, str, str], ...]
    """Fact, player, and value, in order of their last change; only facts that ever changed."""
    counts: tuple[tuple[str, str, float], ...]
    """Fact, player, and the number; for a timer its start (s in the game)."""
    order: tuple[Count, ...]
    """The row numbers of the items in the order of the game."""
    round: Count
    turn: Count
    queue: tuple[str, ...]
    place: str
    addressed: str | None
    actor: str | None
    acts: tuple[tuple[str, Count], ...]
    now: float
    """The time in the game, in s."""
    step: Count
    closed: str | None
    executed: tuple[tuple[str, Count], ...]
    """How often each behaviour was executed."""
    away: Sparse[tuple[str, ...]] = ()
    """The players who have left."""
    screen: Sparse[tuple[str, ...]] = ()
    """The behaviour whose text or picture is on the screen, its person ("": the group), and whose
    turn it was."""
    circle: Sparse[tuple[str, ...]] = ()
    """The players as they sit, if their turns have another order."""


def memory_of(game: DeclaredGame) -> GameMemory:
    """Return the state of a game, for the log."""
    return GameMemory(
        values=tuple((*key, value) for key, value in game.values.items()),
        counts=tuple((*key, number) for key, number in sorted(game.counts.items())),
        order=game.order,
        round=game.round,
        turn=game.turn,
        queue=tuple(game.queue),
        place=game.place,
        addressed=game.addressed,
        actor=game.actor,
        acts=tuple(game.acts.items()),
        now=game.now,
        step=game.step,
        closed=game.closed,
        executed=tuple(sorted(game.executed.items())),
        away=tuple(one for one in game.players if one not in game.here),
        screen=tuple(part or "" for part in game.screen or ()),
        circle=() if game.circle == game.players else game.circle,
    )


def game_from(
    declaration: Declaration, players: tuple[str, ...], memory: GameMemory
) -> DeclaredGame | None:
    """Restore a game; return None if its activity or its players are different now."""
    if not _fits(declaration, players, memory):
        return None
    from tangy_profiles.declared.game import DeclaredGame

    players = tuple(who for who, _ in memory.acts)  # in the order of their turns
    game = DeclaredGame(declaration, players, memory.order, memory.circle)
    game.values = {(fact, whose): value for fact, whose, value in memory.values}
    game.counts = {(fact, whose): number for fact, whose, number in memory.counts}
    game.round, game.turn = memory.round, memory.turn
    game.queue = list(memory.queue)
    game.place, game.addressed, game.actor = memory.place, memory.addressed, memory.actor
    game.acts = dict(memory.acts)
    game.now, game.step, game.closed = memory.now, memory.step, memory.closed
    game.executed = dict(memory.executed)
    game.here = tuple(one for one in players if one not in memory.away)
    if memory.screen:
        name, person, turn = memory.screen
        game.screen = name, person or None, turn
    return game


def with_player(memory: GameMemory, player: str, seat: int) -> GameMemory:
    """Return the state of a game with one more player, about whom nothing is known.

    Args:
        memory: the state.
        player: the id.
        seat: the player's place from 0, as people sit. If turns go by seats, it is also the
            player's turn; else that comes last.
    """
    by_seats = not memory.circle
    turn = seat if by_seats else len(memory.acts)
    sitting = memory.circle[:seat], memory.circle[seat:]
    return replace(
        memory,
        acts=(*memory.acts[:turn], (player, 0), *memory.acts[turn:]),
        turn=memory.turn + (turn <= memory.turn),
        circle=() if by_seats else (*sitting[0], player, *sitting[1]),
    )


def _fits(declaration: Declaration, players: tuple[str, ...], memory: GameMemory) -> bool:
    """Return whether a stored state fits the activity, whose file may have changed."""
    facts, own = declaration.facts, {"", *players}
    named = {memory.addressed, memory.actor, memory.closed, *memory.queue} - {None}
    return (
        {who for who, _ in memory.acts} == set(players) >= named
        and memory.place in {FRONT, *players}
        and bool(set(players) - set(memory.away))
        and (not memory.circle or sorted(memory.circle) == sorted(players))
        and memory.turn < len(players)
        and memory.round <= len(memory.order)
        and len(memory.order) == declaration.items.rounds
        and all(row < max(1, len(declaration.items.rows)) for row in memory.order)
        and all(
            fact in facts and whose in own and value in facts[fact].values
            for fact, whose, value in memory.values
        )
        and all(fact in facts and whose in own for fact, whose, _ in memory.counts)
        and all(name in declaration.behaviours for name, _ in memory.executed)
        and (not memory.screen or _shows(declaration, players, memory.screen))
    )


def _shows(declaration: Declaration, players: tuple[str, ...], screen: tuple[str, ...]) -> bool:
    """Return whether a stored screen fits the activity and its players."""
    return (
        len(screen) == 3 and screen[0] in declaration.behaviours and {*screen[1:]} <= {"", *players}
    )
