"""Train the classifier of card cells on frames that this bench renders.

Run by hand: `python -m tests.bench.card_training` writes
`hw/tangy_hw/perception/cards/classifier.json`, in about an hour on one core. The seeds
of its frames are reserved for training: the bench of cards quotes its figures on others. `--keep
DIR` keeps the measurements, to train again from them. Fewer than 100 frames are too few.

Training uses two halves: nets of one half predict the cells of the other. These predictions are as
uncertain as predictions on new cards will be. The nets that look at whole cards learn from them.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, TypeAlias

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar

from tangy_hw.perception.cards import classifier as shipped
from tangy_hw.perception.cards import context
from tangy_hw.perception.cards.card_detection import find_cards
from tangy_hw.perception.cards.classifier import (
    CLASSES,
    HIDDEN,
    LEAST,
    MARKED,
    TURNS,
    UNMARKED,
    Classifier,
    Net,
    context_rows,
    seen_alone,
    turned,
)
from tangy_hw.perception.cards.features import NAMES, SEEN, SPOTS, features_of
from tangy_hw.perception.cards.rectification import flatten
from tangy_profiles.card_face import numbers_of
from tangy_sim.rendering.card_frames import CardCamera, RenderedFrame
from tests.bench.card_kinds import KINDS
from tests.bench.card_nets import ALONE, AMONG, fit

Real: TypeAlias = NDArray[Any]
Whole: TypeAlias = NDArray[np.int64]

CLEAR, COVERED = 0.10, 0.45  # of a cell under a hand: the limits to count as seen, as hidden
NETS, AMONG_NETS = 2, 3  # nets of each half; and of the nets that look at whole cards
ACROSS = 5  # columns of the training cards
SURE = 0.965  # with it, 90 % of the cards of seed 102000 outside training are reported whole
DOUBT = (0.35, 0.012, 0.025)  # the limits of P(hidden) for a reported cell; see `Classifier`


@dataclass(frozen=True)
class Cells:
    """Measurements and truth of the cells of cards, by card, cell and value.

    `belongs` is the share of each class, `marks` whether there is really a chip on the cell;
    `beside` is that of `Measured`.
    """

    rows: Real
    beside: Real
    belongs: Real
    marks: Whole

    @staticmethod
    def of(parts: list[Cells]) -> Cells:
        """Concatenate several."""
        return Cells(
            *(np.concatenate([getattr(part, name) for part in parts]) for name in MEASURED)
        )


MEASURED = ("rows", "beside", "belongs", "marks")


def measured(frames: Iterable[RenderedFrame], camera: CardCamera) -> Iterator[Cells]:
    """Measure the cells of frames in which a card is found."""
    deck = camera.face.deck
    for frame in frames:
        grey = cv2.cvtColor(frame.picture, cv2.COLOR_BGR2GRAY).astype(np.uint8)
        seen = next((s for s in find_cards(grey) if s.card == frame.card), None)
        flat = flatten(frame.picture, seen, camera.face, camera.deck_seed) if seen else None
        if flat is None or frame.card is None:
            continue
        told = features_of(flat, camera.face, numbers_of(deck, frame.card))
        marks = np.array([frame.marked >> cell & 1 for cell in range(len(told.rows))])
        pairs = zip(marks, frame.covered, strict=True)
        belongs = np.array([belonging(int(mark), part) for mark, part in pairs], np.float32)
        yield Cells(told.rows[None], told.beside[None], belongs[None], marks[None])


def belonging(mark: int, covered: float) -> list[float]:
    """Return a cell's share of each class: a half covered cell belongs to two."""
    hidden = min(1.0, max(0.0, (covered - CLEAR) / (COVERED - CLEAR)))
    part = [0.0, 0.0, hidden]
    part[MARKED if mark else UNMARKED] = 1 - hidden
    return part


def all_cells(part: float, keep: Path | None, *, learnt: bool) -> Cells:
    """Render or load the frames of training, or of the choice of limits."""
    kept = None if keep is None else keep / f"{'learnt' if learnt else 'chosen'}.npz"
    if kept is not None and kept.exists():
        stored = np.load(kept)
        return Cells(*(stored[name] for name in MEASURED))
    cells = Cells.of(
        [
            cells
            for kind in KINDS
            for camera in [kind.camera()]
            for seed, frames in (kind.learnt if learnt else kind.chosen).items()
            for cells in measured(kind.frames(camera, seed, round(part * frames)), camera)
        ]
    )
    if kept is not None:
        kept.parent.mkdir(parents=True, exist_ok=True)
        np.savez(kept, **{name: getattr(cells, name) for name in MEASURED})
    return cells


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--part", type=float, default=1.0, help="of the frames that are made")
    parser.add_argument("--keep", type=Path, metavar="DIR")
    parser.add_argument("--out", type=Path, default=Path(shipped.__file__).with_suffix(".json"))
    options = parser.parse_args()
    cv2.setNumThreads(1)
    learnt = all_cells(options.part, options.keep, learnt=True)
    chosen = all_cells(options.part, options.keep, learnt=False)
    fitted = train(learnt)
    document = document_of(replace(fitted, temperature=chosen_temperature(fitted, chosen)))
    options.out.write_text(json.dumps(document, separators=(",", ":")) + "\n", encoding="utf-8")
    print(f"{options.out}: told from {document['sure']}")


