"""How exactly the robot is localised in Freiburg's building 079, on a log of a real robot.

Run by hand: `TANGY_LASER_LOG=DIR python -m tests.bench.localisation`, where DIR holds
freiburg-079.log.gz. The poses in that log were corrected by a mapping program and serve as the
truth; the map is drawn from every second scan, and the other scans localise the robot.
The log has the wheels' steps as lengths without sign: driving backwards reads as forwards.
Their signs are restored where the corrected poses went backwards.
"""

from __future__ import annotations

import argparse
import os
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from math import hypot
from pathlib import Path

import numpy as np

from tangy_hw.device_protocols import Pose, Scan
from tangy_hw.navigation.localisation import Localisation
from tangy_hw.navigation.mapping import PlacedScan, map_of_scans, sparse
from tangy_hw.navigation.occupancy import OccupancyMap
from tangy_hw.navigation.poses import IDENTITY, compose, relative_pose, wrap
from tangy_hw.navigation.scan_log import LoggedScan, read_log
from tangy_hw.navigation.slip_detection import SlipDetector

FOLDER = "TANGY_LASER_LOG"
MISSED = 1.4  # radians of a turn that slipping wheels leave out once
AROUND = 1  # steps before and after: the sign of their corrected sum is the direction


@dataclass(frozen=True, eq=False)
class Moment:
    """The robot's measurements at one moment, and its true place."""

    odometry: Pose
    scan: Scan
    truth: Pose


@cache
def logged(folder: str) -> list[LoggedScan]:
    """Read the log."""
    return read_log(Path(folder) / "freiburg-079.log.gz")


def moments(log: Sequence[LoggedScan], *, restored: bool = True) -> list[Moment]:
    """Return the log with the wheels' own odometry."""
    forward = np.array([relative_pose(a.pose, b.pose).x for a, b in pairwise(log)])
    around = np.convolve(forward, np.ones(2 * AROUND + 1), "same")
    odometry = IDENTITY
    found = [Moment(odometry, log[0].scan, log[0].pose)]
    for (before, one), back in zip(pairwise(log), around < 0, strict=True):
        step = relative_pose(before.pose, one.wheels or one.odometry)
        if restored and back:
            step = Pose(-step.x, -step.y, step.heading)
        odometry = compose(odometry, step)
        found.append(Moment(odometry, one.scan, one.pose))
    return found


@cache
def building(folder: str, part: int = 2) -> OccupancyMap:
    """Draw the map from every second scan."""
    every = logged(folder)[::part]
    return map_of_scans(sparse(PlacedScan(one.scan, one.pose) for one in every))


def errors(
    localisation: Localisation, way: Sequence[Moment]
) -> Iterator[tuple[float, float, float]]:
    """Localise along a way; yield the errors in metres and radians, and the time taken in s."""
    for moment in way:
        begun = time.process_time()
        pose = localisation.update(moment.odometry, moment.scan).pose
        took = time.process_time() - begun
        off = hypot(pose.x - moment.truth.x, pose.y - moment.truth.y)
        yield off, abs(wrap(pose.heading - moment.truth.heading)), took


def apart(way: Sequence[Moment], metres: float) -> list[Moment]:
    """Return moments of a drive, this many metres apart."""
    found, gone = [way[0]], 0.0
    for before, one in pairwise(way):
        gone += hypot(one.truth.x - before.truth.x, one.truth.y - before.truth.y)
        if gone >= metres:
            found.append(one)
            gone = 0.0
    return found


