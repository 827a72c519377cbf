"""Draws maps from scans: cells along a beam are free, the cell at its end is occupied.

A cell is occupied if enough of the beams that reached it ended in it (counting model; Thrun et al.,
ch. 9).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import ceil, hypot

import cv2
import numpy as np

from tangy_hw.device_protocols import Pose, Scan
from tangy_hw.navigation.occupancy import FREE, OCCUPIED, UNKNOWN, OccupancyMap
from tangy_hw.navigation.poses import Floats, endpoints, relative_pose, transform_points
from tangy_profiles.errors import TangyError

REACH = 20.0  # metres of a beam that count
SHARE = 0.25  # of the beams that reached an occupied cell ended there
MOST_CELLS = 40_000_000
SHIFT = 4  # fractional bits of polygon corners


class MapError(TangyError):
    """A map that cannot be drawn; one sentence."""


@dataclass(frozen=True)
class PlacedScan:
    """A scan and the pose of the laser."""

    scan: Scan
    pose: Pose


def sparse(
    scans: Iterable[PlacedScan], metres: float = 0.1, radians: float = 0.1
) -> list[PlacedScan]:
    """Drop scans within `metres` m and `radians` rad of the last kept one."""
    kept: list[PlacedScan] = []
    for one in scans:
        if kept:
            step = relative_pose(kept[-1].pose, one.pose)
            if hypot(step.x, step.y) < metres and abs(step.heading) < radians:
                continue
        kept.append(one)
    return kept


class MapMaker:
    """Builds a map scan by scan."""

    def __init__(
        self, left: float, near: float, right: float, far: float, resolution: float
    ) -> None:
        """Start with an empty map of an area in m.

        Raises:
            MapError: the area is too large.
        """
        columns, rows = ceil((right - left) / resolution), ceil((far - near) / resolution)
        if rows * columns > MOST_CELLS:
            raise MapError(
                f"A map of {right - left:.0f} x {far - near:.0f} m at {resolution} m has too many "
                "cells; take a coarser --resolution."
            )
        self.resolution = resolution
        self.origin = (left, near)
        self._hits = np.zeros((rows, columns), dtype=np.uint16)
        self._visits = np.zeros((rows, columns), dtype=np.uint16)
        self._seen = np.zeros((rows, columns), dtype=np.uint8)

    def add(self, scan: Scan, pose: Pose) -> None:
        """Add a scan taken at a pose of the laser."""
        ranges = np.where(np.isfinite(scan.ranges), scan.ranges, 0.0)
        known = (scan.ranges > 0) & (scan.ranges < scan.farthest)
        met = known & (scan.ranges < REACH)
        # the cells that a beam passed, without the one it ended in
        through = np.where(met, np.maximum(ranges - self.resolution, 0), np.where(known, REACH, 0))
        angles = scan.first + scan.step * np.arange(len(ranges))
        free = np.column_stack((through * np.cos(angles), through * np.sin(angles)))
        corners = self._cells(transform_points(np.vstack(([[0.0, 0.0]], free)), pose))
        low = np.maximum(np.floor(corners.min(axis=0)).astype(int), 0)
        high = np.minimum(np.ceil(corners.max(axis=0)).astype(int) + 2, self._seen.shape[::-1])
        if (high <= low).any():
            return
        part = np.s_[low[1] : high[1], low[0] : high[0]]
        seen = self._seen[part]
        seen[:] = 0
        # OpenCV pixels have their centres at integers
        drawn = np.round((corners - low - 0.5) * (1 << SHIFT)).astype(np.int32)
        cv2.fillPoly(seen, [drawn.reshape(-1, 1, 2)], 1, shift=SHIFT)
        ends = np.floor(self._cells(transform_points(endpoints(scan, REACH), pose))).astype(int)
        on = ((ends >= 0) & (ends < self._seen.shape[::-1])).all(axis=1)
        ends = np.unique(ends[on], axis=0)
        self._hits[ends[:, 1], ends[:, 0]] += 1
        self._visits[part] += seen
        inside = ((ends >= low) & (ends < high)).all(axis=1)
        twice = np.zeros(len(ends), dtype=np.uint16)
        twice[inside] = self._seen[ends[inside, 1], ends[inside, 0]]
        self._visits[ends[:, 1], ends[:, 0]] += 1 - twice

    def _cells(self, points: Floats) -> Floats:
        return np.asarray((points - np.array(self.origin)) / self.resolution)

    def map(self, share: float = SHARE) -> OccupancyMap:
        """Return the map; cells are occupied from this share (0 to 1) of beams on."""
        cells = np.full(self._hits.shape, UNKNOWN, dtype=np.int8)
        cells[self._visits > 0] = FREE
        cells[(self._hits > 0) & (self._hits >= share * self._visits)] = OCCUPIED
        return OccupancyMap(cells, self.resolution, self.origin)


def extent(scans: Sequence[PlacedScan], margin: float = 0.5) -> tuple[float, float, float, float]:
    """Return left, near, right and far of everything that the scans saw, in m."""
    ends = [transform_points(endpoints(one.scan, REACH), one.pose) for one in scans]
    places = np.array([(one.pose.x, one.pose.y) for one in scans])
    every = np.vstack((*ends, places))
    left, near = np.floor(every.min(axis=0) - margin)
    right, far = np.ceil(every.max(axis=0) + margin)
    return float(left), float(near), float(right), float(far)


def map_of_scans(scans: Sequence[PlacedScan], resolution: float = 0.05) -> OccupancyMap:
    """Draw the map of scans with known poses, with cells of `resolution` m.

    Raises:
        MapError: there are no scans, or the map would be too large.
    """
    if not scans:
        raise MapError("There are no scans to draw a map of.")
    maker = MapMaker(*extent(scans), resolution)
    for one in scans:
        maker.add(one.scan, one.pose)
    return maker.map()
