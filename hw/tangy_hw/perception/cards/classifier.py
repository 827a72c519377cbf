"""Classifies cells with small neural networks: each cell alone, then in the context of its card.

Their weights are JSON in this folder.
"""

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
FAR = 6.0  # standard deviations at which features are clipped
TURNS = 8  # rotations and reflections of a cell, which keep its class
LEAST = 1e-5  # minimum probability


Net = tuple[tuple["Real", "Real"], ...]


@dataclass(frozen=True)
class NetEnsemble:
    """An ensemble of networks, each a list of layers; features are standardised first."""

    centre: Real
    spread: Real
    nets: tuple[Net, ...]

    def scaled(self, rows: Real) -> Real:
        """Return standardised and clipped features (cells, features)."""
        import numpy as np

        told: Real = np.clip((rows - self.centre) / self.spread, -FAR, FAR).astype(np.float32)
        return told


@dataclass(frozen=True)
class Classifier:
    """The networks, and the thresholds of a decision.

    `alone` classifies each cell in all orientations; `among` corrects this by the card's other
    cells. `temperature` calibrates the output, so that one of a hundred cells at 99 % is wrong. A
    cell is decided if it is marked or unmarked with a probability of at least `sure`, given that it
    is visible, and hidden with at most `doubt`: for unmarked cells, for marked ones on a card with
    a hand, and for other marked ones. A finger may look like a chip, but comes with its hand.
    """

    alone: NetEnsemble
    among: NetEnsemble
    temperature: float
    sure: float
    doubt: tuple[float, float, float]

    def probabilities(self, rows: Real, beside: Real, across: int) -> Real:
        """Return the probability of each of `CLASSES` for each cell (cells, classes).

        `rows` are the features of a card's cells, `beside` is that of `Measured`; the grid has
        `across` columns.
        """
        import numpy as np

        scaled = self.alone.scaled(rows)
        first = seen_alone(self.alone.nets, scaled)
        among = context_rows(first[None], scaled[None], beside[None], across)[0]
        known = np.log(np.maximum(first, LEAST))
        return seen_among(self.among.nets, self.among.scaled(among), known, self.temperature)

    def tells(self, part: Real, hand: bool) -> bool:
        """Return whether a cell with probabilities (3,) is decided, with or without a hand."""
        seen = float(part[UNMARKED] + part[MARKED])
        best = float(max(part[UNMARKED], part[MARKED]))
        unmarked, with_hand, without = self.doubt
        doubt = unmarked if part[UNMARKED] >= part[MARKED] else with_hand if hand else without
        return float(part[HIDDEN]) <= doubt and best >= self.sure * seen


def outputs(net: Net, values: Real) -> Real:
    """Return the outputs (logits) of a network (n, classes)."""
    import numpy as np

    for place, (weights, bias) in enumerate(net):
        values = values @ weights + bias
        if place < len(net) - 1:
            values = np.maximum(values, 0)
    return values


def softmax(values: Real) -> Real:
    """Return the softmax of logits (..., classes)."""
    import numpy as np

    grown = np.exp(values - values.max(-1, keepdims=True))
    told: Real = grown / grown.sum(-1, keepdims=True)
    return told


@cache
def turned(turn: int) -> Real:
    """Return the permutation of features (n,) when a cell is rotated or mirrored this way.

    Features without a direction stay.
    """
    import numpy as np

    from tangy_hw.perception.cards.features import NAMES, SEEN, SPOTS

    named = len(NAMES)
    spots = named + np.arange(len(SEEN) * SPOTS * SPOTS).reshape(-1, SPOTS, SPOTS)
    spots = np.rot90(spots, turn % 4, (1, 2))
    if turn >= TURNS // 2:
        spots = spots[..., ::-1]
    return np.concatenate([np.arange(named), spots.ravel()])


def seen_alone(nets: tuple[Net, ...], scaled: Real) -> Real:
    """Return class probabilities (cells, classes) by the cell alone: mean of networks and turns."""
    import numpy as np

    total: Real = np.zeros((len(scaled), len(CLASSES)), np.float32)
    for turn in range(TURNS):
        values = scaled[:, turned(turn)]
        for net in nets:
            total += softmax(outputs(net, values))
    return total / (len(nets) * TURNS)


def context_rows(parts: Real, scaled: Real, beside: Real, across: int) -> Real:
    """Return the inputs of the context networks: (cards, cells, features)."""
    import numpy as np

    from tangy_hw.perception.cards.context import LOOKS, context_of
    from tangy_hw.perception.cards.features import NAMES

    looks = scaled[..., [NAMES.index(name) for name in LOOKS]]
    around = context_of(parts, looks, beside, across)
    told: Real = np.concatenate([scaled[..., : len(NAMES)], around], -1)
    return told


def seen_among(nets: tuple[Net, ...], scaled: Real, known: Real, temperature: float) -> Real:
    """Return corrected probabilities (cells, classes); `known` are logarithms by the cell alone."""
    import numpy as np

    parts = [softmax((outputs(net, scaled) + known) / temperature) for net in nets]
    told: Real = np.mean(parts, 0)
    return told


@cache
def load_classifier() -> Classifier:
    """Load the classifier of this package."""
    text = (files(__package__) / "classifier.json").read_text(encoding="utf-8")
    return read_classifier(json.loads(text))


def read_classifier(told: dict[str, Any]) -> Classifier:
    """Read a classifier from JSON.

    Raises:
        RuntimeError: it was trained with other features.
    """
    from tangy_hw.perception.cards import context, features

    wanted = {
        "features": [*features.NAMES],
        "seen": [*features.SEEN],
        "spots": features.SPOTS,
        "context": [*context.NAMES],
        "classes": [*CLASSES],
    }
    if any(told.get(key) != value for key, value in wanted.items()):
        raise RuntimeError("classifier.json was made for other features: train it again")
    return Classifier(
        _nets(told["alone"]),
        _nets(told["among"]),
        float(told["temperature"]),
        float(told["sure"]),
        (float(told["doubt"][0]), float(told["doubt"][1]), float(told["doubt"][2])),
    )


def _nets(told: dict[str, Any]) -> NetEnsemble:
    import numpy as np

    real = np.float32
    return NetEnsemble(
        np.array(told["centre"], real),
        np.array(told["spread"], real),
        tuple(
            tuple(
                (np.array(layer["weights"], real), np.array(layer["bias"], real)) for layer in net
            )
            for net in told["nets"]
        ),
    )
