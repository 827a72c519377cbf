"""Words for the list of people who take part."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping


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


def guest_added_words(name: str, id: str) -> str:
    """Say that a guest was added."""
    return f"{name} is a guest today (id {id}). Tangy forgets the name tomorrow."


def with_guests(names: Mapping[str, str], guests: Iterable[str]) -> dict[str, str]:
    """Return what people are called in reports, by id: guests as such, also once forgotten."""
    numbered = {id: re.sub(r"\D+", "Guest ", id, count=1) for id in guests}
    called = {id: f"{names[id]} (guest)" if id in names else numbered[id] for id in numbered}
    return {**names, **called}
