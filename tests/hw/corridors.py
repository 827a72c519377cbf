"""Logs of corridors: rings, and two rings that share one, driven by wheels that may slip."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tangy_hw.device_protocols import Pose, Twist
from tangy_hw.navigation.mapping import PlacedScan, sparse
from tangy_hw.navigation.poses import compose
from tests.hw.raycast import Segments, Wheels, driven, look, sides, tour

Way = list[tuple[float, float]]


class Slip(NamedTuple):
    """A stretch on which the wheels count nothing: its begin and length as shares of the way."""

    begins: float
    lasts: float


def ring(side: float, width: float, beyond: float) -> tuple[Segments, Way]:
    """Return the walls of a square corridor, and a way around it that ends beyond its start."""
    near, far = width / 2, side - width / 2
    walls = sides((0, 0, side, side), (width, width, side - width, side - width))
    start = (side / 2, near)
    around = [(far, near), (far, far), (near, far), (near, near), start]
    return walls, [start, *around, (min(side / 2 + beyond, far), near)]


def two_rings(side: float, width: float) -> tuple[Segments, Way]:
    """Return the walls of two square corridors that share one, and a way around both."""
    near, far, middle = width / 2, side - width / 2, side - width / 2
    right = 2 * side - width - near
    walls = sides(
        (0, 0, 2 * side - width, side),
        (width, width, side - width, side - width),
        (side, width, 2 * side - 2 * width, side - width),
    )
    first = [(middle, near), (middle, far), (near, far), (near, near), (middle, near)]
    second = [(right, near), (right, far), (middle, far), (middle, near), (middle, side / 2)]
    return walls, first + second


def cluttered(side: float, width: float, seed: int) -> tuple[Segments, Way]:
    """Return a square corridor with objects along its outer walls, and a way around it."""
    walls, way = ring(side, width, 4.0)
    rng = np.random.default_rng(seed + 1000)
    deep, boxes = 0.25, []
    for _ in range(int(side * 1.2)):
        wall, at, long = rng.integers(4), rng.uniform(1.0, side - 1.8), rng.uniform(0.3, 0.9)
        along = (
            (at, 0.0, at + long, deep),
            (at, side - deep, at + long, side),
            (0.0, at, deep, at + long),
            (side - deep, at, side, at + long),
        )
        boxes.append(along[int(wall)])
    return np.vstack((walls, sides(*boxes))), way


def logged(walls: Segments, way: Way, seed: int, slip: Slip | None = None) -> list[PlacedScan]:
    """Drive along a way; return the scans at the poses from the wheels' odometry."""
    return [one for one, _ in driven_log(walls, way, seed, slip)]


def driven_log(
    walls: Segments,
    way: Way,
    seed: int,
    slip: Slip | None = None,
    *,
    scale: float = 1.01,
    noise: float = 0.03,
) -> list[tuple[PlacedScan, Pose]]:
    """Drive along a way; return scans at the wheels' poses, and the true poses."""
    rng = np.random.default_rng(seed)
    pose = start = Pose(*way[0], 0.0)
    wheels, commands, scans = Wheels(rng, scale, noise), tour(way), []
    true: dict[int, Pose] = {}
    for number, twist in enumerate(commands):
        pose, at = driven(pose, twist, 0.1), number / len(commands)
        slips = slip is not None and slip.begins <= at < slip.begins + slip.lasts
        counted = wheels.turn(Twist(0.0, twist.turn) if slips else twist, 0.1)
        if number % 6 == 0:
            scans.append(PlacedScan(look(walls, pose, rng), compose(start, counted)))
            true[id(scans[-1])] = pose
    return [(one, true[id(one)]) for one in sparse(scans)]
