"""Train the classifier of card cells, from frames that are rendered here.

Run by hand: `python -m tests.bench.card_training --frames 2000` writes
`hw/tangy_hw/perception/cards/classifier.json`, in about half an hour on one core. The seeds of its
frames are its own: the bench of cards quotes its figures on others. `--keep FILE.npz` keeps the
features, to train again from them. Fewer than 60 frames are too few.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any, TypeAlias

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar

from tangy_hw.perception.cards import classifier as shipped
from tangy_hw.perception.cards.classifier import CLASSES, FAR, HIDDEN, MARKED, UNMARKED
from tangy_hw.perception.cards.features import NAMES, SEEN, SPOTS, features_of
from tangy_hw.perception.cards.locating import find_cards
from tangy_hw.perception.cards.rectifying import flatten
from tangy_profiles.activity import load_activity
from tangy_profiles.card_face import numbers_of
from tangy_sim.card_frames import HANDS, CardCamera, Frame
from tests.bench.card_nets import fit, outputs

Real: TypeAlias = NDArray[np.float32]
Whole: TypeAlias = NDArray[np.int64]

TRAINED, CHOSEN = (1000, 3000), 2000  # seeds: for the weights; for temperature and limit
FAINT, FAINT_CHOSEN = 5000, 6000  # seeds of frames with chips that are hard to see
CLEAR, COVERED = 0.10, 0.45  # of a cell under a hand: it counts as seen, as hidden
NETS = 3
WRONG = 4.5e-4  # of the cells, at most, where the limit is chosen: they are harder than in rooms
DOUBT = (0.35, 0.02, 0.2)  # how probably hidden a cell may be that is told; see `Classifier`


def some_frames(camera: CardCamera, seed: int, frames: int) -> Iterator[Frame]:
    """Yield frames as rooms have them, and more of what is hard: steep, dark, behind hands."""
    small = (660, 540)
    yield from camera.frames(seed, frames * 6 // 10, size=small)
    hard: list[dict[str, Any]] = [
        *({"tilt": tilt} for tilt in (52.0, 56.0, 60.0, 64.0)),
        *({"light": light} for light in (0.25, 0.35)),
        *({"hand": hand} for hand in (*HANDS, "finger", "finger")),
        *({"glare": glare} for glare in (0.3, 0.6)),
    ]
    for number, given in enumerate(hard):
        yield from camera.frames(
            seed + 1 + number, frames * 4 // 10 // len(hard), size=small, **given
        )
    yield from camera.frames(seed + 50, frames // 10, size=small, hand="thing")


def faint_frames(camera: CardCamera, seed: int, frames: int) -> Iterator[Frame]:
    """Yield frames of chips that are hard to see, half of them in glare."""
    small = (660, 540)
    hard: list[dict[str, Any]] = [
        {}, {}, {}, *({"glare": glare} for glare in (0.25, 0.45, 0.7, 1.0)), {"hand": "finger"},
    ]  # fmt: skip
    for number, given in enumerate(hard):
        yield from camera.frames(seed + number, frames // len(hard), size=small, **given)


def measured(frames: Iterable[Frame], camera: CardCamera) -> tuple[Real, Real, Whole]:
    """Measure the cells of frames.

    Returns a row of features for each, how much it belongs to each class, and whether there is
    really a chip on it.
    """
    deck = camera.face.deck
    rows, classes, marks = [], [], []
    for frame in frames:
        grey = cv2.cvtColor(frame.picture, cv2.COLOR_BGR2GRAY).astype(np.uint8)
        seen = next((s for s in find_cards(grey) if s.card == frame.card), None)
        flat = flatten(frame.picture, seen, camera.face, camera.deck_seed) if seen else None
        if flat is None or frame.card is None:
            continue
        features, _ = features_of(flat, camera.face, numbers_of(deck, frame.card))
        rows.append(features)
        for cell, covered in enumerate(frame.covered):
            mark = frame.marked >> cell & 1
            classes.append(belonging(mark, covered))
            marks.append(mark)
    return np.vstack(rows), np.array(classes, np.float32), np.array(marks)


def rendered(seeds: Sequence[int], faint: int, frames: int) -> list[Any]:
    """Render frames of these seeds, half as many again with faint chips, and measure the cells."""
    deck = load_activity("bingo").deck
    camera = CardCamera(deck, title="Bingo", straddling=0.2)
    washed = CardCamera(deck, title="Bingo", straddling=0.1, faint=0.85)
    parts = [measured(some_frames(camera, seed, frames), camera) for seed in seeds]
    more = len(seeds) * frames // 2
    parts.append(measured(faint_frames(washed, faint, more), washed))
    return [np.concatenate(part) for part in zip(*parts, strict=True)]


def belonging(mark: int, covered: float) -> list[float]:
    """Say how much a cell belongs to each class: one that is half covered belongs to two."""
    hidden = min(1.0, max(0.0, (covered - CLEAR) / (COVERED - CLEAR)))
    part = [0.0, 0.0, hidden]
    part[MARKED if mark else UNMARKED] = 1 - hidden
    return part


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--frames", type=int, default=2000, help="of each seed")
    parser.add_argument("--keep", type=Path)
    parser.add_argument("--out", type=Path, default=Path(shipped.__file__).with_suffix(".json"))
    options = parser.parse_args()
    cv2.setNumThreads(1)
    if options.keep is not None and options.keep.exists():
        kept = np.load(options.keep)
        learnt, chosen = ([kept[f"{name}{part}"] for part in range(3)] for name in "ab")
    else:
        learnt = rendered(TRAINED, FAINT, options.frames)
        chosen = rendered((CHOSEN,), FAINT_CHOSEN, options.frames * 35 // 100)
        if options.keep is not None:
            parts = {
                f"{n}{i}": p for n, s in (("a", learnt), ("b", chosen)) for i, p in enumerate(s)
            }
            np.savez_compressed(options.keep, **parts)
    document = train(learnt[0], learnt[1], *chosen)
    options.out.write_text(json.dumps(document, separators=(",", ":")) + "\n", encoding="utf-8")
    print(f"{options.out}: told from {document['sure']}")


def train(x: Real, y: Real, u: Real, v: Real, marks: Whole) -> dict[str, Any]:
    """Fit the nets to x and y, and choose temperature and limit on u, v and the marks there."""
    centre, spread = x.mean(0), x.std(0) + 1e-3
    scaled = np.clip((x - centre) / spread, -FAR, FAR).astype(np.float32)
    nets = [fit(scaled, y, seed) for seed in range(NETS)]
    held = np.clip((u - centre) / spread, -FAR, FAR).astype(np.float32)
    values = [outputs(net, held) for net in nets]

    def parts(temperature: float) -> Real:
        grown = [np.exp((one - one.max(1, keepdims=True)) / temperature) for one in values]
        return np.asarray(sum(one / one.sum(1, keepdims=True) for one in grown) / NETS)

    def surprise(temperature: float) -> float:
        return float(-(v * np.log(parts(temperature) + 1e-9)).sum(1).mean())

    temperature = float(minimize_scalar(surprise, bounds=(0.5, 5), method="bounded").x)
    part = parts(temperature)
    told = part[:, :2].argmax(1)
    in_sight = part[:, HIDDEN] <= np.array(DOUBT[:2])[told]
    best = np.where(in_sight, part[:, :2].max(1) / part[:, :2].sum(1), 0)
    seen = v[:, HIDDEN] == 0
    print(
        f"{len(x)} cells, {len(v)} to choose on; "
        f"loss {surprise(temperature):.5f}, temperature {temperature:.2f}"
    )
    sure = 0.999
    for limit in (0.999, 0.998, 0.995, 0.99, 0.98, 0.97, 0.95, 0.9):
        kept = best >= limit
        wrong = int((kept & (told != marks)).sum())
        lost = (~kept & seen).sum() / seen.sum()
        print(
            f"  {limit}: wrong {wrong} ({int((kept & seen & (told != marks)).sum())} in sight), "
            f"not told {lost:.4%}, hidden but told {int((kept & (v[:, HIDDEN] > 0.99)).sum())}"
        )
        if wrong <= WRONG * len(v):
            sure = min(sure, limit)
    return {
        "features": list(NAMES),
        "seen": list(SEEN),
        "spots": SPOTS,
        "classes": list(CLASSES),
        "centre": rounded(centre),
        "spread": rounded(spread),
        "nets": [
            [{"weights": rounded(weights), "bias": rounded(bias)} for weights, bias in net]
            for net in nets
        ],
        "temperature": round(temperature, 3),
        "sure": sure,
        "doubt": DOUBT,
    }


def rounded(values: Real) -> Any:
    """Return numbers as JSON has them, with four figures after the point."""
    return np.round(values.astype(float), 4).tolist()


if __name__ == "__main__":
    main()
