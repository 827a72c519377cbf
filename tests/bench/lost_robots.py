"""How often a lost robot counts as found at a wrong place, and how soon it is found.

Run by hand: `python -m tests.bench.lost_robots [--tries N] [--seed N]`. A robot starts anywhere in
the simulated room, without a pose, and drives from point to point with a scan each `--seconds`.
With `TANGY_LASER_LOG` it also starts anywhere in the log of `tests.bench.localisation`, with scans
`--metres` apart. Each try ends `LOOKS` scans after the robot first counted as found, or after
`FAR`. With `--still` it only moves to and fro, by some 10 cm, with `--turning` it turns on
the spot in the room. It is wrong if it counts as found with an error of more than `OFF`.
"""

from __future__ import annotations

import argparse
import os
import time
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from math import hypot, pi

import numpy as np

from tangy_hw.device_protocols import Pose, Twist
from tangy_hw.navigation.localisation import Localisation
from tangy_hw.navigation.navigator import SPIN
from tangy_hw.navigation.occupancy import OccupancyMap, map_of_room
from tangy_hw.navigation.poses import relative_pose
from tangy_profiles.room import load_room
from tests.bench.localisation import FOLDER, Moment, apart, building, logged, moments
from tests.hw.raycast import Wheels, driven, look, room_sides, tour

ROOM = load_room()
FAR = 40.0  # m
OFF = 1.0  # m
LOOKS = 20  # scans after the first at which it counts as found
TO_AND_FRO, STILL_LOOKS = 0.12, 80  # m, and scans, of a robot that hardly moves


@dataclass
class Outcome:
    """The results of robots that did not know where they were."""

    tries: int = 0
    wrong: int = 0
    """Robots that were first found at a wrong place."""
    never: int = 0
    looks: int = 0
    wrong_looks: int = 0
    scans: list[float] = field(default_factory=list)
    """Scans until a robot counted as found."""
    metres: list[float] = field(default_factory=list)
    took: list[float] = field(default_factory=list)
    """Processor time for each scan, in s."""

    def follow(self, localisation: Localisation, way: Iterable[Moment]) -> None:
        """Let a robot find its place on a drive."""
        self.tries += 1
        gone, since, before = 0.0, 0, None
        for number, moment in enumerate(way, 1):
            if before is not None:
                gone += hypot(moment.truth.x - before.x, moment.truth.y - before.y)
            before = moment.truth
            begun = time.process_time()
            estimate = localisation.update(moment.odometry, moment.scan)
            self.took.append(time.process_time() - begun)
            off = hypot(estimate.pose.x - before.x, estimate.pose.y - before.y)
            self.looks += 1
            self.wrong_looks += estimate.found and off > OFF
            if estimate.found and not since:
                self.scans.append(number)
                self.metres.append(gone)
                self.wrong += off > OFF
            since += estimate.found or since > 0
            if since > LOOKS or (gone > FAR and not since):
                break
        self.never += not since

    def row(self) -> str:
        """Return a row that sums them up."""
        scans = np.percentile(self.scans or [np.nan], [50, 95])
        metres = np.percentile(self.metres or [np.nan], [50, 95])
        return (
            f"wrong {self.wrong} of {self.tries}, never found {self.never}; "
            f"looks wrong {self.wrong_looks} of {self.looks}; "
            f"found after {scans[0]:.0f} scans (p95 {scans[1]:.0f}), "
            f"{metres[0]:.1f} m (p95 {metres[1]:.1f}); "
            f"ms median {np.median(self.took) * 1e3:.1f}, "
            f"p95 {np.percentile(self.took, 95) * 1e3:.1f}, max {max(self.took) * 1e3:.0f}"
        )


def drives(rng: np.random.Generator, seconds: float) -> Iterator[Moment]:
    """Yield the measurements of a robot that drives from point to point in the simulated room."""
    sides = room_sides(ROOM)
    points = [(float(rng.uniform(0.8, 9.2)), float(rng.uniform(0.8, 4.2)))]
    while len(points) < 20:
        x, y = float(rng.uniform(0.8, 9.2)), float(rng.uniform(0.8, 4.2))
        if hypot(x - points[-1][0], y - points[-1][1]) > 2.0:
            points.append((x, y))
    true, wheels = Pose(*points[0], 0.0), Wheels(rng)
    turned = float(rng.uniform(-pi, pi))  # the wheels count from another heading
    wheels.pose = Pose(3.0, -2.0, turned)
    each = round(seconds / 0.1)
    for number, twist in enumerate(tour(points)):
        if number % each == 0:
            yield Moment(wheels.pose, look(sides, true, rng), true)
        true = driven(true, twist, 0.1)
        wheels.turn(twist, 0.1)


