"""Words for the list of people who take part."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence

from tangy_profiles.person import is_guest


def added_words(name: str, id: str) -> str:
    """Tell that a person now takes part."""
    return f"{name} now takes part (id {id})."


def one_name(words: Sequence[str]) -> str:
    """Tell how to add several people, or one whose name has several words."""
    return (
        f"Add one person at a time: tangy people add {words[0]}. Put a name of several words in "
        f'quotes: tangy people add "{" ".join(words)}".'
    )


def archived_words(name: str) -> str:
    """Tell that a person no longer takes part."""
    return f"{name} no longer takes part. Tangy keeps what it knows about {name}."


def back_words(name: str) -> str:
    """Tell that a person takes part again."""
    return f"{name} takes part again."


def not_archived(person: str, known: str) -> str:
    """Tell that nobody with that name is archived, and who is."""
    return f"Nobody called {person!r} is archived. Archived: {known or 'nobody'}."


def guest_added_words(name: str, id: str) -> str:
    """Tell that a guest was added."""
    return f"{name} is a guest today (id {id}). Tangy forgets the name tomorrow."


GUEST_NOTE = "Guest: "
"""The prefix of a guest in a list of people."""


def labelled(id: str, name: str) -> str:
    """Return the name that staff read, with guests marked."""
    return f"{name} (guest)" if is_guest(id) else name


def staff_names(name: Callable[[str], str]) -> Callable[[str], str]:
    """Turn a function that returns spoken names into one that returns the names that staff read."""
    return lambda id: labelled(id, name(id))


def with_guests(names: Mapping[str, str], guests: Iterable[str]) -> dict[str, str]:
    """Return people's names in reports, by id; guests are marked, even once forgotten."""
    numbered = {id: re.sub(r"\D+", "Guest ", id, count=1) for id in guests}
    called = {id: labelled(id, names[id]) if id in names else numbered[id] for id in numbered}
    return {**names, **called}
