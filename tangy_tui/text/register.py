"""Who takes part, in words."""

from __future__ import annotations


def added_words(name: str, id: str) -> str:
    """Say that a person takes part now."""
    return f"{name} takes part now (id {id})."


def archived_words(name: str) -> str:
    """Say that a person takes part no more."""
    return f"{name} takes part no more. What Tangy knows of {name} stays."


def back_words(name: str) -> str:
    """Say that a person takes part again."""
    return f"{name} takes part again."


def not_archived(person: str, known: str) -> str:
    """Say that nobody of that name was archived, and who was."""
    return f"Nobody called {person!r} was archived: {known or 'nobody was'}."
