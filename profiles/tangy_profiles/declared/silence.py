"""A person who says nothing to what they were asked, as the log has it."""

from __future__ import annotations

from tangy_profiles.declared.game import DeclaredGame
from tangy_profiles.state import UnclearAnswer

SILENCE = "silence"
"""The source of what nobody said."""


def silence(game: DeclaredGame, who: str, *, asked_again: bool) -> UnclearAnswer:
    """Return that a person said nothing, and whether they are asked again."""
    answers = (fact.name for fact in game.declaration.facts.values() if fact.checks)
    return UnclearAnswer(who, next(answers, ""), "", 0.0, SILENCE, asked_again)
