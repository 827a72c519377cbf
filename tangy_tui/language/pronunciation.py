"""Pronunciations of words and names, from the dictionary or guessed."""

from __future__ import annotations

import shutil
import unicodedata
from collections.abc import Callable
from functools import cache
from importlib.util import find_spec
from pathlib import Path

from tangy_profiles.errors import ProfileError
from tangy_profiles.phones import LONGEST, read_name_phones
from tangy_tui.language import espeak_phones, spelling
from tangy_tui.language.words import clean, spoken, words_of

DICTIONARY = ("model", "en-us", "cmudict-en-us.dict")  # pocketsphinx's own dictionary

to_espeak = espeak_phones.to_espeak


def pronounce(word: str) -> tuple[str, ...]:
    """Return the pronunciations of a word in the dictionary, the usual one first.

    There are none if it is unknown, or the dictionary is not installed. The first call reads the
    dictionary, 3 MB, in 20 ms; each takes some 0.1 ms.
    """
    text, key = dictionary(), word.casefold()
    if not text or not key.strip() or "(" in key:  # "(" marks further pronunciations
        return ()
    found: list[str] = []
    start, end = _letter(key[0])
    place = text.find(f"\n{key} ", start, end)
    while place >= 0:
        found.append(text[text.index(" ", place) + 1 : text.index("\n", place + 1)])
        place = text.find(f"\n{key}({len(found) + 1}) ", place, end)
    return tuple(found)


def can_look_up() -> bool:
    """Return whether the dictionary is installed."""
    return bool(dictionary())


def suggest(word: str, which: Callable[[str], str | None] = shutil.which) -> str:
    """Guess a word's pronunciation with espeak-ng, or else from its spelling.

    Return "" if neither works (a word in another script). It takes some 10 ms with espeak-ng, 50 ms
    without.
    """
    latin = all(letter == "'" or "LATIN" in unicodedata.name(letter, "") for letter in word)
    guessed = espeak_phones.espeak_phones(word, which) if latin else ""
    if not guessed and set(word) <= set(spelling.SOUNDS):
        guessed = spelling.guess(word, dictionary())
    return " ".join(guessed.split()[:LONGEST])


def suggest_name(name: str) -> str:
    """Return a likely pronunciation of a name, with commas between words; "" if unknown."""
    words = spoken(words_of(clean(name))).split()
    phones = [next(iter(pronounce(word)), "") or suggest(word) for word in words]
    return ", ".join(phones) if all(phones) else ""


def unknown_words(name: str) -> tuple[str, ...]:
    """Return the words of a name that the dictionary does not have."""
    return tuple(w for w in spoken(words_of(clean(name))).split() if not pronounce(w))


def check_name(text: str, name: str) -> str:
    """Return the phones of a name, with commas between its words.

    Raises:
        ProfileError: a phone is invalid, or the number of words differs from that of the name.
    """
    phones = read_name_phones(text)
    words = words_of(clean(name))
    given = phones.count(",") + 1
    if given != len(words):
        has = "1 word" if len(words) == 1 else f"{len(words)} words"
        raise ProfileError(
            f"{' '.join(words)!r} has {has}, and these are phones of {given}: "
            "put a comma between words."
        )
    return phones


@cache
def _letter(letter: str) -> tuple[int, int]:
    """Return the range of the dictionary with a first letter."""
    text = dictionary()
    start, last = text.find(f"\n{letter}"), text.rfind(f"\n{letter}")
    return (start, text.find("\n", last + 1) + 1) if start >= 0 else (0, 0)


@cache
def dictionary() -> str:
    """Return the text of the dictionary, one word per line; "" if it is not installed."""
    spec = find_spec("pocketsphinx")
    if spec is None or spec.origin is None:
        return ""
    try:
        return "\n" + Path(spec.origin).parent.joinpath(*DICTIONARY).read_text(encoding="utf-8")
    except OSError:
        return ""
