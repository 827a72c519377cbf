"""How words are pronounced: what the dictionary of the recogniser says, and what is guessed."""

from __future__ import annotations

from functools import cache
from importlib.util import find_spec
from pathlib import Path

DICTIONARY = ("model", "en-us", "cmudict-en-us.dict")


def pronounce(word: str) -> tuple[str, ...]:
    """Return the pronunciations that the dictionary has of a word, the usual one first.

    There are none where it does not have the word, or is not installed. The first call reads the
    dictionary, which takes some milliseconds (see tests/bench/pronouncing.py).
    """
    text, key = _dictionary(), word.casefold()
    found: list[str] = []
    place = text.find(f"\n{key} ") if key and not key.isspace() else -1
    while place >= 0:
        found.append(text[text.index(" ", place) + 1 : text.index("\n", place + 1)])
        place = text.find(f"\n{key}({len(found) + 1}) ", place + 1)
    return tuple(found)


@cache
def _dictionary() -> str:
    """Return the text of the dictionary, a word a line; "" where there is none."""
    spec = find_spec("pocketsphinx")
    if spec is None or spec.origin is None:
        return ""
    try:
        return "\n" + Path(spec.origin).parent.joinpath(*DICTIONARY).read_text(encoding="utf-8")
    except OSError:
        return ""
