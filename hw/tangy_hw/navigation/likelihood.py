"""Likelihood fields: how well a scan taken at a pose fits a map (Thrun et al., ch. 6.4)."""

from __future__ import annotations

from functools import lru_cache
from math import ceil
from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import label

from tangy_hw.device_protocols import Pose, Scan
from tangy_hw.navigation.occupancy import FREE, OCCUPIED, OccupancyMap
from tangy_hw.navigation.poses import Floats, lengths, transform_points

Field: TypeAlias = NDArray[np.float32]

BEAMS = 60
NEAREST = 0.15  # metres: nearer returns come from the robot itself
COVERED = 0.4  # share of beams that end this near if the scanner is covered
SIGMA = 0.12  # metres between a beam's end and its wall, with the errors of map and pose
FLOOR = 0.1  # likelihood of a beam that ends in free space, for example at a person
SHORT = 0.3  # metres that a beam must pass beyond a wall to contradict it
LEVELS = 255  # steps in which a field is stored
IN_CACHE = 1 << 15  # beams that are scored at a time, so that their numbers stay in the cache
WALL = 15  # connected cells that make a wall; chairs have fewer, and move


def evenly(points: Floats, most: int) -> Floats:
    """Return at most so many of the points (n, 2), evenly spaced."""
    if len(points) <= most:
        return points
    return points.take(_spaced(len(points), most), axis=0)


@lru_cache(maxsize=1024)
def _share(count: int) -> Field:
    """Return the share of each of `count` beams in a score, for each level of the field."""
    return np.full(count, (1 - FLOOR) / LEVELS / max(count, 1), dtype=np.float32)


@lru_cache(maxsize=1024)
def _spaced(count: int, most: int) -> NDArray[np.intp]:
    return np.linspace(0, count - 1, most).round().astype(np.intp)


def covered(scan: Scan) -> bool:
    """Return whether the scanner is covered, so that the scan says nothing about the room."""
    return bool((scan.ranges < NEAREST).mean() > COVERED)


class ScanLikelihood(NamedTuple):
    """How well the beams of a scan support a pose.

    `score` is the mean fit of the beams that the map explains or contradicts, and `share` the share
    of these beams. The others end in front of everything on the map, at an obstacle, and say
    nothing about the pose.
    """

    score: float
    share: float


