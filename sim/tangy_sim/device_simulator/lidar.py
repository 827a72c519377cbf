"""The bench's laser scanner: rays cast against walls and round things, all beams at once."""

from __future__ import annotations

from dataclasses import dataclass
from math import radians
from typing import TYPE_CHECKING

import numpy as np

from tangy_sim.device_simulator.floor import Floor, FloorPose

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Real = NDArray[np.float64]

NEAR = 0.05  # m at which a cloth over the scanner is seen
COVERED = 0.92  # share of the beams that a cloth catches


@dataclass(frozen=True)
class Lidar:
    """A scanner at the robot's middle: beam i looks at `first` + i * `step` from straight ahead.

    Angles are radians, counter-clockwise. `noise` is the standard deviation of a range and
    `farthest` the longest one, in m.
    """

    beams: int = 360
    first: float = radians(-135)
    step: float = radians(0.75)
    noise: float = 0.01
    farthest: float = 30.0

    def scan(self, pose: FloorPose, floor: Floor, random: np.random.Generator) -> Real:
        """Measure all around; what nothing is hit by is inf."""
        angles = pose.heading + self.first + self.step * np.arange(self.beams, dtype=np.float64)
        ranges = cast(pose.x, pose.y, angles, floor.walls, floor.circles)
        ranges += random.normal(0.0, self.noise, self.beams)
        ranges[ranges > self.farthest] = np.inf
        return np.maximum(ranges, 0.02)

    def covered(self, pose: FloorPose, floor: Floor, random: np.random.Generator) -> Real:
        """Measure with a cloth over the scanner."""
        ranges = self.scan(pose, floor, random)
        caught = np.arange(self.beams) < COVERED * self.beams
        ranges[caught] = NEAR + random.normal(0.0, 0.002, int(caught.sum()))
        return ranges


def cast(x: float, y: float, angles: Real, segments: Real, circles: Real) -> Real:
    """Return how far rays go from a place until they hit something.

    Args:
        x: where the scanner stands, in m.
        y: where the scanner stands, in m.
        angles: (n,) their directions in radians.
        segments: (s, 4) x and y of both ends of straight things.
        circles: (c, 3) x, y and radius of round things.

    Returns:
        (n,) metres; inf if nothing is hit. Of a circle around the place the inside is seen.
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
