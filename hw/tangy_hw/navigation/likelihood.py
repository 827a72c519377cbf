"""Likelihood fields: how well a scan taken at a pose fits a map (Thrun et al., ch. 6.4)."""

from __future__ import annotations

from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt, label

from tangy_hw.device_protocols import Pose, Scan
from tangy_hw.navigation.occupancy import FREE, OCCUPIED, OccupancyMap
from tangy_hw.navigation.poses import IDENTITY, Floats, endpoints, lengths, transform_points

Field: TypeAlias = NDArray[np.float32]

BEAMS = 60
NEAREST = 0.15  # metres: nearer returns come from the robot itself
COVERED = 0.4  # share of beams that end this near if the scanner is covered
SIGMA = 0.12  # metres between a beam's end and its wall, with the errors of map and pose
FLOOR = 0.1  # likelihood of a beam that ends in free space, for example at a person
SHORT = 0.3  # metres that a beam must pass beyond a wall to contradict it
MOST_STEPS = 60  # steps of the search along a beam
WALL = 15  # connected cells that make a wall; chairs have fewer, and move


def thin(scan: Scan, farthest: float, laser: Pose = IDENTITY, beams: int = BEAMS) -> Floats:
    """Return the ends (n, 2), in m, of at most `beams` beams with a return, evenly spaced."""
    points = endpoints(scan, farthest, laser, NEAREST)
    if len(points) <= beams:
        return points
    return points[np.linspace(0, len(points) - 1, beams).round().astype(np.intp)]


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

    def __init__(self, map_: OccupancyMap, sigma: float = SIGMA) -> None:
        self.map = map_
        near = np.exp(-0.5 * (map_.seen_distance / sigma) ** 2)
        inner = (FLOOR + (1 - FLOOR) * near).astype(np.float32)
        # one more cell on each side represents everything outside
        self._field = np.pad(inner, 1, constant_values=np.float32(FLOOR))
        self._flat: Field = self._field.ravel()
        self._width = self._field.shape[1]
        self._free = np.pad(map_.cells == FREE, 1, constant_values=False).ravel()
        self._room = np.pad(_room(map_), 1, mode="edge").ravel()

    def scores(self, poses: Floats, points: Floats) -> Floats:
        """Return the mean likelihood (0 to 1) of the beams at each of the poses (m, 3).

        Args:
            poses: x, y, heading.
            points: ends of the beams (n, 2) in the robot's frame.
        """
        return np.asarray(self.beams(poses, points).mean(axis=1), dtype=np.float64)

    def beams(self, poses: Floats, points: Floats) -> Field:
        """Return the likelihood of each beam at each pose (m, n)."""
        scale = 1.0 / self.map.resolution
        # in cells, single precision: .1 mm on a map of 100 m
        c = (np.cos(poses[:, 2]) * scale).astype(np.float32)[:, None]
        s = (np.sin(poses[:, 2]) * scale).astype(np.float32)[:, None]
        x = ((poses[:, 0] - self.map.origin[0]) * scale + 1).astype(np.float32)[:, None]
        y = ((poses[:, 1] - self.map.origin[1]) * scale + 1).astype(np.float32)[:, None]
        px, py = points[:, 0].astype(np.float32), points[:, 1].astype(np.float32)
        column = c * px - s * py
        column += x
        row = s * px + c * py
        row += y
        rows, columns = self._field.shape
        np.clip(column, 0, columns - 1, out=column)
        np.clip(row, 0, rows - 1, out=row)
        index = row.astype(np.int32) * np.int32(self._width) + column.astype(np.int32)
        return np.asarray(self._flat.take(index))

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
        """Return whether each beam crosses a wall; step by the distance to the nearest wall."""
        far = lengths(points)
        reach = far - SHORT
        ends = transform_points(points, pose)
        unit = (ends - np.array([pose.x, pose.y])) / np.maximum(far, 1e-9)[:, None]
        gone = np.zeros(len(points))
        crossed = np.zeros(len(points), dtype=np.bool_)
        left = np.flatnonzero(reach > 0)
        for _ in range(MOST_STEPS):
            if not len(left):
                break
            at = unit[left] * gone[left, None] + np.array([pose.x, pose.y])
            room = self._room[self._index(at)]
            hit = room < self.map.resolution
            crossed[left[hit]] = True
            gone[left] += np.maximum(room, self.map.resolution / 2)
            left = left[~hit & (gone[left] < reach[left])]
        return crossed

    def _index(self, points: Floats) -> NDArray[np.intp]:
        cells = (points - np.array(self.map.origin)) / self.map.resolution + 1
        rows, columns = self._field.shape
        column = np.clip(cells[:, 0], 0, columns - 1).astype(np.intp)
        return np.asarray(np.clip(cells[:, 1], 0, rows - 1).astype(np.intp) * columns + column)

    def on_floor(self, poses: Floats) -> NDArray[np.bool_]:
        """Return whether each of the poses (m, 3) lies on free floor."""
        return np.asarray(self._free[self._index(poses[:, :2])])


def _room(map_: OccupancyMap) -> Field:
    """Return the distance in m to the nearest group of occupied cells large enough to be a wall."""
    parts, _ = label(map_.cells == OCCUPIED, np.ones((3, 3)))
    sizes = np.bincount(parts.ravel())
    sizes[0] = 0
    walls = (sizes >= WALL)[parts]
    if not walls.any():
        return np.full(map_.shape, max(map_.size), dtype=np.float32)
    return np.asarray(distance_transform_edt(~walls, sampling=map_.resolution), dtype=np.float32)
