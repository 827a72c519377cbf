"""Drives of a wide robot, its scanner ahead of the middle and turned, in a room of walls.

Run by hand: `python -m tests.bench.wide_drives --drives 100`. The robot is .8 by .6 m, its scanner
.25 m ahead and turned by 10 degrees; a round one of .25 m drives the same paths for comparison.
Nobody is there. A touch is a point of its edge beyond a wall, or over the table. No real robot
took part.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import hypot, pi, radians
from statistics import median

import numpy as np
from numpy.random import Generator

from tangy_hw.device_protocols import STILL, Odometry, Pose
from tangy_hw.navigation.limits import MotionLimits
from tangy_hw.navigation.navigator import Navigator
from tangy_hw.navigation.planning import RADIUS, inflate
from tangy_hw.navigation.poses import IDENTITY, compose, transform_points
from tests.bench.people_simulation import MAP, ROOM, TICK, WALLS, followed
from tests.hw.raycast import Wheels, driven, look

CORNERS = ((0.4, 0.3), (-0.4, 0.3), (-0.4, -0.3), (0.4, -0.3))
WIDE = replace(MotionLimits(), radius=0.5, corners=CORNERS)
ROUND = MotionLimits()
ASIDE = Pose(0.25, 0.0, radians(10))
LONGEST = 120.0  # s
FREE = 0.6  # metres between a start or a goal and everything on the map


@dataclass(frozen=True)
class Driven:
    """One drive: whether it arrived and touched anything, and the robot's own errors of its place.

    `off` are these errors in m, one a tick.
    """

    arrived: bool
    touched: bool
    off: tuple[float, ...]


def way(rng: Generator) -> tuple[Pose, Pose]:
    """Draw a start and a goal with room for the wide robot, 3 m apart at least."""
    costs = inflate(MAP, None, RADIUS + FREE - 0.32)
    while True:
        x, gx = rng.uniform(0.5, ROOM.width - 0.5, 2)
        y, gy = rng.uniform(0.5, ROOM.depth - 0.5, 2)
        if hypot(gx - x, gy - y) > 3 and np.isfinite([costs.at(x, y), costs.at(gx, gy)]).all():
            return Pose(x, y, rng.uniform(-pi, pi)), Pose(gx, gy, rng.uniform(-pi, pi))


def drive(number: int, seed: int, limits: MotionLimits, laser: Pose) -> Driven:
    """Drive one path with a robot of some body."""
    rng = np.random.default_rng([seed, 2000, number])
    true, goal = way(rng)
    navigator = Navigator(MAP, rng, true, limits=limits, laser=laser)
    wheels, twist, time, touched = Wheels(rng), STILL, 0.0, False
    off: list[float] = []
    navigator.go(goal)
    while time < LONGEST and navigator.state not in ("arrived", "failed"):
        scan = look(WALLS, compose(true, laser), rng)
        twist = followed(twist, navigator.tick(Odometry(wheels.pose, twist), scan, TICK))
        wheels.turn(twist, TICK)
        true, time = driven(true, twist, TICK), time + TICK
        touched |= touches(true, limits)
        if navigator.estimate is not None:
            pose = navigator.estimate.pose
            off.append(hypot(pose.x - true.x, pose.y - true.y))
    return Driven(navigator.state == "arrived", touched, tuple(off))


def touches(pose: Pose, limits: MotionLimits) -> bool:
    """Return whether any point of a robot's edge is beyond a wall or over the table."""
    if limits.corners:
        ends = np.array([*limits.corners, limits.corners[0]])
        share = np.linspace(0, 1, 17)[:, None]
        edge = np.vstack([a + share * (b - a) for a, b in pairwise(ends)])
    else:
        angles = np.linspace(-pi, pi, 72)
        edge = limits.radius * np.column_stack((np.cos(angles), np.sin(angles)))
    x, y = transform_points(edge, pose).T
    left, near, right, far = ROOM.table
    outside = min(x.min(), y.min()) < 0 or x.max() > ROOM.width or y.max() > ROOM.depth
    return bool(outside or ((x > left) & (x < right) & (y > near) & (y < far)).any())


def row(name: str, found: Sequence[Driven]) -> str:
    """Return a row that sums up drives."""
    off = np.concatenate([one.off for one in found])
    return (
        f"{name:<6} touched {sum(one.touched for one in found)} of {len(found)}; arrived "
        f"{sum(one.arrived for one in found)}; its place off by {median(off):.3f} m, "
        f"p95 {np.percentile(off, 95):.3f}"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--drives", type=int, default=100)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    for name, limits, laser in (("wide", WIDE, ASIDE), ("round", ROUND, IDENTITY)):
        found = [drive(number, options.seed, limits, laser) for number in range(options.drives)]
        print(row(name, found), flush=True)


if __name__ == "__main__":
    main()
