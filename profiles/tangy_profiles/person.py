"""The people who take part: a permanent id, and a name and pronunciation that may change."""

from __future__ import annotations

import unicodedata
from dataclasses import dataclass
from pathlib import Path

from tangy_profiles.defaults import SHIPPED
from tangy_profiles.errors import ProfileError, TangyError
from tangy_profiles.reading import plain, read_toml
from tangy_profiles.state import FRONT
from tangy_profiles.voice import VoicePreference

MOST_PEOPLE = 24
LONGEST_NAME = 40  # characters
GUEST = "guest"
"""Prefix of the ids of guests, who take part on one day; a number follows."""
AS_EVERYBODY = VoicePreference()


def is_guest(id: str) -> bool:
    """Return whether an id is that of a guest."""
    return id.startswith(GUEST) and id.removeprefix(GUEST).isdigit()


def folded(name: str) -> str:
    """Normalise a name for comparison: case and accent encoding."""
    return unicodedata.normalize("NFC", unicodedata.normalize("NFC", name.strip()).casefold())


def unaccented(name: str) -> str:
    """Return a name in lower case without accents, as people may type it."""
    apart = unicodedata.normalize("NFKD", folded(name))
    return "".join(letter for letter in apart if not unicodedata.combining(letter))


def read_name(name: str, of: str = "A name") -> str:
    """Return a valid name, stripped; `of` is the subject of the error sentence.

    Raises:
        TangyError: it is empty, longer than 40 characters, or not all printable.
    """
    name = name.strip()
    if not name:
        raise TangyError(f"{of} must not be empty.")
    if not name.isprintable():
        raise TangyError(
            f"{of} cannot be {plain(name)!r}: it holds a character that cannot be shown."
        )
    if len(name) > LONGEST_NAME:
        raise TangyError(f"{of} must have at most {LONGEST_NAME} characters.")
    return name


@dataclass(frozen=True)
class Person:
    """One participant. The log has only the id; the rest is stored apart and can be forgotten.

    `pronunciation` is that of the name in ARPAbet, with commas between words; None: the usual one.
    `voice` is how the person likes to be spoken to. `seats` are the names of the seat in the room
    ("seat 2", "window seat").
    """

    id: str
    name: str
    pronunciation: str | None = None
    voice: VoicePreference = AS_EVERYBODY
    seats: tuple[str, ...] = ()


def load_people(count: int, path: Path | None = None) -> tuple[Person, ...]:
    """Load the first `count` sample people; beyond the listed ones they are numbered.

    Raises:
        ProfileError: the count is not from 1 to 24, or the file has a mistake.
    """
    if not 1 <= count <= MOST_PEOPLE:
        raise ProfileError(f"{count} people cannot play: choose from 1 to {MOST_PEOPLE}.")
    top = read_toml(path or SHIPPED / "people" / "sample.toml")
    more_id, more_name = top.text("more_id"), top.text("more_name")
    people: list[Person] = []
    for entry in top.tables("people"):
        people.append(Person(entry.text("id"), entry.text("name")))
        entry.close()
    top.close()
    for number in range(len(people) + 1, count + 1):
        n = str(number)
        people.append(Person(more_id.replace("{n}", n), more_name.replace("{n}", n)))
    if len({person.id for person in people}) < len(people):
        raise top.wrong("people", "two of them have the same id.")
    if any(person.id == FRONT for person in people):
        raise top.wrong("people", f"nobody's id can be {FRONT!r}: that is a place.")
    return tuple(people[:count])
