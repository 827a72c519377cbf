"""Word vectors: words of similar meaning have similar vectors.

They are the vectors of single words in the sentence encoder all-MiniLM-L6-v2 (Apache licence 2.0),
reduced to 48 dimensions by PCA; `tests/bench/word_vectors.py` makes the table. It is read without
numpy.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import cache
from importlib.resources import files

from tangy_tui.language.words import Words

DIMENSIONS = 48
COMMON = 400  # the most frequent words, which get less weight
LEAST_WEIGHT = 0.25  # of the most frequent word


@cache
def _table() -> tuple[Mapping[str, int], memoryview]:
    folder = files("tangy_tui.language")
    listed = folder.joinpath("word_vectors.txt").read_text(encoding="utf-8").split()
    table = memoryview(folder.joinpath("word_vectors.bin").read_bytes()).cast("b")
    return {word: place for place, word in enumerate(listed)}, table


def sentence_vector(words: Words) -> tuple[float, ...]:
    """Return the mean of the vectors of words (numbers from 0 to 1 or negative), with length 1.

    It is zero if no word is known.
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
