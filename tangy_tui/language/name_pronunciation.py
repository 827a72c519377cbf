"""The pronunciation of a person's name, and its source."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal, TypeAlias

from tangy_profiles.errors import TangyError
from tangy_profiles.person import Person
from tangy_tui.language.phrasebook import name_phones
from tangy_tui.language.pronunciation import suggest_name, unknown_words
from tangy_tui.language.words import bare, clean, words_of

NameSource: TypeAlias = Literal["person", "dictionary", "suggested", ""]
"""The source of a pronunciation: staff, the dictionary, a guess, or none."""


@dataclass(frozen=True, slots=True)
class HowSaid:
    """A name's phones, with commas between words, and their source.

    `source` is "person" (entered by staff), "dictionary", "suggested" (a guess: the name is not
    recognised until it is accepted), or "" if unknown. `lacks` are the words of the name that the
    dictionary does not have.
    """

    name: str
    phones: str
    source: NameSource
    lacks: tuple[str, ...]

    def to_json(self) -> dict[str, Any]:
        """Return it as JSON."""
        return {
            "pronunciation": self.phones or None,
            "source": self.source or None,
            "heard": self.source in ("person", "dictionary"),
        }


def how_said(person: Person) -> HowSaid:
    """Return the pronunciation of a name: stored, or else by the dictionary, or else guessed."""
    if name_phones(person) and person.pronunciation is not None:
        return HowSaid(person.name, person.pronunciation, "person", ())
    phones, lacks = suggest_name(person.name), unknown_words(person.name)
    if not phones or not bare(words_of(clean(person.name))):
        return HowSaid(person.name, "", "", lacks)
    return HowSaid(person.name, phones, "suggested" if lacks else "dictionary", lacks)


def accept_suggested(person: Person) -> str:
    """Return the suggested phones of a name.

    Raises:
        TangyError: there is no suggestion.
    """
    said = how_said(person)
    if not said.phones:
        raise TangyError(f"Nothing can be suggested for {person.name}: give the phones.")
    return said.phones
