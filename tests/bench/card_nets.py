"""Fits the small nets of card cells: Adam, cross entropy with soft classes, and rotated cells."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from tangy_hw.perception.cards.classifier import TURNS, Net, softmax, turned

Real: TypeAlias = NDArray[Any]
Layers: TypeAlias = "list[list[Real]]"

BATCH = 256
POOL = 4_000_000  # random numbers in a pool; each step uses a different part


@dataclass(frozen=True)
class Plan:
    """How nets are fitted.

    `decay` is the decay of weights, in proportion to the step size; `lost` is the share of features
    left out; `noise`, in spreads, is added to each. With `turning`, cells are rotated.
    """

    widths: tuple[int, ...]
    rounds: int
    fastest: float
    decay: float
    lost: float
    noise: float
    turning: bool


ALONE = Plan((64, 32), 14, 2e-3, 2e-4, 0.02, 0.02, turning=True)
AMONG = Plan((32,), 8, 1e-3, 1e-3, 0.05, 0.05, turning=False)


def fit(scaled: Real, wanted: Real, seed: int, plan: Plan, known: Real | None = None) -> Net:
    """Fit one net; `wanted` is the share of each class in each row.

    `known` are log probabilities that the net corrects.
    """
    random = np.random.default_rng(seed)
    sizes = [scaled.shape[1], *plan.widths, wanted.shape[1]]
    layers: Layers = [
        [
            (random.normal(0, (2 / a) ** 0.5, (a, b))).astype(np.float32),
            np.zeros(b, np.float32),
        ]
        for a, b in pairwise(sizes)
    ]
    if known is not None:
        layers[-1][0] *= 0.05
    first = [[np.zeros_like(part) for part in layer] for layer in layers]
    second = [[np.zeros_like(part) for part in layer] for layer in layers]
    steps, step = plan.rounds * (len(scaled) // BATCH), 0
    grain = plan.noise * random.standard_normal(POOL, np.float32)
    kept = (random.random(POOL, np.float32) > plan.lost).astype(np.float32)

    def some(pool: Real, like: Real) -> Real:
        begin = int(random.integers(len(pool) - like.size))
        return pool[begin : begin + like.size].reshape(like.shape)

    for _ in range(plan.rounds):
        order = random.permutation(len(scaled))
        for begin in range(0, len(order) - BATCH + 1, BATCH):
            rows = order[begin : begin + BATCH]
            x = scaled[rows]
            if plan.turning:
                x = x[:, turned(int(random.integers(TURNS)))]
            x = (x + some(grain, x)) * some(kept, x)
            slopes = _slopes(layers, x, wanted[rows], None if known is None else known[rows])
            step += 1
            speed = plan.fastest * 0.5 * (1 + np.cos(np.pi * step / steps))
            for layer, slope, a, b in zip(layers, slopes, first, second, strict=True):
                for part in range(2):
                    a[part] += 0.1 * (slope[part] - a[part])
                    b[part] += 0.001 * (slope[part] ** 2 - b[part])
                    mean, spread = a[part] / (1 - 0.9**step), b[part] / (1 - 0.999**step)
                    layer[part] -= speed * mean / (np.sqrt(spread) + 1e-8)
                layer[0] *= 1 - speed * plan.decay * 10
    return tuple((weights, bias) for weights, bias in layers)


def _slopes(layers: Layers, x: Real, wanted: Real, known: Real | None) -> Layers:
    """Return the gradient of the cross entropy by the weights."""
    inside = [x]
    for place, (weights, bias) in enumerate(layers):
        x = x @ weights + bias
        if place < len(layers) - 1:
            x = np.maximum(x, 0)
        inside.append(x)
    back = (softmax(x if known is None else x + known) - wanted) / len(x)
    slopes: Layers = []
    for place in range(len(layers) - 1, -1, -1):
        slopes.insert(0, [inside[place].T @ back, back.sum(0)])
        back = (back @ layers[place][0].T) * (inside[place] > 0)
    return slopes
