"""What a cell is: small nets, first of each cell alone, then of it among the others of its card.

Their coefficients are JSON in this folder.
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
FAR = 6.0  # spreads from its usual value: a feature that is further off counts as that
TURNS = 8  # ways to turn and mirror a cell: what is in it stays the same
LEAST = 1e-5  # probability: less counts as that


Net = tuple[tuple["Real", "Real"], ...]


@dataclass(frozen=True)
class Nets:
    """Several nets, each layers of weights; features are centred and scaled before them."""

    centre: Real
    spread: Real
    nets: tuple[Net, ...]

    def scaled(self, rows: Real) -> Real:
        """Return features standardised by their usual mean and spread."""
        import numpy as np

        told: Real = np.clip((rows - self.centre) / self.spread, -FAR, FAR).astype(np.float32)
        return told


@dataclass(frozen=True)
class Classifier:
    """What tells cells, and when it is sure enough.

    `alone` looks at each cell in all ways to turn it; `among` corrects that by what the card's
    other cells are. `temperature` divides what they give, so that of a hundred cells that are 99 %
    sure one is wrong. A cell is told if it is at least `sure` either marked or unmarked, supposed
    that it is in sight, and hidden with a probability of `doubt` at most: that of unmarked cells,
    of marked ones on a card with a hand, and of others. A finger may look like a chip, but comes
    with its hand.
    """

    alone: Nets
    among: Nets
    temperature: float
    sure: float
    doubt: tuple[float, float, float]

    def probabilities(self, rows: Real, beside: Real, across: int) -> Real:
        """Return for each cell how probable each of `CLASSES` is.

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
        """Say whether a cell is told that has these probabilities, on a card with a hand or not."""
        seen = float(part[UNMARKED] + part[MARKED])
        best = float(max(part[UNMARKED], part[MARKED]))
        unmarked, with_hand, without = self.doubt
        doubt = unmarked if part[UNMARKED] >= part[MARKED] else with_hand if hand else without
        return float(part[HIDDEN]) <= doubt and best >= self.sure * seen


def outputs(net: Net, values: Real) -> Real:
    """Return what a net gives, before it is made probabilities."""
    import numpy as np

    for place, (weights, bias) in enumerate(net):
        values = values @ weights + bias
        if place < len(net) - 1:
            values = np.maximum(values, 0)
    return values


def softmax(values: Real) -> Real:
    """Make probabilities of what a net gives."""
    import numpy as np

    grown = np.exp(values - values.max(-1, keepdims=True))
    told: Real = grown / grown.sum(-1, keepdims=True)
    return told


@cache
def turned(turn: int) -> Real:
    """Return where each feature of a cell is found when it is turned or mirrored this way.

    What has no direction stays.
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
    """Return how probable each class is by the cell alone: the mean of nets and ways to see it."""
    import numpy as np

    total: Real = np.zeros((len(scaled), len(CLASSES)), np.float32)
    for turn in range(TURNS):
        values = scaled[:, turned(turn)]
        for net in nets:
            total += softmax(outputs(net, values))
    return total / (len(nets) * TURNS)


def context_rows(parts: Real, scaled: Real, beside: Real, across: int) -> Real:
    """Return what the nets among the others look at: (cards, cells, features)."""
    import numpy as np

    from tangy_hw.perception.cards.context import LOOKS, context_of
    from tangy_hw.perception.cards.features import NAMES

    looks = scaled[..., [NAMES.index(name) for name in LOOKS]]
    around = context_of(parts, looks, beside, across)
    told: Real = np.concatenate([scaled[..., : len(NAMES)], around], -1)
    return told


def seen_among(nets: tuple[Net, ...], scaled: Real, known: Real, temperature: float) -> Real:
    """Return the probabilities whose logarithms by the cell alone are `known`, corrected."""
    import numpy as np

    parts = [softmax((outputs(net, scaled) + known) / temperature) for net in nets]
    told: Real = np.mean(parts, 0)
    return told


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


def _nets(told: dict[str, Any]) -> Nets:
    import numpy as np

    real = np.float32
    return Nets(
        np.array(told["centre"], real),
        np.array(told["spread"], real),
        tuple(
            tuple(
                (np.array(layer["weights"], real), np.array(layer["bias"], real)) for layer in net
            )
            for net in told["nets"]
        ),
    )
