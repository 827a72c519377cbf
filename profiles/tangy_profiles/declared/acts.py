"""Acts of simulated people in a declared activity: who acts, when, and with which answer."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

from tangy_profiles.declared.game import DeclaredGame
from tangy_profiles.declared.model import Fact, Habit

NO_IDEA = "no idea"
"""A free answer that is wrong for any question."""


class Act(NamedTuple):
    """An act of a person: the fact, the person (None: the group), and the new value."""

    fact: str
    who: str | None
    value: str


def acts(game: DeclaredGame, *, drawn: Callable[[], float] | None = None) -> Iterator[Act]:
    """Yield the possible acts of people.

    Args:
        game: the game; it may observe each act before the next is drawn.
        drawn: draws from 0 to 1, so that each act occurs with its chance, and one value each
            (default: every act with a chance, and every value with a weight).
    """
    if drawn is None:
        yield from _possible(game)
        return
    for habit in game.declaration.habits:
        fact = game.declaration.facts[habit.fact]
        for who in game.here if fact.per_player else (None,):
            able = habit.chance > 0 and all(game.holds(one, who) for one in habit.when)
            chance, share = drawn(), drawn()  # always two numbers, for reproducibility
            if able and chance < habit.chance:
                yield Act(fact.name, who, _chosen(habit, share))


def _possible(game: DeclaredGame) -> Iterator[Act]:
    """Yield every act with a chance, and every value with a weight."""
    for habit, (group, own) in game.declaration.reasons:
        if habit.chance <= 0 or not all(game.holds(one, None) for one in group):
            continue
        fact = game.declaration.facts[habit.fact]
        values = [value for value, weight in habit.weights if weight > 0]
        for who in game.here if fact.per_player else (None,):
            if all(game.holds(one, who) for one in own):
                now = game.value(fact.name, who)
                yield from (Act(fact.name, who, value) for value in values if value != now)


def take_in(game: DeclaredGame, act: Act, certainty: float = 1.0) -> bool:
    """Apply an act to a game as an observation with a certainty (a probability)."""
    fact = game.declaration.facts[act.fact]
    return game.observe(act.fact, act.who, raw(game, fact, act.value), certainty)


def raw(game: DeclaredGame, fact: Fact, value: str) -> str:
    """Return the raw observation (a value or an answer) that results in a fact's value."""
    if not fact.checks:
        return value
    items, row = game.declaration.items, game.row
    right = items.value(row, fact.checks).split("|")
    if value == fact.values[1]:
        return right[0]
    others = [items.value(row, column) for column in fact.options]
    return next((one for one in others if one and one not in right), NO_IDEA)


def _chosen(habit: Habit, share: float) -> str:
    rest = share * sum(weight for _, weight in habit.weights)
    for value, weight in habit.weights:  # noqa: B007 - the last one takes the rest
        rest -= weight
        if rest < 0:
            break
    return value
