"""Train the classifier of card cells, from frames that are rendered here.

Run by hand: `python -m tests.bench.card_training --frames 2600` writes
`hw/tangy_hw/perception/cards/classifier.json`. The seeds of its frames are its own: the bench of
cards quotes its figures on others. `--keep FILE.npz` keeps the features, to train again from them.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any, TypeAlias

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar
from sklearn.neural_network import MLPClassifier

from tangy_hw.perception.cards import classifier as shipped
from tangy_hw.perception.cards.classifier import CLASSES, HIDDEN, MARKED, UNMARKED
from tangy_hw.perception.cards.features import NAMES, features_of
from tangy_hw.perception.cards.locating import find_cards
from tangy_hw.perception.cards.rectifying import flatten
from tangy_profiles.activity import load_activity
from tangy_profiles.card_face import numbers_of
from tangy_sim.card_frames import CardCamera, Frame

Real: TypeAlias = NDArray[np.float32]
Whole: TypeAlias = NDArray[np.int64]

TRAINED, CHOSEN = 1000, 2000  # seeds: for the weights; for temperature, and the limit of sureness
CLEAR, COVERED = 0.10, 0.45  # of a cell under a hand: it counts as seen, as hidden
WIDTHS = (48, 24)
WRONG = 2e-5  # of the cells that are told, at most, where the limit is chosen


def some_frames(camera: CardCamera, seed: int, frames: int) -> Iterator[Frame]:
    """Yield frames as rooms have them, and more of what is hard: steep, dark, behind hands."""
    small = (660, 540)
    yield from camera.frames(seed, frames * 6 // 10, size=small)
    hard: list[dict[str, Any]] = [
        *({"tilt": tilt} for tilt in (52.0, 56.0, 60.0, 64.0)),
        *({"light": light} for light in (0.25, 0.35)),
        *({"hand": hand} for hand in ("finger", "finger", "finger", "thumb", "flat")),
        *({"glare": glare} for glare in (0.3, 0.6)),
    ]
    for number, given in enumerate(hard):
        yield from camera.frames(
            seed + 1 + number, frames * 4 // 10 // len(hard), size=small, **given
        )
    yield from camera.frames(seed + 50, frames // 10, size=small, hand="thing")


def measured(seed: int, frames: int) -> tuple[Real, Whole]:
    """Render frames and measure their cells; return a row of features for each, and its class."""
    deck = load_activity("bingo").deck
    camera = CardCamera(deck, title="Bingo")
    rows, classes = [], []
    for frame in some_frames(camera, seed, frames):
        grey = cv2.cvtColor(frame.picture, cv2.COLOR_BGR2GRAY).astype(np.uint8)
        seen = next((s for s in find_cards(grey) if s.card == frame.card), None)
        flat = flatten(frame.picture, seen, camera.face, camera.deck_seed) if seen else None
        if flat is None or frame.card is None:
            continue
        features, _ = features_of(flat, camera.face, numbers_of(deck, frame.card))
        for cell, row in enumerate(features):
            covered = frame.covered[cell]
            if CLEAR < covered < COVERED:
                continue
            rows.append(row)
            kind = MARKED if frame.marked >> cell & 1 else UNMARKED
            classes.append(HIDDEN if covered >= COVERED else kind)
    return np.array(rows, np.float32), np.array(classes)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--frames", type=int, default=2600)
    parser.add_argument("--keep", type=Path)
    parser.add_argument("--out", type=Path, default=Path(shipped.__file__).with_suffix(".json"))
    options = parser.parse_args()
    cv2.setNumThreads(1)
    if options.keep is not None and options.keep.exists():
        kept = np.load(options.keep)
        x, y, u, v = (kept[name] for name in ("x", "y", "u", "v"))
    else:
        x, y = measured(TRAINED, options.frames)
        u, v = measured(CHOSEN, options.frames // 3)
        if options.keep is not None:
            np.savez_compressed(options.keep, x=x, y=y, u=u, v=v)
    train(x, y, u, v, options.out)


def train(x: Real, y: Whole, u: Real, v: Whole, out: Path) -> None:
    """Fit the net to x and y, choose temperature and limit on u and v, and write it as JSON."""
    centre, spread = x.mean(0), x.std(0) + 1e-6
    scaled = np.clip((x - centre) / spread, -8, 8)
    net = MLPClassifier(
        WIDTHS, alpha=1e-2, learning_rate_init=2e-3, max_iter=60, batch_size=256,
        early_stopping=True, n_iter_no_change=8, random_state=1,
    )  # fmt: skip
    net.fit(scaled, y)
    values = np.clip((u - centre) / spread, -8, 8)
    for place, (weights, bias) in enumerate(zip(net.coefs_, net.intercepts_, strict=True)):
        values = values @ weights + bias
        if place < len(net.coefs_) - 1:
            values = np.maximum(values, 0)

    def surprise(temperature: float) -> float:
        grown = values / temperature
        grown = grown - grown.max(1, keepdims=True)
        return float(-(grown[np.arange(len(v)), v] - np.log(np.exp(grown).sum(1))).mean())

    temperature = float(minimize_scalar(surprise, bounds=(0.5, 5), method="bounded").x)
    grown = np.exp((values - values.max(1, keepdims=True)) / temperature)
    parts = grown / grown.sum(1, keepdims=True)
    told, best = parts[:, :2].argmax(1), parts[:, :2].max(1)
    seen = v != HIDDEN
    print(
        f"{len(x)} cells, {len(v)} to choose on; "
        f"loss {surprise(temperature):.5f}, temperature {temperature:.2f}"
    )
    sure = 0.999
    for limit in (0.95, 0.98, 0.99, 0.995, 0.998, 0.999):
        kept = best >= limit
        wrong = kept & seen & (told != v)
        lost = (~kept & seen).sum() / seen.sum()
        claimed = kept & ~seen
        print(
            f"  {limit}: wrong {wrong.sum()} of {seen.sum()}, not told {lost:.4%}, "
            f"hidden but told {claimed.sum()} of {(~seen).sum()}"
        )
        if wrong.sum() <= WRONG * seen.sum():
            sure = min(sure, limit)
    document = {
        "features": list(NAMES),
        "classes": list(CLASSES),
        "centre": [round(float(c), 5) for c in centre],
        "spread": [round(float(c), 5) for c in spread],
        "layers": [
            {
                "weights": [[round(float(w), 4) for w in row] for row in weights],
                "bias": [round(float(b), 4) for b in bias],
            }
            for weights, bias in zip(net.coefs_, net.intercepts_, strict=True)
        ],
        "temperature": round(temperature, 3),
        "sure": sure,
    }
    out.write_text(json.dumps(document) + "\n", encoding="utf-8")
    print(f"{out}: told from {sure}")


if __name__ == "__main__":
    main()
