"""The bench's laser scanner: vectorised ray casting against walls and circles."""

from __future__ import annotations

from dataclasses import dataclass
from math import radians
from typing import TYPE_CHECKING

import numpy as np

from tangy_sim.device_simulator.floor import Floor, FloorPose

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Real = NDArray[np.float64]

NEAR = 0.05  # m: range of a cloth over the scanner
COVERED = 0.92  # share of beams that a cloth covers


@dataclass(frozen=True)
class Lidar:
    """A scanner at the robot's centre: beam i has the bearing `first` + i * `step`.

    Angles are in rad, counter-clockwise. `noise` is the standard deviation of a range and
    `farthest` the maximum range, in m.
    """

    beams: int = 360
    first: float = radians(-135)
    step: float = radians(0.75)
    noise: float = 0.01
    farthest: float = 30.0

    def scan(self, pose: FloorPose, floor: Floor, random: np.random.Generator) -> Real:
        """Return ranges (beams,) in m; inf without a return."""
        angles = pose.heading + self.first + self.step * np.arange(self.beams, dtype=np.float64)
        ranges = cast(pose.x, pose.y, angles, floor.walls, floor.circles)
        ranges += random.normal(0.0, self.noise, self.beams)
        ranges[ranges > self.farthest] = np.inf
        return np.maximum(ranges, 0.02)

    def covered(self, pose: FloorPose, floor: Floor, random: np.random.Generator) -> Real:
        """Return ranges (beams,) in m with a cloth over the scanner."""
        ranges = self.scan(pose, floor, random)
        caught = np.arange(self.beams) < COVERED * self.beams
        ranges[caught] = NEAR + random.normal(0.0, 0.002, int(caught.sum()))
        return ranges


def cast(x: float, y: float, angles: Real, segments: Real, circles: Real) -> Real:
    """Return the distances along rays to the first obstacle.

    Args:
        x: position of the scanner, in m.
        y: position of the scanner, in m.
        angles: directions of the rays (n,) in rad.
        segments: walls (s, 4): x and y of both ends.
        circles: round obstacles (c, 3): x, y and radius.

    Returns:
        Distances (n,) in m; inf without a hit. Inside a circle, rays hit its inner side.
    """
    dx, dy = np.cos(angles)[:, None], np.sin(angles)[:, None]
    ax, ay = segments[:, 0] - x, segments[:, 1] - y
    bx, by = segments[:, 2] - segments[:, 0], segments[:, 3] - segments[:, 1]
    across = dx * by - dy * bx
    with np.errstate(divide="ignore", invalid="ignore"):
        far = (ax * by - ay * bx) / across
        along = (ax * dy - ay * dx) / across
    hit = (far > 0) & (along >= -1e-12) & (along <= 1 + 1e-12)
    nearest: Real = np.where(hit, far, np.inf).min(axis=1, initial=np.inf)
    if len(circles):
        cx, cy, radius = circles[:, 0] - x, circles[:, 1] - y, circles[:, 2]
        middle = dx * cx + dy * cy
        inside = radius**2 - (cx**2 + cy**2 - middle**2)
        half = np.sqrt(np.maximum(inside, 0.0))
        far = np.where(middle > half, middle - half, middle + half)
        hit = (inside >= 0) & (far > 0)
        nearest = np.minimum(nearest, np.where(hit, far, np.inf).min(axis=1))
    return nearest
