"""Fits the small nets of card cells: Adam, cross entropy with soft classes, and mirrored cells."""

from __future__ import annotations

from itertools import pairwise
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from tangy_hw.perception.cards.features import NAMES, SEEN, SPOTS

Real: TypeAlias = NDArray[Any]
Layers: TypeAlias = "list[list[Real]]"

WIDTHS = (64, 32)
ROUNDS, BATCH, FASTEST = 14, 256, 2e-3
DECAY, LOST, NOISE = 2e-4, 0.02, 0.02
"""Of the weights in a step's speed; of the features that are left out; of a spread, on each."""


def turned(rows: Real, turn: int) -> Real:
    """Return cells as they would be seen in one of eight ways: turned and mirrored.

    What has no direction stays.
    """
    named = len(NAMES)
    spots = rows[:, named:].reshape(len(rows), len(SEEN), SPOTS, SPOTS)
    spots = np.rot90(spots, turn % 4, (2, 3))
    if turn >= 4:
        spots = spots[..., ::-1]
    return np.hstack([rows[:, :named], spots.reshape(len(rows), -1)])


def fit(scaled: Real, wanted: Real, seed: int) -> Layers:
    """Fit one net; `wanted` is how much each row belongs to each class."""
    random = np.random.default_rng(seed)
    sizes = [scaled.shape[1], *WIDTHS, wanted.shape[1]]
    layers: Layers = [
        [
            (random.normal(0, (2 / a) ** 0.5, (a, b))).astype(np.float32),
            np.zeros(b, np.float32),
        ]
        for a, b in pairwise(sizes)
    ]
    first = [[np.zeros_like(part) for part in layer] for layer in layers]
    second = [[np.zeros_like(part) for part in layer] for layer in layers]
    steps, step = ROUNDS * (len(scaled) // BATCH), 0
    for _ in range(ROUNDS):
        order = random.permutation(len(scaled))
        for begin in range(0, len(order) - BATCH + 1, BATCH):
            rows = order[begin : begin + BATCH]
            x = turned(scaled[rows], int(random.integers(8))).astype(np.float32)
            x = x + NOISE * random.standard_normal(x.shape, np.float32)
            x *= random.random(x.shape, np.float32) > LOST
            slopes = _slopes(layers, x, wanted[rows])
            step += 1
            speed = FASTEST * 0.5 * (1 + np.cos(np.pi * step / steps))
            for layer, slope, a, b in zip(layers, slopes, first, second, strict=True):
                for part in range(2):
                    a[part] += 0.1 * (slope[part] - a[part])
                    b[part] += 0.001 * (slope[part] ** 2 - b[part])
                    mean, spread = a[part] / (1 - 0.9**step), b[part] / (1 - 0.999**step)
                    layer[part] -= speed * mean / (np.sqrt(spread) + 1e-8)
                layer[0] *= 1 - speed * DECAY * 10
    return layers


def _slopes(layers: Layers, x: Real, wanted: Real) -> Layers:
    """Return how the cross entropy changes with each weight."""
    inside = [x]
    for place, (weights, bias) in enumerate(layers):
        x = x @ weights + bias
        if place < len(layers) - 1:
            x = np.maximum(x, 0)
        inside.append(x)
    grown = np.exp(x - x.max(1, keepdims=True))
    back = (grown / grown.sum(1, keepdims=True) - wanted) / len(x)
    slopes: Layers = []
    for place in range(len(layers) - 1, -1, -1):
        slopes.insert(0, [inside[place].T @ back, back.sum(0)])
        back = (back @ layers[place][0].T) * (inside[place] > 0)
    return slopes


def outputs(layers: Layers, scaled: Real) -> Real:
    """Return what a net gives, before it is made probabilities."""
    values = scaled
    for place, (weights, bias) in enumerate(layers):
        values = values @ weights + bias
        if place < len(layers) - 1:
            values = np.maximum(values, 0)
    return values
