"""What a cell is, from its features: small nets whose coefficients are JSON in this folder."""

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
FAR = 6.0  # spreads from its usual value: a feature that is further off counts as that


Net = tuple[tuple["Real", "Real"], ...]


@dataclass(frozen=True)
class Classifier:
    """Several nets, each layers of weights; features are centred and scaled before them.

    `temperature` divides what they give, so that of a hundred cells that are 99 % sure one is
    wrong. A cell is told if it is at least `sure` either marked or unmarked, supposed that it is in
    sight, and hidden with a probability of `doubt` at most: that of unmarked cells, of marked ones
    on a card with a hand, and of others. A finger may look like a chip, but comes with its hand.
    """

    centre: Real
    spread: Real
    nets: tuple[Net, ...]
    temperature: float
    sure: float
    doubt: tuple[float, float, float]

    def probabilities(self, features: Real) -> Real:
        """Return for each row how probable each of `CLASSES` is: the mean of the nets."""
        import numpy as np

        scaled = np.clip((features - self.centre) / self.spread, -FAR, FAR)
        total: Real = np.zeros((len(features), len(CLASSES)), np.float32)
        for net in self.nets:
            values = scaled
            for place, (weights, bias) in enumerate(net):
                values = values @ weights + bias
                if place < len(net) - 1:
                    values = np.maximum(values, 0)
            values = values / self.temperature
            grown = np.exp(values - values.max(1, keepdims=True))
            total += grown / grown.sum(1, keepdims=True)
        return total / len(self.nets)

    def tells(self, part: Real, hand: bool) -> bool:
        """Say whether a cell is told that has these probabilities, on a card with a hand or not."""
        seen = float(part[UNMARKED] + part[MARKED])
        best = float(max(part[UNMARKED], part[MARKED]))
        unmarked, with_hand, without = self.doubt
        doubt = unmarked if part[UNMARKED] >= part[MARKED] else with_hand if hand else without
        return float(part[HIDDEN]) <= doubt and best >= self.sure * seen


@cache
def load_classifier() -> Classifier:
    """Load the classifier that ships."""
    text = (files(__package__) / "classifier.json").read_text(encoding="utf-8")
    return read_classifier(json.loads(text))


def read_classifier(told: dict[str, Any]) -> Classifier:
    """Read a classifier from JSON.

    Raises:
        RuntimeError: it was made for other features.
    """
    import numpy as np

    from tangy_hw.perception.cards.features import NAMES, SEEN, SPOTS

    wanted = {"features": [*NAMES], "seen": [*SEEN], "spots": SPOTS, "classes": [*CLASSES]}
    if any(told.get(key) != value for key, value in wanted.items()):
        raise RuntimeError("classifier.json was made for other features: train it again")
    real = np.float32
    return Classifier(
        np.array(told["centre"], real),
        np.array(told["spread"], real),
        tuple(
            tuple(
                (np.array(layer["weights"], real), np.array(layer["bias"], real)) for layer in net
            )
            for net in told["nets"]
        ),
        float(told["temperature"]),
        float(told["sure"]),
        (float(told["doubt"][0]), float(told["doubt"][1]), float(told["doubt"][2])),
    )
