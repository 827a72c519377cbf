"""Which behaviours fit the present moment of a game best, by what they would change."""

from __future__ import annotations

from tangy_profiles.declared.game import DeclaredGame
from tangy_profiles.declared.vocabulary import ITEMS


def fitting(game: DeclaredGame) -> list[str]:
    """Return the behaviours that are possible now, those first after which the game goes on.

    While a timer of the stage is in its first band, behaviours that change nothing come first:
    people are given time. Then follow those that lead to another stage, those that change what the
    stage sees (or end a game of which no items are left), those that change neither, and those that
    end the game. Among equals, behaviours for the person of the stage come first, and then those
    done least often.
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
    """Say whether a timer that the stage sees is in its first band."""
    stage, about = game.stage()
    facts = [game.declaration.facts[name] for name in stage.sees]
    return any(
        fact.kind == "timer" and game.value(fact.name, about) == fact.values[0] for fact in facts
    )
