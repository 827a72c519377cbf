"""What a cell is, from its features: a small net whose coefficients are JSON in this folder."""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Real = NDArray[Any]

CLASSES = ("unmarked", "marked", "hidden")
UNMARKED, MARKED, HIDDEN = range(3)


@dataclass(frozen=True)
class Classifier:
    """A net with layers of weights; features are centred and scaled before it.

    `temperature` divides what it gives, so that of a hundred cells that are 99 % sure one is
    wrong; a cell that is less sure than `sure` is not told.
    """

    centre: Real
    spread: Real
    layers: tuple[tuple[Real, Real], ...]
    temperature: float
    sure: float

    def probabilities(self, features: Real) -> Real:
        """Return for each row how probable each of `CLASSES` is."""
        import numpy as np

        values = np.clip((features - self.centre) / self.spread, -8, 8)
        for place, (weights, bias) in enumerate(self.layers):
            values = values @ weights + bias
            if place < len(self.layers) - 1:
                values = np.maximum(values, 0)
        values = values / self.temperature
        grown = np.exp(values - values.max(1, keepdims=True))
        parts: Real = grown / grown.sum(1, keepdims=True)
        return parts


@cache
def load_classifier() -> Classifier:
    """Load the classifier that ships."""
    import numpy as np

    from tangy_hw.perception.cards.features import NAMES

    text = (files(__package__) / "classifier.json").read_text(encoding="utf-8")
    told = json.loads(text)
    if told["features"] != list(NAMES) or told["classes"] != list(CLASSES):
        raise RuntimeError("classifier.json was made for other features: train it again")
    real = np.float32
    return Classifier(
        np.array(told["centre"], real),
        np.array(told["spread"], real),
        tuple(
            (np.array(layer["weights"], real), np.array(layer["bias"], real))
            for layer in told["layers"]
        ),
        float(told["temperature"]),
        float(told["sure"]),
    )
