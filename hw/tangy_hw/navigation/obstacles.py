"""Obstacles that the laser sees and the map lacks: moved chairs, bags, people."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tangy_hw.device_protocols import Pose, Scan
from tangy_hw.navigation.likelihood import NEAREST
from tangy_hw.navigation.occupancy import OccupancyMap
from tangy_hw.navigation.poses import (
    IDENTITY,
    Floats,
    bearings,
    compose,
    endpoints,
    transform_points,
    wrap,
)

OFF = 0.1  # metres from everything on the map beyond which a return is an obstacle
FIDGETING = 0.2  # the same where seated people move their feet
AWAY, AWAY_SHARE = 0.15, 0.02  # the same for a single beam: metres, and share of the range
RANGE = 6.0  # metres beyond which beams are too inaccurate for planning
SURE = 3  # scans that must hit a cell before it counts
KEPT = 30.0  # seconds after which an unseen obstacle is dropped
BEHIND = 0.15  # metres that a beam must pass behind an obstacle to clear it


class Obstacles:
    """Remembers obstacles for a while, in the cells of a map."""

    def __init__(self, map_: OccupancyMap, laser: Pose = IDENTITY) -> None:
        self._map = map_
        self._laser = laser
        # keep people beside a wall or table apart from it, as far as scan and pose are accurate
        self._new = map_.seen_distance > np.where(map_.feet, FIDGETING, OFF)
        self._hits = np.zeros(map_.shape, dtype=np.int16)
        self._age = np.zeros(map_.shape, dtype=np.float32)
        self._first = np.zeros(map_.shape, dtype=np.float32)  # when its first scan hit the cell
        self._clock = 0.0

    def see(self, pose: Pose, scan: Scan, dt: float) -> None:
        """Add a scan from a pose, `dt` s after the previous one."""
        there = self._hits > 0
        self._clock += dt
        if there.any():
            self._age[there] += dt
            self._clear(pose, scan)
        points = transform_points(endpoints(scan, RANGE, self._laser, NEAREST), pose)
        rows, columns = self._map.cells_of(points)
        hit = np.zeros(self._map.shape, dtype=np.bool_)
        hit[rows, columns] = True
        hit &= self._new
        self._first[hit & (self._hits == 0)] = self._clock
        self._hits[hit] = np.minimum(self._hits[hit] + 1, 20)
        self._age[hit] = 0.0

    def among(self, points: Floats) -> NDArray[np.bool_]:
        """Return whether each of the points (n, 2) is off everything on the map."""
        return self._map.values_at(points, self._new, outside=True)

    def unmapped(self, pose: Pose, scan: Scan) -> NDArray[np.bool_]:
        """Return for each beam (n,) whether its return is off everything on the map."""
        met = scan.ranges < scan.farthest
        ranges, angles = np.where(met, scan.ranges, 0.0), bearings(scan)
        ends = np.column_stack((ranges * np.cos(angles), ranges * np.sin(angles)))
        ends = transform_points(ends, compose(pose, self._laser))
        # points outside the map are seen through a door
        away = self._map.values_at(ends, self._map.seen_distance, outside=0.0)
        fidgets = self._map.values_at(ends, self._map.feet, outside=False)
        beyond = AWAY + AWAY_SHARE * ranges
        return met & (away > np.where(fidgets, np.maximum(beyond, FIDGETING), beyond))

    def _clear(self, pose: Pose, scan: Scan) -> None:
        """Remove old obstacles, and those that a beam passes."""
        rows, columns = np.nonzero(self._hits)
        map_, eye = self._map, compose(pose, self._laser)
        x = map_.origin[0] + (columns + 0.5) * map_.resolution - eye.x
        y = map_.origin[1] + (rows + 0.5) * map_.resolution - eye.y
        beam = np.round((wrap(np.arctan2(y, x) - eye.heading) - scan.first) / scan.step)
        seen = (beam >= 1) & (beam < len(scan.ranges) - 1)
        beam = np.where(seen, beam, 1).astype(np.intp)
        # the neighbouring beams must pass too: the obstacle may be thin
        past = np.minimum(scan.ranges[beam], scan.ranges[beam - 1])
        past = np.minimum(past, scan.ranges[beam + 1])
        past = np.where(np.isfinite(past), past, 0.0)  # a beam without a return says nothing
        gone = seen & (past > np.hypot(x, y) + BEHIND)
        self._hits[rows[gone], columns[gone]] -= 2
        self._hits[(self._hits < 0) | (self._age > KEPT)] = 0

    @property
    def points(self) -> Floats:
        """Points of obstacles that are not on the map (n, 2)."""
        rows, columns = np.nonzero(self._hits >= SURE)
        middles = np.column_stack((columns + 0.5, rows + 0.5))
        return middles * self._map.resolution + self._map.origin

    @property
    def seconds(self) -> Floats:
        """Seconds since each of the `points` (n,) was first seen, without being gone since."""
        return np.asarray(self._clock - self._first[self._hits >= SURE])

    def forget(self) -> None:
        """Forget all obstacles, for example if the estimated pose was wrong."""
        self._hits[:] = 0
