"""Orders that are drawn by lot: the rows of the items, and the turns of the players."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeVar

from tangy_profiles.declared.game import DeclaredGame
from tangy_profiles.declared.model import Declaration

Draw = Callable[[], float]
"""Draws a number from 0 to 1."""
T = TypeVar("T")


def drawn_game(declaration: Declaration, players: Sequence[str], uniform: Draw) -> DeclaredGame:
    """Begin a game, in which the rows of the items and the turns are drawn."""
    rows = rows_of(declaration, uniform)
    return DeclaredGame(declaration, turns_of(declaration, players, uniform), rows, players)


def rows_of(declaration: Declaration, uniform: Draw) -> list[int]:
    """Return the rows of a game's items in their order, as many as there are rounds."""
    items = declaration.items
    rows = list(range(len(items.rows)))
    return (_shuffled(rows, uniform) if items.order == "shuffled" else rows)[: items.rounds]


def turns_of(declaration: Declaration, players: Sequence[str], uniform: Draw) -> tuple[str, ...]:
    """Return the players in the order of their turns."""
    drawn = declaration.turns == "by lot"
    return tuple(_shuffled(players, uniform) if drawn else players)


def _shuffled(things: Sequence[T], uniform: Draw) -> list[T]:
    """Return things in a random order (Fisher-Yates)."""
    order = list(things)
    for end in range(len(order) - 1, 0, -1):
        pick = int(uniform() * (end + 1))
        order[end], order[pick] = order[pick], order[end]
    return order