class LikelihoodField:
    """Likelihood that a beam ends in a cell: 1 at a wall, `FLOOR` far from walls."""

    def __init__(self, map_: OccupancyMap, sigma: float = SIGMA, coarse: int = 1) -> None:
        """Draw the field.

        Args:
            map_: the map.
            sigma: m between a beam's end and its wall.
            coarse: cells of the map, in a row, that are one cell of the field. A broad field loses
                little with larger cells, and stays in the processor's cache.
        """
        self.map = map_
        self._resolution = map_.resolution * coarse
        self._scale = 1.0 / self._resolution
        self._origin = 1.0 - np.asarray(map_.origin) * self._scale
        rows, columns = (
            np.minimum(np.arange(0, size, coarse) + coarse // 2, size - 1) for size in map_.shape
        )
        middles = np.ix_(rows, columns)
        near = np.exp(-0.5 * (map_.seen_distance[middles] / sigma) ** 2)
        # one more cell on each side represents everything outside; in bytes, so that more of the
        # field stays in the processor's cache
        self._field = np.pad(np.round(near * LEVELS).astype(np.uint8), 1)
        self._flat = self._field.ravel()
        self._free = np.pad((map_.cells == FREE)[middles], 1, constant_values=False).ravel()
        self._walls = np.pad(_walls(map_)[middles], 1, constant_values=False).ravel()

    def scores(self, poses: Floats, points: Floats) -> Floats:
        """Return the mean likelihood (0 to 1) of the beams at each of the poses (m, 3).

        Args:
            poses: x, y, heading.
            points: ends of the beams (n, 2) in the robot's frame.
        """
        count = len(points)
        share = _share(count)
        at_once = max(1, IN_CACHE // max(count, 1))
        turned, ends = self._transforms(poses), _homogeneous(points)
        if 0 < len(poses) <= at_once:
            return np.asarray(FLOOR + (self._levels(turned @ ends) @ share).astype(np.float64))
        found = [
            self._levels(turned[:, first : first + at_once] @ ends) @ share
            for first in range(0, len(poses), at_once)
        ]
        return FLOOR + np.concatenate(found, dtype=np.float64) if found else np.zeros(0)

    def beams(self, poses: Floats, points: Floats) -> Field:
        """Return the likelihood of each beam at each pose (m, n)."""
        levels = self._levels(self._transforms(poses) @ _homogeneous(points))
        return np.asarray(FLOOR + np.float32((1 - FLOOR) / LEVELS) * levels)

    def _transforms(self, poses: Floats) -> Field:
        """Return the transforms (2, m, 3) of homogeneous points at poses to columns and rows.

        In cells, single precision: .1 mm on a map of 100 m.
        """
        heading = poses[:, 2].astype(np.float32)
        turned = np.empty((2, len(poses), 3), dtype=np.float32)
        cos, sin = turned[1, :, 1], turned[1, :, 0]
        np.multiply(np.cos(heading), self._scale, out=cos)
        np.multiply(np.sin(heading), self._scale, out=sin)
        turned[0, :, 0] = cos
        np.negative(sin, out=turned[0, :, 1])
        turned[:, :, 2] = self._cells(poses[:, :2]).T
        return turned

    def _levels(self, cells: Field) -> Field:
        """Return the field's levels at columns and rows (2, m, n), which it overwrites."""
        return self._flat.take(self._index(cells), mode="wrap").astype(np.float32)

    def tells(self, pose: Pose, points: Floats, share: float) -> bool:
        """Return whether the map explains or contradicts at least this share of beams (n, 2).

        Faster than `evidence`, because it seldom has to follow the beams.
        """
        explained = self.beams(np.asarray([pose]), points)[0] > 2 * FLOOR
        return explained.mean() >= share or self.evidence(pose, points).share >= share

    def evidence(self, pose: Pose, points: Floats) -> ScanLikelihood:
        """Return how well beams with ends `points` (n, 2), in the robot's frame, support a pose."""
        if not len(points):
            return ScanLikelihood(0.0, 0.0)
        fits = self.beams(np.asarray([pose]), points)[0]
        # an unexplained beam that crosses a wall contradicts the pose
        through = fits < 0.5
        through[through] = self._crosses(pose, points[through])
        tells = through | (fits > 2 * FLOOR)
        if not tells.any():
            return ScanLikelihood(0.0, 0.0)
        return ScanLikelihood(
            float(np.where(through, FLOOR, fits)[tells].mean()), float(tells.mean())
        )

    def _crosses(self, pose: Pose, points: Floats) -> NDArray[np.bool_]:
        """Return whether each beam crosses a wall more than `SHORT` before its end."""
        far = lengths(points) / self._resolution  # in cells, as the steps are
        most = far - SHORT / self._resolution
        steps = np.ones((max(0, ceil(most.max(initial=0.0))), 2), dtype=np.float32)
        steps[:, 0] = np.arange(len(steps))
        lines = np.empty((2, 2, len(points)), dtype=np.float32)
        here = np.array([pose.x, pose.y])
        lines[:, 0] = ((transform_points(points, pose) - here) / np.maximum(far, 1e-9)[:, None]).T
        lines[:, 0] *= self._scale
        lines[:, 1] = self._cells(here)[:, None]
        walls = self._walls.take(self._index(steps @ lines), mode="wrap")
        return np.asarray((walls & (steps[:, :1] < most)).any(axis=0))

    def on_floor(self, poses: Floats) -> NDArray[np.bool_]:
        """Return whether each of the poses (m, 3) lies on free floor."""
        return np.asarray(self._free.take(self._index(self._cells(poses[:, :2]).T)))

    def _cells(self, points: Floats) -> Floats:
        """Return the columns and rows, with fractions, of points (..., 2)."""
        return points * self._scale + self._origin

    def _index(self, cells: NDArray[Any]) -> NDArray[np.intp]:
        """Return the index of each cell (2, ...); the nearest one for those outside.

        Overwrites the cells.
        """
        rows, columns = self._field.shape
        for values, most in zip(cells, (columns - 1, rows - 1), strict=True):
            np.clip(values, 0, most, out=values)
        column, index = cells.astype(np.int32)
        index *= np.int32(columns)
        index += column
        return np.asarray(index.astype(np.intp))  # `take` converts others, and more slowly


def _homogeneous(points: Floats) -> Field:
    """Return points (n, 2) as columns (3, n)."""
    ends = np.ones((3, len(points)), dtype=np.float32)
    ends[:2] = points.T
    return ends


def _walls(map_: OccupancyMap) -> NDArray[np.bool_]:
    """Return which cells belong to a group of occupied cells large enough to be a wall."""
    parts, _ = label(map_.cells == OCCUPIED, np.ones((3, 3)))
    sizes = np.bincount(parts.ravel())
    sizes[0] = 0
    return np.asarray((sizes >= WALL)[parts])
