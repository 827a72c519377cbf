"""Write rendered frames of cards as pictures, with labels.json beside them.

Run by hand: `python -m tests.bench.card_frames DIR --frames 20 --seed 3`, to look at them, or count
with `tangy read-card --bench DIR`.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path

import cv2

from tangy_profiles.activity import load_activity
from tangy_sim.rendering.card_frames import CardCamera


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--frames", type=int, default=20)
    parser.add_argument("--seed", type=int, default=3)
    options = parser.parse_args()
    activity = load_activity("bingo")
    columns = len(activity.deck.columns)
    options.folder.mkdir(parents=True, exist_ok=True)
    labels = []
    camera = CardCamera(activity.deck, title=activity.title)
    for number, frame in enumerate(camera.frames(options.seed, options.frames)):
        name = f"frame-{number:04}.png"
        cv2.imwrite(str(options.folder / name), frame.picture)

        def places(mask: int) -> list[list[int]]:
            cells = range(activity.deck.rows * columns)
            return [list(divmod(cell, columns)) for cell in cells if mask >> cell & 1]

        told = {"marked": places(frame.marked), "hidden": places(frame.unknown())}
        labels.append({"file": name, "card": frame.card, **told})
    (options.folder / "labels.json").write_text(json.dumps(labels), encoding="utf-8")


if __name__ == "__main__":
    main()