def train(learnt: Cells) -> Classifier:
    """Fit the nets to the training cells."""
    centre, spread = (
        np.mean([values[turned(turn)] for turn in range(TURNS)], 0) for values in usual(learnt.rows)
    )
    alike = shipped.NetEnsemble(centre, spread, ())
    scaled, half = alike.scaled(learnt.rows), np.arange(len(learnt.rows)) % 2
    first = np.zeros(learnt.belongs.shape, np.float32)
    nets: list[Net] = []
    for part in range(2):
        own, other = half == part, half != part
        mine = [
            fit(joined(scaled[own]), joined(learnt.belongs[own]), 10 * part + seed, ALONE)
            for seed in range(NETS)
        ]
        first[other] = seen_alone(tuple(mine), joined(scaled[other])).reshape(first[other].shape)
        nets += mine
    alone = replace(alike, nets=tuple(nets))
    rows = context_rows(first, scaled, learnt.beside, ACROSS)
    around = shipped.NetEnsemble(*usual(rows), ())
    known = joined(np.log(np.maximum(first, LEAST)))
    corrected = [
        fit(joined(around.scaled(rows)), joined(learnt.belongs), 100 + seed, AMONG, known)
        for seed in range(AMONG_NETS)
    ]
    return Classifier(alone, replace(around, nets=tuple(corrected)), 1.0, SURE, DOUBT)


def usual(rows: Real) -> tuple[Real, Real]:
    """Return the mean and the spread of features of cells."""
    return joined(rows).mean(0), joined(rows).std(0) + 1e-3


def joined(values: Real) -> Real:
    """Stack the cells of all cards."""
    return values.reshape(-1, values.shape[-1])


def chosen_temperature(fitted: Classifier, chosen: Cells) -> float:
    """Choose the temperature on these cells, and print how well they are read with it."""
    scaled = fitted.alone.scaled(chosen.rows)
    first = seen_alone(fitted.alone.nets, joined(scaled)).reshape(chosen.belongs.shape)
    rows = joined(fitted.among.scaled(context_rows(first, scaled, chosen.beside, ACROSS)))
    known, v = joined(np.log(np.maximum(first, LEAST))), joined(chosen.belongs)

    def surprise(part: Real) -> float:
        return float(-(v * np.log(part + 1e-9)).sum(1).mean())

    def parts(temperature: float) -> Real:
        return shipped.seen_among(fitted.among.nets, rows, known, temperature)

    best = minimize_scalar(lambda t: surprise(parts(t)), bounds=(0.5, 5), method="bounded")
    temperature = float(best.x)
    part = parts(temperature)
    told = part[:, :2].argmax(1)
    in_sight = part[:, HIDDEN] <= np.array(DOUBT[:2])[told]
    sure = np.where(in_sight, part[:, :2].max(1) / part[:, :2].sum(1), 0)
    seen = v[:, HIDDEN] == 0
    print(
        f"{len(v)} cells to choose on; loss {surprise(joined(first)):.5f} by each alone, "
        f"{surprise(part):.5f} among others, temperature {temperature:.2f}"
    )
    for limit in (0.999, 0.998, 0.995, 0.99, 0.98, 0.97, 0.95, SURE, 0.9):
        kept = sure >= limit
        off = kept & (told != chosen.marks.ravel())
        lost = (~kept & seen).sum() / seen.sum()
        print(
            f"  {limit}: wrong {int(off.sum())} ({int((off & seen).sum())} in sight), "
            f"not told {lost:.4%}, hidden but told {int((kept & (v[:, HIDDEN] > 0.99)).sum())}"
        )
    return temperature


def document_of(fitted: Classifier) -> dict[str, Any]:
    """Return a whole classifier as JSON stores it."""
    return {
        "features": list(NAMES),
        "seen": list(SEEN),
        "spots": SPOTS,
        "context": list(context.NAMES),
        "classes": list(CLASSES),
        "alone": nets_of(fitted.alone),
        "among": nets_of(fitted.among),
        "temperature": round(fitted.temperature, 3),
        "sure": fitted.sure,
        "doubt": list(fitted.doubt),
    }


def nets_of(told: shipped.NetEnsemble) -> dict[str, Any]:
    """Return nets as JSON stores them."""
    return {
        "centre": rounded(told.centre, 4),
        "spread": rounded(told.spread, 4),
        "nets": [
            [{"weights": rounded(weights, 3), "bias": rounded(bias, 4)} for weights, bias in net]
            for net in told.nets
        ],
    }


def rounded(values: Real, places: int) -> Any:
    """Return numbers as JSON stores them, with this many digits after the point."""
    return np.round(values.astype(float), places).tolist()


if __name__ == "__main__":
    main()
