"""Detection of the people a sentence mentions: by name, number or seat, or in general."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache

from tangy_tui.language.examples import SOMEBODY, templates
from tangy_tui.language.phrasebook import Phrases
from tangy_tui.language.words import NUMBERS, Words

ORDINALS = (
    *("first", "second", "third", "fourth", "fifth", "sixth", "seventh", "eighth", "ninth"),
    *("tenth", "eleventh", "twelfth"),
)
BEFORE_A_SEAT = frozenset(("in", "on", "at", "from"))
POSSESSIVE = "'s"


@dataclass(frozen=True, slots=True)
class Mentioned:
    """A sentence with each mention of a person as one token, and these people.

    `users` are the ids of participants; `strangers`: an unknown number or seat was mentioned.
    """

    words: Words
    users: frozenset[str]
    strangers: bool


class Mentions:
    """Finds the people of a phrasebook in sentences."""

    def __init__(self, table: Phrases, nouns: Mapping[str, str]) -> None:
        """Use the names, numbers and seats of a phrasebook, and its nouns for people."""
        self._named: dict[Words, str] = {**table.names, **table.seats}
        self._numbers = table.numbers
        self._seats = table.seat_nouns
        self._seat_of = table.seats
        self._nouns = _nouns() | set(nouns.values())
        self._longest = max(map(len, self._named), default=0)

    def find(self, words: Words) -> Mentioned:
        """Find the people in words (numbers as digits)."""
        plain = tuple(map(_plain, words))
        found: list[str] = []
        users: set[str] = set()
        strangers = False
        place = 0
        while place < len(words):
            taken, user = self._at(plain, place)
            if not taken:
                found.append(words[place])
                place += 1
                continue
            strangers |= user is None
            users |= {user} if user is not None else set()
            place += taken
            place += words[place : place + 1] == ("s",)  # of "user 2's"
            if found[-1:] != [SOMEBODY]:
                while found[-1:] == ["the"]:
                    found.pop()
                found.append(SOMEBODY)
        return Mentioned(tuple(found), frozenset(users), strangers)

    def _at(self, words: Words, place: int) -> tuple[int, str | None]:
        """Return how many words at a place mention a person (0: none), and the person's id."""
        for size in range(min(self._longest, len(words) - place), 0, -1):
            user = self._named.get(words[place : place + size])
            if user is not None:
                return size, user
        for noun, number, size in self._numbered(words, place):
            if (noun,) in self._seats:
                return size, self._seat_of.get((noun, number))
            return size, self._numbers.get(number)
        return 0, None

    def _numbered(self, words: Words, place: int) -> Iterator[tuple[str, str, int]]:
        """Yield noun, number and length of "user 2", "2nd user", "person in seat number 2"."""
        if place == len(words):
            return  # "the person in"
        first, rest = words[place], words[place + 1 : place + 5]
        if first in ORDINALS and rest[:1] and rest[0] in self._nouns:
            yield rest[0], str(ORDINALS.index(first) + 1), 2
        if first not in self._nouns:
            return
        if rest[:1] and rest[0] in BEFORE_A_SEAT:
            for noun, number, size in self._numbered(words, place + 2):
                yield noun, number, size + 2
        skip = 1 if rest[:1] in (("number",), ("no",)) else 0
        if len(rest) > skip and rest[skip].isdigit():
            yield first, rest[skip], 2 + skip


def _plain(word: str) -> str:
    """Remove a possessive: "rosa's" becomes rosa, "2's" becomes 2."""
    bare = word.removesuffix(POSSESSIVE)
    return str(NUMBERS.index(bare)) if bare != word and bare in NUMBERS else bare


@cache
def _nouns() -> frozenset[str]:
    return frozenset(templates()["people"])
