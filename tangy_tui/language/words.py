"""Text as words: cleaned, split, numbers as digits, and how like one word is to another."""

from __future__ import annotations

import re
import unicodedata

LONGEST_TEXT = 200  # characters of a command that are looked at

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


def likeness(said: str, known: str) -> float:
    """Return how like a typing slip of a known word this is: from 0 to 1.

    Short words are taken for slips only of words with the same letters, or one more or less: one
    letter exchanged in "go" or "mark" mostly makes another English word.
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
    """Count the letters to insert, drop or replace."""
    row = list(range(len(other) + 1))
    for i, letter in enumerate(one, 1):
        last, row = row, [i]
        for j, wanted in enumerate(other, 1):
            row.append(min(last[j] + 1, row[-1] + 1, last[j - 1] + (letter != wanted)))
    return row[-1]


def clean(text: str, *, strip: bool = True) -> str:
    """Cap a text and take out what cannot be shown: controls, bidi marks, lone surrogates."""
    spaced = (" " if char.isspace() else char for char in text[:LONGEST_TEXT])
    shown = "".join(char for char in spaced if not unicodedata.category(char).startswith("C"))
    return re.sub(" +", " ", shown).strip() if strip else shown


def words_of(text: str) -> Words:
    """Split into lower-case words: accents and punctuation dropped, number words as digits."""
    folded = unicodedata.normalize("NFKD", text[:LONGEST_TEXT]).casefold().replace("\u2019", "'")
    plain = unicodedata.normalize("NFC", _ACCENTS.sub("", folded))
    return tuple(_digits(word) for word in _WORD.findall(plain[:LONGEST_TEXT]))


def _digits(word: str) -> str:
    """Write a number as digits, however it is written; other words stay as they are."""
    if word.isascii() and word.isdigit():
        return str(int(word))
    return str(NUMBERS.index(word)) if word in NUMBERS else word


def spoken(words: Words) -> str:
    """Write words as they are said, numbers up to twenty in words."""
    return " ".join(
        NUMBERS[int(word)] if word.isdigit() and int(word) < len(NUMBERS) else word
        for word in words
    )


def run_together(words: Words) -> str:
    """Write words without the spaces between them, as they may be heard."""
    return spoken(words).replace(" ", "")


def bare(words: Words) -> Words:
    """Leave out the words that mean nothing by themselves."""
    return tuple(word for word in words if word not in FILLERS)


def stem(word: str) -> str:
    """Take a plural for its singular."""
    return word[:-1] if len(word) > 3 and word.endswith("s") else word


def in_order(wanted: Words, words: Words) -> bool:
    """Say whether some words come among others, in this order."""
    rest = iter(words)
    return all(word in rest for word in wanted)
