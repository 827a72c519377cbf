"""A person who does not answer, as logged."""

from __future__ import annotations

from tangy_profiles.declared.game import DeclaredGame
from tangy_profiles.state import UnclearAnswer

SILENCE = "silence"
"""The source of an unclear answer when nothing was said."""


def silence(game: DeclaredGame, who: str, *, asked_again: bool) -> UnclearAnswer:
    """Return an unclear answer for a person who said nothing."""
    answers = (fact.name for fact in game.declaration.facts.values() if fact.checks)
    return UnclearAnswer(who, next(answers, ""), "", 0.0, SILENCE, asked_again)
