"""Train the classifier of card cells, from frames that are rendered here.

Run by hand: `python -m tests.bench.card_training` writes
`hw/tangy_hw/perception/cards/classifier.json`, in about an hour on one core. The seeds
of its frames are its own: the bench of cards quotes its figures on others. `--keep DIR` keeps what
was measured, to train again from it. Fewer than 100 frames are too few.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
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
from tangy_sim.card_chips import Chip
from tangy_sim.card_frames import HANDS, CardCamera, Frame, View
from tangy_sim.card_odd_chips import odd_chip, sheer_chip
from tests.bench.card_nets import Layers, fit, outputs

Real: TypeAlias = NDArray[np.float32]
Whole: TypeAlias = NDArray[np.int64]

CLEAR, COVERED = 0.10, 0.45  # of a cell under a hand: it counts as seen, as hidden
NETS = 3
SURE = 0.94  # of frames of seeds 101000 and 102000 the most are told with it, of those few wrongly
DOUBT = (0.35, 0.02, 0.2)  # how probably hidden a cell may be that is told; see `Classifier`
HARD, EASY = 0.7, 0.4  # of the unmarked cells without a hand, so many are learnt from


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


def odd_frames(camera: CardCamera, seed: int, frames: int) -> Iterator[Frame]:
    """Yield frames of things that lie on cards in the place of chips."""
    small = (660, 540)
    hard: list[dict[str, Any]] = [
        {}, {}, {}, {}, {"glare": 0.35}, {"glare": 0.7}, {"hand": "finger"}, {"hand": "blob"},
    ]  # fmt: skip
    for number, given in enumerate(hard):
        yield from camera.frames(seed + number, frames // len(hard), size=small, **given)


@dataclass(frozen=True)
class Kind:
    """Frames of one kind: how they are made, and from which seeds, in thousands of frames."""

    frames: Callable[[CardCamera, int, int], Iterator[Frame]]
    straddling: float
    faint: float
    odd: float
    learnt: dict[int, float]
    chosen: dict[int, float]
    oddity: Callable[[np.random.Generator], Chip] = odd_chip

    def camera(self) -> CardCamera:
        """Return what takes them."""
        deck = load_activity("bingo").deck
        return CardCamera(
            deck,
            title="Bingo",
            straddling=self.straddling,
            faint=self.faint,
            odd=self.odd,
            oddity=self.oddity,
        )


KINDS = (
    Kind(some_frames, 0.2, 0.0, 0.0, {1000: 1.25}, {2000: 0.25}),
    Kind(faint_frames, 0.1, 0.85, 0.0, {5000: 0.75}, {6000: 0.15}),
    Kind(odd_frames, 0.1, 0.15, 0.85, {8000: 0.7}, {9000: 0.2}),
    Kind(odd_frames, 0.1, 0.0, 0.9, {8500: 0.325}, {9500: 0.1}, sheer_chip),
)
"""What is learnt from, and what the temperature is chosen on: seeds, and parts of frames."""


@dataclass(frozen=True)
class Cells:
    """What was measured of cells, and what is true of them.

    `belongs` is how much each is of each class, `marks` whether there is really a chip on it.
    """

    rows: Real
    belongs: Real
    marks: Whole

    @staticmethod
    def of(parts: list[Cells]) -> Cells:
        """Put several together."""
        return Cells(
            np.vstack([part.rows for part in parts]),
            np.vstack([part.belongs for part in parts]),
            np.concatenate([part.marks for part in parts]),
        )


def measured(frames: Iterable[Frame], camera: CardCamera, thinned: int | None) -> Iterator[Cells]:
    """Measure the cells of frames; with a seed to thin them by, fewer of those that are easy."""
    deck = camera.face.deck
    random = np.random.default_rng(thinned)
    for frame in frames:
        grey = cv2.cvtColor(frame.picture, cv2.COLOR_BGR2GRAY).astype(np.uint8)
        seen = next((s for s in find_cards(grey) if s.card == frame.card), None)
        flat = flatten(frame.picture, seen, camera.face, camera.deck_seed) if seen else None
        if flat is None or frame.card is None:
            continue
        told = features_of(flat, camera.face, numbers_of(deck, frame.card))
        marks = np.array([frame.marked >> cell & 1 for cell in range(len(told.rows))])
        covered = np.array(frame.covered)
        share = np.full(len(marks), HARD if is_hard(frame.view) else EASY)
        share[(marks == 1) | bool(frame.view.hand)] = 1.0
        kept = np.flatnonzero((random.random(len(marks)) < share) | (thinned is None))
        belongs = [belonging(int(mark), part) for mark, part in zip(marks, covered, strict=True)]
        yield Cells(told.rows[kept], np.array(belongs, np.float32)[kept], marks[kept])


def is_hard(view: View) -> bool:
    """Say whether cells are harder to tell than most in a view."""
    lit = view.glare > 0 or view.shadow > 0 or view.light < 0.45
    return lit or view.motion > 1.5 or view.tilt > 45 or view.pixels < 22 or bool(view.hand)


def rendered(kind: Kind, seeds: dict[int, float], frames: int, *, thin: bool) -> list[Cells]:
    """Render frames of these seeds, and measure the cells."""
    camera = kind.camera()
    return [
        cells
        for seed, part in seeds.items()
        for cells in measured(
            kind.frames(camera, seed, round(part * frames)), camera, seed if thin else None
        )
    ]


def belonging(mark: int, covered: float) -> list[float]:
    """Say how much a cell belongs to each class: one that is half covered belongs to two."""
    hidden = min(1.0, max(0.0, (covered - CLEAR) / (COVERED - CLEAR)))
    part = [0.0, 0.0, hidden]
    part[MARKED if mark else UNMARKED] = 1 - hidden
    return part


def all_cells(frames: int, keep: Path | None, *, learnt: bool) -> Cells:
    """Render what is learnt from, or what is chosen on; or load what was kept."""
    kept = None if keep is None else keep / f"{'learnt' if learnt else 'chosen'}.npz"
    if kept is not None and kept.exists():
        stored = np.load(kept)
        return Cells(*(stored[name] for name in ("rows", "belongs", "marks")))
    parts = [
        cells
        for kind in KINDS
        for cells in rendered(kind, kind.learnt if learnt else kind.chosen, frames, thin=learnt)
    ]
    cells = Cells.of(parts)
    if kept is not None:
        kept.parent.mkdir(parents=True, exist_ok=True)
        np.savez(kept, **vars(cells))
    return cells


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "--frames", type=int, default=1600, help="of the first kind; fewer of the others"
    )
    parser.add_argument("--keep", type=Path, metavar="DIR")
    parser.add_argument("--out", type=Path, default=Path(shipped.__file__).with_suffix(".json"))
    options = parser.parse_args()
    cv2.setNumThreads(1)
    learnt = all_cells(options.frames, options.keep, learnt=True)
    chosen = all_cells(options.frames, options.keep, learnt=False)
    document = train(learnt, chosen)
    options.out.write_text(json.dumps(document, separators=(",", ":")) + "\n", encoding="utf-8")
    print(f"{options.out}: told from {document['sure']}")


def train(learnt: Cells, chosen: Cells) -> dict[str, Any]:
    """Fit the nets to what is learnt from, and choose the temperature on other cells."""
    centre, spread = learnt.rows.mean(0), learnt.rows.std(0) + 1e-3
    scaled = np.clip((learnt.rows - centre) / spread, -FAR, FAR).astype(np.float32)
    nets = [fit(scaled, learnt.belongs, seed) for seed in range(NETS)]
    return document_of(nets, centre, spread, chosen)


def document_of(nets: list[Layers], centre: Real, spread: Real, chosen: Cells) -> dict[str, Any]:
    """Choose the temperature on these cells; return all of it as JSON has it."""
    held = np.clip((chosen.rows - centre) / spread, -FAR, FAR).astype(np.float32)
    values = [outputs(net, held) for net in nets]
    v = chosen.belongs

    def parts(temperature: float) -> Real:
        grown = [np.exp((one - one.max(1, keepdims=True)) / temperature) for one in values]
        return np.asarray(sum(one / one.sum(1, keepdims=True) for one in grown) / len(nets))

    def surprise(temperature: float) -> float:
        return float(-(v * np.log(parts(temperature) + 1e-9)).sum(1).mean())

    temperature = float(minimize_scalar(surprise, bounds=(0.5, 5), method="bounded").x)
    part = parts(temperature)
    told = part[:, :2].argmax(1)
    in_sight = part[:, HIDDEN] <= np.array(DOUBT[:2])[told]
    best = np.where(in_sight, part[:, :2].max(1) / part[:, :2].sum(1), 0)
    seen = v[:, HIDDEN] == 0
    loss = surprise(temperature)
    print(f"{len(v)} cells to choose on; loss {loss:.5f}, temperature {temperature:.2f}")
    for limit in (0.999, 0.998, 0.995, 0.99, 0.98, 0.97, 0.95, SURE, 0.9):
        kept = best >= limit
        off = kept & (told != chosen.marks)
        wrong = int(off.sum())
        lost = (~kept & seen).sum() / seen.sum()
        print(
            f"  {limit}: wrong {wrong} ({int((off & seen).sum())} in sight), "
            f"not told {lost:.4%}, hidden but told {int((kept & (v[:, HIDDEN] > 0.99)).sum())}"
        )
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
        "sure": SURE,
        "doubt": DOUBT,
    }


def rounded(values: Real) -> Any:
    """Return numbers as JSON has them, with four figures after the point."""
    return np.round(values.astype(float), 4).tolist()


if __name__ == "__main__":
    main()
