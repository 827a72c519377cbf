"""How well signs are seen in infrared pictures: recall and false requests, by the sign's size.

Run by hand: `python -m tests.bench.requests [--tune] [--sequences N]`. Sequences of 12 pictures
are drawn (see `tests.hw.signs`): four seats, half of them with a sign up; discs, squares, bars,
lamps, rings, polygons, trapezia and glints on the table and around it; reflections in the table;
a hand over a part of some signs; blur and noise. The limits of `triangles` were set with
`--tune`; quoted figures use other seeds. A fifth of the sequences has no signs at all.

`frame`: seats with a sign up in a single picture. `asks`: those that persistence accepts, from the
fifth picture on. `false`: pictures in which it accepts a request that nobody makes.
"""

from __future__ import annotations

import argparse
import time
from collections import Counter

import cv2

from tangy_hw.perception.requests.signs import SignWatcher, TableView
from tangy_profiles.room import load_room
from tests.hw.signs import CORNERS, SEATS, sequence

TUNED, QUOTED = 0, 500_000
SIZES = ((10, 14), (14, 20), (20, 30), (30, 40), (40, 50))
FULL = 4  # pictures until persistence should have accepted a sign


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--tune", action="store_true", help="the seeds that limits are set on")
    parser.add_argument("--sequences", type=int, default=60, help="of each size")
    asked = parser.parse_args()
    cv2.setNumThreads(1)
    view = TableView(CORNERS, load_room(), len(SEATS))
    first = TUNED if asked.tune else QUOTED
    print("size, px   signs   frame    asks   hidden   pictures   false   CPU ms")
    whole: Counter[str] = Counter()
    for place, size in enumerate(SIZES):
        count: Counter[str] = Counter()
        spent = 0.0
        for number in range(asked.sequences):
            watcher = SignWatcher(view)
            seed = first + 1000 * place + number
            for scene in sequence(seed, sizes=size, signs=number % 5 > 0):
                began = time.process_time()
                asks = watcher.look(scene.image)
                spent += time.process_time() - began
                true = {seat + 1 for seat in scene.asking}
                covered = {seat + 1 for seat in scene.hidden}
                count["pictures"] += 1
                count["false"] += bool(set(asks) - true)
                count["signs"] += len(true)
                count["frame"] += len(true & set(watcher.found))
                count["hidden"] += len(covered)
                count["hidden seen"] += len(covered & set(watcher.found))
                if scene.since >= FULL:
                    count["could ask"] += len(true)
                    count["asks"] += len(true & set(asks))
        _row(f"{size[0]}-{size[1]}", count, spent)
        if size[0] >= 14:
            whole += count
    _row("14-50", whole, 0.0)


def _row(name: str, count: Counter[str], spent: float) -> None:
    frame, asks = count["frame"] / count["signs"], count["asks"] / count["could ask"]
    hidden = count["hidden seen"] / max(1, count["hidden"])
    false = count["false"] / count["pictures"]
    cpu = f"{spent / count['pictures'] * 1000:8.1f}" if spent else ""
    print(
        f"{name:<10}{count['signs']:>6}{frame:>8.3f}{asks:>8.3f}{hidden:>9.3f}"
        f"{count['pictures']:>11}{false:>8.4f} {cpu}"
    )


if __name__ == "__main__":
    main()