def staying(rng: np.random.Generator, there: Twist, back: Twist, dt: float) -> Iterator[Moment]:
    """Yield the measurements of a robot that moves to and fro at one place in the room."""
    sides, wheels = room_sides(ROOM), Wheels(rng)
    true = Pose(*(float(rng.uniform(*ends)) for ends in ((0.8, 9.2), (0.8, 4.2), (-pi, pi))))
    for number in range(STILL_LOOKS):
        yield Moment(wheels.pose, look(sides, true, rng), true)
        twist = back if number % 2 else there
        true = driven(true, twist, dt)
        wheels.turn(twist, dt)


def near_each_other(way: Sequence[Moment], first: int) -> list[Moment]:
    """Alternate two moments of a drive, .1 to .3 m and less than .3 rad apart; [] without any."""
    one = way[first]
    for other in way[first + 1 :]:
        step = relative_pose(one.truth, other.truth)
        if hypot(step.x, step.y) > 0.25 or abs(step.heading) > 0.25:
            break
        if hypot(step.x, step.y) > 0.11:
            return [one, other] * (STILL_LOOKS // 2)
    return []


def turning(tries: int, seed: int) -> Outcome:
    """Let robots turn on the spot in the simulated room, as they do to find their place."""
    found, map_, twist = Outcome(), map_of_room(ROOM), Twist(0.0, SPIN)
    for one in range(tries):
        rng = np.random.default_rng([seed, one])
        found.follow(Localisation(map_, rng), staying(rng, twist, twist, 0.2))
    return found


def still(folder: str | None, tries: int, seed: int) -> Outcome:
    """Let robots that hardly move find their place in the room, or in a log's building."""
    found = Outcome()
    map_ = building(folder) if folder else map_of_room(ROOM)
    for one in range(tries):
        rng = np.random.default_rng([seed, one])
        if folder:
            log = moments(logged(folder))[1::2]
            way = near_each_other(log, int(rng.integers(len(log) * 4 // 5)))
        else:
            step = Twist(TO_AND_FRO, 0.0), Twist(-TO_AND_FRO, 0.0)
            way = list(staying(rng, *step, 1.0))
        if way:
            found.follow(Localisation(map_, rng), way)
    return found


def in_room(map_: OccupancyMap, seconds: float, tries: int, seed: int) -> Outcome:
    """Let robots find their place in the simulated room."""
    found = Outcome()
    for one in range(tries):
        rng = np.random.default_rng([seed, one])
        found.follow(Localisation(map_, rng), drives(rng, seconds))
    return found


def in_log(folder: str, metres: float, tries: int, seed: int) -> Outcome:
    """Let robots find their place in the log's building."""
    found, map_ = Outcome(), building(folder)
    way = apart(moments(logged(folder))[1::2], metres)
    for one in range(tries):
        rng = np.random.default_rng([seed, one])
        first = int(rng.integers(len(way) * 4 // 5))
        found.follow(Localisation(map_, rng), way[first:])
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--tries", type=int, default=200)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--seconds", type=float, nargs="*", default=[0.1, 0.5, 1.0, 2.5])
    parser.add_argument("--metres", type=float, nargs="*", default=[0.1, 0.5, 1.0, 2.0])
    parser.add_argument("--still", action="store_true")
    parser.add_argument("--turning", action="store_true")
    options = parser.parse_args()
    if options.turning:
        print(turning(options.tries, options.seed).row(), flush=True)
        return
    if options.still:
        for place in (None, os.environ.get(FOLDER)):
            print(still(place, options.tries, options.seed).row(), flush=True)
        return
    map_ = map_of_room(ROOM)
    for seconds in options.seconds:
        row = in_room(map_, seconds, options.tries, options.seed).row()
        print(f"room, each {seconds:g} s: {row}", flush=True)
    if (folder := os.environ.get(FOLDER)) is None:
        return
    for metres in options.metres:
        row = in_log(folder, metres, options.tries, options.seed).row()
        print(f"log, {metres:g} m apart: {row}", flush=True)


if __name__ == "__main__":
    main()
