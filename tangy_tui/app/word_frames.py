"""Bags of words: those that a sentence of staff must have, and those that it may have.

A sentence of no fixed wording is read as a bag of words. It must have a word of each group of a
frame, and no other words than those of the frame and the small words of the language. So a
word that the frame does not know, such as a name or a thing, makes it another sentence.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field

_SHORT = {
    "n't": " not",
    "'ll": " will",
    "'s": " is",
    "'re": " are",
    "'ve": " have",
    "'d": " would",
    "'m": " am",
}
"""Short forms, and what they stand for."""
_IRREGULAR = {"won't": "will not", "can't": "can not", "cannot": "can not", "let's": "let us"}
_WORD = re.compile(r"[^\W_]+(?:-[^\W_]+)*")


def one_of(words: str) -> frozenset[str]:
    """Return words that are given with spaces between them."""
    return frozenset(words.split())


SMALL = one_of(
    "a an the this that these those it its is am are was were be been being do does did done have"
    " has had will would can could shall may might you your we us our i me my they them their to"
    " of in on at for from with by and or but so as if there here now then yet far still just"
    " really please tangy robot ok okay hey well already any all some one ones today"
)
"""Words that a sentence may have whatever it is about."""
ASKS_BY = one_of(
    "what which who whom whose when where why how is am are was were do does did has have had will"
    " would can could shall may must should"
)
"""The words with which questions begin."""
COULD_BE_ASKED = one_of("can could would will shall may")
"""The words with which people also begin to ask for something to be done."""


def words_in(text: str) -> tuple[str, ...]:
    """Return the words of a sentence in small letters, short forms written out."""
    said = text.replace("\u2019", "'").casefold()
    for short, full in _IRREGULAR.items():
        said = re.sub(rf"\b{short}\b", full, said)
    for short, full in _SHORT.items():
        said = re.sub(rf"(?<=\w){short}\b", full, said)
    return tuple(_WORD.findall(said))


@dataclass(frozen=True)
class Bag:
    """What a sentence must and may contain."""

    needs: tuple[frozenset[str], ...]
    """Groups of words, of each of which the sentence has one."""
    may: frozenset[str] = frozenset()
    begins: frozenset[str] = frozenset()
    """The words with which it may begin; none: any."""
    never_begins: frozenset[str] = frozenset()
    without: frozenset[str] = frozenset()
    """Words, also small ones, that it does not have."""
    knows: frozenset[str] = field(init=False)

    def __post_init__(self) -> None:
        """Put the known words together."""
        object.__setattr__(self, "knows", SMALL.union(self.may, self.begins, *self.needs))

    def fits(self, words: tuple[str, ...]) -> bool:
        """Return whether a sentence, by its words, is of this kind."""
        if not words or not self.knows.issuperset(words) or not self.without.isdisjoint(words):
            return False
        if (self.begins and words[0] not in self.begins) or words[0] in self.never_begins:
            return False
        return all(not group.isdisjoint(words) for group in self.needs)
