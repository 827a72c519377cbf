"""Judges raw observations: compares a person's answer with the item."""

from __future__ import annotations

import difflib
import re
import unicodedata
from functools import lru_cache

from tangy_profiles.declared.model import Fact, Items

CERTAIN = 0.7
"""Below this certainty nothing is judged, and the question is repeated."""
ALIKE = 0.85
"""The similarity from which a free answer counts as the right one, misspelt or misheard."""
LETTERS = "abcdefgh"
VERDICT = "="
"""Before a value that staff have judged themselves, in place of an answer."""
RIGHT_WORDS, WRONG_WORDS = ("right", "correct"), ("wrong", "incorrect", "false")


@lru_cache(maxsize=4096)
def plain_words(text: str) -> str:
    """Normalise an answer: lower case, without accents, punctuation and article."""
    folded = unicodedata.normalize("NFKD", text.casefold())
    kept = "".join(c if c.isalnum() else " " for c in folded if not unicodedata.combining(c))
    words = re.sub(r"^\s*(the|a|an)\s+(?=\S)", "", kept).split()
    return " ".join(words)


def verdict(fact: Fact, said: str, *, negated: bool = False) -> str | None:
    """Return the raw observation for the words "right" or "wrong"; None for other words.

    Args:
        fact: a fact that is judged.
        said: plain words: a value of the fact, its words in the file, or a usual word for it.
        negated: whether a "not" stood before them.
    """
    names = {
        plain_words(words): value for value, words in zip(fact.values, fact.words, strict=False)
    }
    names |= {plain_words(value): value for value in fact.values}
    names |= dict.fromkeys(RIGHT_WORDS, fact.values[1]) | dict.fromkeys(WRONG_WORDS, fact.values[2])
    value = names.get(said)
    if value is None or value == fact.values[0]:
        return None
    if negated:
        value = fact.values[2] if value == fact.values[1] else fact.values[1]
    return f"{VERDICT}{value}"


def right_answers(fact: Fact, items: Items, row: int) -> list[str]:
    """Return the right answers of an item to a fact that is judged, in plain words."""
    return [plain_words(way) for way in items.value(row, fact.checks).split("|")]


def judged(fact: Fact, items: Items, row: int, raw: str, certainty: float) -> str | None:
    """Return the value of a fact that an observation stands for.

    An answer to check may be the letter of an option, its text, or any synonym of the right answer.
    A value after `VERDICT` counts as it is.

    Args:
        fact: the observed fact.
        items: the items, with the columns of the options.
        row: the row of the current item.
        raw: a value of the fact, or a person's answer.
        certainty: the probability that the observation is right.

    Returns:
        The value; None if the observation is uncertain, or not about the fact.
    """
    if certainty < CERTAIN:
        return None
    if not fact.checks:
        return raw if raw in fact.values else None
    if raw.startswith(VERDICT) and raw.removeprefix(VERDICT) in fact.values[1:]:
        return raw.removeprefix(VERDICT)
    right, said = right_answers(fact, items, row), plain_words(raw)
    if not said:
        return None
    offered = [plain_words(items.value(row, column)) for column in fact.options]
    if offered:
        letters = dict(zip(LETTERS, offered, strict=False))
        names = dict(zip((plain_words(c) for c in fact.options), offered, strict=True))
        chosen = said if said in offered else names.get(said, letters.get(said, ""))
        chosen = chosen or (said if said in right else "")
        if not chosen:
            return None
        return fact.values[1] if chosen in right else fact.values[2]
    close = max(difflib.SequenceMatcher(None, said, way).ratio() for way in right)
    return fact.values[1] if close >= ALIKE else fact.values[2]
