"""The intent classifier: a linear model over words, character n-grams and word vectors.

It is a multinomial logistic regression, fitted by `intent_training`. It is stored as JSON and
evaluated without numpy, in less than a millisecond.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from tangy_tui.language.examples import SOMEBODY
from tangy_tui.language.word_vectors import sentence_vector
from tangy_tui.language.words import Words

SHORTEST_PART, LONGEST_PART = 3, 5  # characters of an n-gram, including the word's ends
BEGIN, END = "^", "$"


class UnreadableModel(ValueError):
    """A file is not a valid model."""


def features(words: Words) -> dict[str, float]:
    """Return the features: words and word pairs, character n-grams, and the sentence vector.

    The values are shares: each of the three groups has length 1, so long sentences weigh no more.
    """
    told = [*words, *(f"{a} {b}" for a, b in zip((BEGIN, *words), (*words, END), strict=True))]
    parts = {
        f"#{whole[start : start + size]}"
        for word in words
        if word != SOMEBODY
        for whole in (f" {word} ",)
        for size in range(SHORTEST_PART, LONGEST_PART + 1)
        for start in range(len(whole) - size + 1)
    }
    found = dict.fromkeys(told, 1 / math.sqrt(max(1, len(set(told)))))
    found |= dict.fromkeys(parts, 1 / math.sqrt(max(1, len(parts))))
    meaning = sentence_vector(tuple(word for word in words if word != SOMEBODY))
    return found | {f"~{number}": value for number, value in enumerate(meaning)}


@dataclass(frozen=True)
class IntentModel:
    """The weights of each feature for each of `behaviours` ("" asks for nothing)."""

    behaviours: tuple[str, ...]
    offsets: tuple[float, ...]
    weights: Mapping[str, tuple[float, ...]]

    def probabilities(self, words: Words) -> dict[str, float]:
        """Return the probability of each behaviour; they sum to 1."""
        scores = list(self.offsets)
        for name, value in features(words).items():
            for place, weight in enumerate(self.weights.get(name, ())):
                scores[place] += value * weight
        most = max(scores)
        raised = [math.exp(score - most) for score in scores]
        total = sum(raised)
        return {b: one / total for b, one in zip(self.behaviours, raised, strict=True)}

    def to_json(self) -> str:
        """Write the model as JSON."""
        return json.dumps(
            {"behaviours": self.behaviours, "offsets": self.offsets, "weights": self.weights},
            separators=(",", ":"),
        )


def read_model(text: str) -> IntentModel:
    """Read a model from JSON.

    Raises:
        UnreadableModel: it is invalid.
    """
    try:
        read: Any = json.loads(text)
        behaviours = tuple(map(str, read["behaviours"]))
        offsets = tuple(map(float, read["offsets"]))
        weights = {str(k): tuple(map(float, v)) for k, v in read["weights"].items()}
    except (ValueError, TypeError, KeyError, AttributeError, RecursionError) as error:
        raise UnreadableModel(str(error)) from None
    sizes = {len(behaviours), len(offsets), *map(len, weights.values())}
    finite = all(map(math.isfinite, offsets)) and all(
        math.isfinite(w) for row in weights.values() for w in row
    )
    if len(sizes) != 1 or not behaviours or not finite:
        raise UnreadableModel("The weights do not fit the behaviours.")
    return IntentModel(behaviours, offsets, weights)
