"""Ranks the behaviours that fit the current state of a game, by their effects."""

from __future__ import annotations

from tangy_profiles.declared.game import DeclaredGame
from tangy_profiles.declared.vocabulary import ITEMS


def fitting(game: DeclaredGame) -> list[str]:
    """Return the behaviours that are possible now, best first.

    While a timer of the stage is in its first band, behaviours without effects come first, to give
    people time. Then follow those that lead to another stage, those that change what the stage sees
    (or end a game without items left), those that change neither, and those that end the game. Ties
    are broken by the person of the stage, then by the fewest executions.
    """
    about = game.stage()[1]
    ranked: list[tuple[int, bool, int, str]] = []
    for name, behaviour in game.declaration.behaviours.items():
        people = [game.whom(selector) for selector in behaviour.to] or [None]
        able = [one for one in people if game.allows(name, one)]
        if able:
            whom = about if about in able else able[0]
            other = bool(behaviour.to) and whom != about
            ranked.append((_rank(game, name, whom), other, game.executed.get(name, 0), name))
    ranked.sort(key=lambda one: one[:3])
    return [name for *_, name in ranked]


def _rank(game: DeclaredGame, name: str, whom: str | None) -> int:
    if not game.declaration.behaviours[name].effects:
        return 0 if _waits(game) else 3
    after = game.copy()
    after.execute(name, whom)
    if after.over:
        return 2 if game.declaration.items.rounds and game.value(ITEMS, None) == "over" else 4
    before, then = game.seen(), after.seen()
    if before == then:
        return 3
    return 1 if before[0] != then[0] else 2


def _waits(game: DeclaredGame) -> bool:
    """Return whether a timer that the stage sees is in its first band."""
    stage, about = game.stage()
    facts = [game.declaration.facts[name] for name in stage.sees]
    return any(
        fact.kind == "timer" and game.value(fact.name, about) == fact.values[0] for fact in facts
    )
