"""How a person's name is said, and who says so."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal, TypeAlias

from tangy_profiles.errors import TangyError
from tangy_profiles.person import Person
from tangy_tui.language.phrasebook import name_phones
from tangy_tui.language.pronunciation import suggest_name, unknown_words
from tangy_tui.language.words import bare, clean, words_of

NameSource: TypeAlias = Literal["person", "dictionary", "suggested", ""]
"""Who says how a name is said: staff, the dictionary, a guess, or nobody."""


@dataclass(frozen=True, slots=True)
class HowSaid:
    """A name's phones, a comma between words, and where they come from.

    `source` is "person" (staff noted it), "dictionary", "suggested" (guessed: the name is not
    heard before that is accepted), or "" where nobody knows. `lacks` are the words of the name that
    the dictionary does not have.
    """

    name: str
    phones: str
    source: NameSource
    lacks: tuple[str, ...]

    def to_json(self) -> dict[str, Any]:
        """Write it for a script."""
        return {
            "pronunciation": self.phones or None,
            "source": self.source or None,
            "heard": self.source in ("person", "dictionary"),
        }


def how_said(person: Person) -> HowSaid:
    """Return how a person's name is said: as noted, else by the dictionary, else as guessed."""
    if name_phones(person) and person.pronunciation is not None:
        return HowSaid(person.name, person.pronunciation, "person", ())
    phones, lacks = suggest_name(person.name), unknown_words(person.name)
    if not phones or not bare(words_of(clean(person.name))):
        return HowSaid(person.name, "", "", lacks)
    return HowSaid(person.name, phones, "suggested" if lacks else "dictionary", lacks)


def accept_suggested(person: Person) -> str:
    """Return the phones that are suggested for a name.

    Raises:
        TangyError: nothing can be suggested.
    """
    said = how_said(person)
    if not said.phones:
        raise TangyError(f"Nothing can be suggested for {person.name}: give the phones.")
    return said.phones
