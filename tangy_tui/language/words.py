"""Text as words: cleaning, splitting, numbers as digits, and similarity of words."""

from __future__ import annotations

import re
import unicodedata
from functools import lru_cache

LONGEST_TEXT = 200  # characters of a command; the rest is ignored

FILLERS = frozenset(
    (
        *("a", "ah", "an", "and", "can", "could", "er", "hey", "just", "now", "ok", "okay"),
        *("please", "so", "tangy", "the", "then", "uh", "um", "will", "would", "you"),
    )
)
NUMBERS = (
    *("zero", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten"),
    *("eleven", "twelve", "thirteen", "fourteen", "fifteen", "sixteen", "seventeen", "eighteen"),
    *("nineteen", "twenty"),
)

_WORD = re.compile(r"[^\W\d_]+(?:'[^\W\d_]+)*|[0-9]+")
_ACCENTS = re.compile("[\u0300-\u036f]")

Words = tuple[str, ...]


@lru_cache(maxsize=1 << 13)
def likeness(said: str, known: str) -> float:
    """Return the similarity of a word to a known one, as a misspelling: from 0 to 1.

    Short words only count as misspellings of words with the same letters, or one more or less: a
    replaced letter in "go" or "mark" usually gives another English word.
    """
    longest = max(len(said), len(known))
    if not (said.isalpha() and known.isalpha()) or longest - min(len(said), len(known)) > 2:
        return 0.0
    if sorted(said) == sorted(known):
        return 1 - 1 / (longest + 1)
    if longest < 4 or (longest == 4 and len(said) == len(known)):
        return 0.0
    return 1 - _slips(said, known) / longest


def _slips(one: str, other: str) -> int:
    """Return the edit distance of two words."""
    row = list(range(len(other) + 1))
    for i, letter in enumerate(one, 1):
        last, row = row, [i]
        for j, wanted in enumerate(other, 1):
            row.append(min(last[j] + 1, row[-1] + 1, last[j - 1] + (letter != wanted)))
    return row[-1]


def clean(text: str, *, strip: bool = True) -> str:
    """Truncate a text and remove control, bidirectional and other invisible characters."""
    spaced = (" " if char.isspace() else char for char in text[:LONGEST_TEXT])
    shown = "".join(char for char in spaced if not unicodedata.category(char).startswith("C"))
    return re.sub(" +", " ", shown).strip() if strip else shown


def words_of(text: str) -> Words:
    """Split into lower-case words, without accents and punctuation, number words as digits."""
    folded = unicodedata.normalize("NFKD", text[:LONGEST_TEXT]).casefold().replace("\u2019", "'")
    plain = unicodedata.normalize("NFC", _ACCENTS.sub("", folded))
    return tuple(_digits(word) for word in _WORD.findall(plain[:LONGEST_TEXT]))


def _digits(word: str) -> str:
    """Convert a number to digits; leave other words unchanged."""
    if word.isascii() and word.isdigit():
        return str(int(word))
    return str(NUMBERS.index(word)) if word in NUMBERS else word


def spoken(words: Words) -> str:
    """Join words as they are spoken, with numbers up to twenty in words."""
    return " ".join(
        NUMBERS[int(word)] if word.isdigit() and int(word) < len(NUMBERS) else word
        for word in words
    )


def run_together(words: Words) -> str:
    """Join words without spaces, as they may be misheard."""
    return spoken(words).replace(" ", "")


def bare(words: Words) -> Words:
    """Remove filler words."""
    return tuple(word for word in words if word not in FILLERS)


def stem(word: str) -> str:
    """Strip a plural s."""
    return word[:-1] if len(word) > 3 and word.endswith("s") else word


def in_order(wanted: Words, words: Words) -> bool:
    """Return whether words occur among others in this order."""
    rest = iter(words)
    return all(word in rest for word in wanted)
