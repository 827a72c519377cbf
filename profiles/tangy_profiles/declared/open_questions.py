"""Whether an answer counts now: whether its question has been asked, and of whom."""

from __future__ import annotations

from tangy_profiles.declared.acts import Act, take_in
from tangy_profiles.declared.game import DeclaredGame
from tangy_profiles.declared.model import Fact, FactCondition, Stage


def counts_now(game: DeclaredGame, fact: Fact, who: str | None) -> bool:
    """Return whether an answer of a player (None: the group) can change the game.

    It can if it changes what a stage sees, now or after answers of others. Facts that nobody judges
    count at any time, and so do those that no stage reads.
    """
    if not fact.checks or not _is_read(game, fact):
        return True
    if game.row < 0:  # no item has been asked
        return False
    others = [one for one in game.here if one != who] if fact.per_player else []
    for value in fact.values[1:]:
        before = game.copy()
        for other in (None, *others):
            if other is not None:
                take_in(before, Act(fact.name, other, value))
            after = before.copy()
            if take_in(after, Act(fact.name, who, value)) and _view(after) != _view(before):
                return True
    return False


def _view(game: DeclaredGame) -> list[tuple[bool, str | None, tuple[str, ...]]]:
    """Return what each stage sees, also if another comes before it, such as a request for help."""
    return [_seen_by(game, stage) for stage in game.declaration.stages]


def _seen_by(game: DeclaredGame, stage: Stage) -> tuple[bool, str | None, tuple[str, ...]]:
    """Return whether the conditions of a stage hold, and then its person and what it sees."""
    about = game.whom(stage.about)
    if not all(game.holds(one, about) for one in stage.when):
        return False, None, ()
    return True, about, tuple(game.value(name, about) for name in stage.sees)


def _is_read(game: DeclaredGame, fact: Fact) -> bool:
    """Return whether a stage reads a fact, itself or in a test."""
    declaration = game.declaration
    names = {fact.name}
    for other in declaration.facts.values():
        if any(one.fact in names for _, conditions in other.tests for one in conditions):
            names.add(other.name)
    return any(
        names.intersection((*stage.sees, *(one.fact for one in _conditions(game, stage))))
        for stage in declaration.stages
    )


def _conditions(game: DeclaredGame, stage: Stage) -> list[FactCondition]:
    """Return the conditions of a stage, with that of its person."""
    whose = game.declaration.whose.get(stage.about)
    return [*stage.when, *([whose] if whose is not None else [])]
