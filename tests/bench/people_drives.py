"""Drives among people in a simulated room: whom the robot touches, whether and when it arrives.

Run by hand: `python -m tests.bench.people_drives [SCENE ...] --drives 60`. The geometry is that of
`people_simulation`. A touch counts by how it began: the robot drove, with the person ahead
(ahead) or not (behind); or a person walked into a robot that stood. No real person or base
took part. A row has two smallest gaps: at any time, and (driven) while the robot drove towards a
person who stood.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from math import inf
from statistics import median

import numpy as np

from tests.bench.people_scenes import SCENES
from tests.bench.people_simulation import MAP, ROOM, Drive

__all__ = ["MAP", "ROOM", "drives"]


def drives(scene: str, count: int, seed: int = 0, first: int = 0) -> list[Drive]:
    """Drive a number of times through a scene, from the seed's `first` drive on."""
    number = list(SCENES).index(scene)
    return [
        SCENES[scene](np.random.default_rng([seed, number, one])).run()
        for one in range(first, first + count)
    ]


def row(scene: str, found: Sequence[Drive]) -> str:
    """Return a row that sums up a scene."""
    arrived = [drive.time for drive in found if drive.arrived]
    told = sum(drive.told == "blocked" and not drive.arrived for drive in found)
    near = min((drive.nearest for drive in found), default=inf)
    left = min((drive.driven_to for drive in found), default=inf)
    fast = [speed for drive in found for speed in drive.near] or [0.0]
    ahead = [t.speed for drive in found for t in drive.touches if t.kind == "ahead"]
    behind = [t.speed for drive in found for t in drive.touches if t.kind == "behind"]
    slow = f" at {median(behind):.2f} m/s" if behind else ""
    speeds = f" at {max(ahead):.2f} m/s" if ahead else ""
    return (
        f"{scene:<10} touched ahead {sum(d.count('ahead') for d in found):2}{speeds}, "
        f"behind {sum(d.count('behind') for d in found):2}{slow}; "
        f"walked into it {sum(d.count('stood') for d in found):2}; "
        f"nearest {near:5.2f} m, driven {left:5.2f} m; arrived {len(arrived):2} of {len(found)} "
        f"({told} told as blocked) in {median(arrived) if arrived else inf:4.1f} s; "
        f"silent for {max((d.silent for d in found), default=0.0):.1f} s; "
        f"within 1 m {np.mean(fast):.2f} m/s, p95 {np.percentile(fast, 95):.2f}"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("scenes", nargs="*", help=f"of {', '.join(SCENES)}; default: all")
    parser.add_argument("--drives", type=int, default=60)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--first", type=int, default=0, help="the seed's first drive to run")
    options = parser.parse_args()
    for scene in options.scenes or SCENES:
        print(row(scene, drives(scene, options.drives, options.seed, options.first)), flush=True)


if __name__ == "__main__":
    main()