def unturned(way: Sequence[Moment], seed: int) -> list[Moment]:
    """Return a drive on which the wheels count `MISSED` less of a turn, somewhere in the middle."""
    middle = int(np.random.default_rng(seed).integers(len(way) // 5, len(way) * 3 // 5))
    found = [way[0]]
    for number, (before, one) in enumerate(pairwise(way)):
        step = relative_pose(before.odometry, one.odometry)
        if number == middle:
            step = step._replace(heading=wrap(step.heading - MISSED))
        found.append(Moment(compose(found[-1].odometry, step), one.scan, one.truth))
    return found


def row_apart(map_: OccupancyMap, ways: Mapping[int, Sequence[Moment]]) -> str:
    """Sum up the errors of localisation on the drive of each seed, and how often it is wrong.

    It is wrong when it counts as found and is off by more than a metre.
    """
    off, took, wrong = [], [], 0
    for seed, way in ways.items():
        localisation = Localisation(map_, np.random.default_rng(seed), way[0].truth)
        for moment in way:
            begun = time.process_time()
            estimate = localisation.update(moment.odometry, moment.scan)
            took.append(time.process_time() - begun)
            pose, truth = estimate.pose, moment.truth
            off.append(hypot(pose.x - truth.x, pose.y - truth.y))
            wrong += estimate.found and off[-1] > 1.0
    median, high = np.percentile(off, [50, 95])
    return (
        f"median {median:.3f} m, p95 {high:.3f}; found and off by a metre: {wrong} of {len(off)}; "
        f"ms p95 {np.percentile(took, 95) * 1e3:.1f}, p99 {np.percentile(took, 99) * 1e3:.1f}"
    )


def doubts(localisation: Localisation, way: Sequence[Moment]) -> int:
    """Follow a drive; return after how many scans the robot considers itself lost."""
    return sum(localisation.update(one.odometry, one.scan).lost for one in way)


def kidnapped(map_: OccupancyMap, way: Sequence[Moment], seed: int) -> int | None:
    """Move the robot elsewhere without telling it; return after how many scans it is found again.

    It is found when it stays within half a metre of the truth for twenty scans.
    """
    rng = np.random.default_rng(seed)
    first = then = int(rng.integers(len(way) - 500))
    last = way[first + 59]
    while hypot(last.truth.x - way[then].truth.x, last.truth.y - way[then].truth.y) < 4:
        then = int(rng.integers(len(way) - 500))
    localisation = Localisation(map_, np.random.default_rng(seed + 1000), way[first].truth)
    for _ in errors(localisation, way[first : first + 60]):
        pass
    moved = [
        Moment(
            compose(last.odometry, relative_pose(way[then].odometry, one.odometry)),
            one.scan,
            one.truth,
        )
        for one in way[then : then + 420]
    ]
    right = 0
    for number, (off, turned, _) in enumerate(errors(localisation, moved)):
        right = right + 1 if off < 0.5 and turned < 0.35 else 0
        if right >= 20:
            return number - 19
    return None


def disagreements(way: Sequence[Moment]) -> list[float]:
    """Return by how many metres wheels and laser disagree after each scan."""
    detector = SlipDetector()
    return [detector.update(moment.odometry, moment.scan) for moment in way]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--first", type=int, default=0, help="the first seed")
    parser.add_argument("--carried", type=int, default=10)
    options = parser.parse_args()
    seeds = range(options.first, options.first + options.seeds)
    folder = os.environ[FOLDER]
    log, map_ = logged(folder), building(folder)
    whole, raw = moments(log), moments(log, restored=False)
    for name, way in (("restored", whole), ("as logged", raw)):
        slips = np.array(disagreements(way))
        print(f"wheels {name}: disagree by {slips.max():.2f} m at most, above .3 m "
              f"in {np.mean(slips > 0.3):.1%} of scans")  # fmt: skip
    way = whole[1::2]
    for seed in seeds:
        localisation = Localisation(map_, np.random.default_rng(seed), way[0].truth)
        rows = np.array(list(errors(localisation, way)))
        median, high, most = np.percentile(rows[:, 0], [50, 95, 100])
        print(f"seed {seed}: median {median:.3f} m, p95 {high:.3f}, most {most:.2f}; "
              f"{np.percentile(rows[:, 1], 95):.3f} rad p95; "
              f"{rows[:, 2].mean() * 1e3:.2f} ms")  # fmt: skip
    for metres in (0.1, 0.5, 1.0, 2.0):
        far = apart(way, metres)
        print(f"scans {metres:.1f} m apart: {row_apart(map_, dict.fromkeys(seeds, far))}")
        missed = {seed: unturned(far, seed) for seed in seeds}
        print(f"  a turn not counted:  {row_apart(map_, missed)}", flush=True)
    localisation = Localisation(map_, np.random.default_rng(0), way[0].truth)
    print(f"lost without having been carried off: {doubts(localisation, way)} of {len(way)} scans")
    found = [
        kidnapped(map_, way, seed) for seed in range(options.first, options.first + options.carried)
    ]
    print("carried off, found after so many scans:", found)


if __name__ == "__main__":
    main()
