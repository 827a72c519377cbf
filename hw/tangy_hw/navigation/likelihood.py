"""Likelihood fields: how well a scan, taken at a pose, fits a map (Thrun et al., ch. 6.4)."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from tangy_hw.devices import Pose, Scan
from tangy_hw.navigation.occupancy import FREE, OccupancyMap
from tangy_hw.navigation.poses import HERE, Floats, endpoints

Field: TypeAlias = NDArray[np.float32]

BEAMS = 60
SIGMA = 0.12  # metres by which a beam's end and the wall it hit are apart, map and pose included
FLOOR = (
    0.1  # what a beam counts at least that ends where the map has nothing: somebody stands there
)


def thin(scan: Scan, farthest: float, laser: Pose = HERE, beams: int = BEAMS) -> Floats:
    """Return the ends of some beams (n, 2) spread evenly over those that met something."""
    points = endpoints(scan, farthest, laser)
    if len(points) <= beams:
        return points
    return points[np.linspace(0, len(points) - 1, beams).round().astype(np.intp)]


class LikelihoodField:
    """For each cell, how likely a beam ends there: 1 at a wall, `FLOOR` far from any."""

    def __init__(self, map_: OccupancyMap, sigma: float = SIGMA) -> None:
        self.map = map_
        near = np.exp(-0.5 * (map_.seen_distance / sigma) ** 2)
        inner = (FLOOR + (1 - FLOOR) * near).astype(np.float32)
        # one more cell on each side stands for all that lies outside
        self._field = np.pad(inner, 1, constant_values=np.float32(FLOOR))
        self._flat: Field = self._field.ravel()
        self._width = self._field.shape[1]
        self._free = np.pad(map_.cells == FREE, 1, constant_values=False)

    def scores(self, poses: Floats, points: Floats) -> Floats:
        """Return how well beams fit at each of the poses (m, 3): the mean over them, 0 to 1.

        Args:
            poses: x, y, heading.
            points: the ends of beams (n, 2), in the robot's frame.
        """
        return np.asarray(self.beams(poses, points).mean(axis=1), dtype=np.float64)

    def beams(self, poses: Floats, points: Floats) -> Field:
        """Return how likely each beam is at each pose (m, n)."""
        scale = 1.0 / self.map.resolution
        # in cells, in single precision: a tenth of a millimetre on a map of a hundred metres
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

    def on_floor(self, poses: Floats) -> NDArray[np.bool_]:
        """Say of each pose (m, 3) whether it lies where the map is free."""
        rows, columns = self._free.shape
        column = (poses[:, 0] - self.map.origin[0]) / self.map.resolution + 1
        row = (poses[:, 1] - self.map.origin[1]) / self.map.resolution + 1
        column = np.clip(column, 0, columns - 1).astype(np.intp)
        return np.asarray(self._free[np.clip(row, 0, rows - 1).astype(np.intp), column])
