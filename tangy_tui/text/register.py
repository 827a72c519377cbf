"""Words for the list of people who take part."""

from __future__ import annotations


def added_words(name: str, id: str) -> str:
    """Say that a person now takes part."""
    return f"{name} now takes part (id {id})."


def archived_words(name: str) -> str:
    """Say that a person no longer takes part."""
    return f"{name} no longer takes part. Tangy keeps what it knows about {name}."


def back_words(name: str) -> str:
    """Say that a person takes part again."""
    return f"{name} takes part again."


def not_archived(person: str, known: str) -> str:
    """Say that nobody of that name is archived, and who is."""
    return f"Nobody called {person!r} is archived. Archived: {known or 'nobody'}."
