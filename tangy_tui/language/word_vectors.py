"""Words by their meaning: a table of vectors in which words of like meaning lie near one another.

The vectors are those that the sentence encoder all-MiniLM-L6-v2 (Apache licence 2.0) gives single
words, brought to 48 dimensions by their principal components: `tests/bench/word_vectors.py` makes
the table. It is read as bytes, without numpy.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import cache
from importlib.resources import files

from tangy_tui.language.words import Words

DIMENSIONS = 48
COMMON = 400  # words that are said most, which mean less by themselves
LEAST_WEIGHT = 0.25  # of the commonest of all


@cache
def _table() -> tuple[Mapping[str, int], memoryview]:
    folder = files("tangy_tui.language")
    listed = folder.joinpath("word_vectors.txt").read_text(encoding="utf-8").split()
    table = memoryview(folder.joinpath("word_vectors.bin").read_bytes()).cast("b")
    return {word: place for place, word in enumerate(listed)}, table


def sentence_vector(words: Words) -> tuple[float, ...]:
    """Return the mean of the vectors of words as numbers from 0 to 1 and their negatives.

    Its length is 1; it is zeros if none of the words is known.
    """
    places, table = _table()
    total = [0.0] * DIMENSIONS
    for word in words:
        place = places.get(word)
        if place is None:
            continue
        row = table[place * DIMENSIONS : (place + 1) * DIMENSIONS]
        weight = LEAST_WEIGHT + (1 - LEAST_WEIGHT) * min(1.0, place / COMMON)
        weight /= math.sqrt(sum(value * value for value in row)) or 1.0
        for number, value in enumerate(row):
            total[number] += weight * value
    length = math.sqrt(sum(value * value for value in total)) or 1.0
    return tuple(value / length for value in total)
