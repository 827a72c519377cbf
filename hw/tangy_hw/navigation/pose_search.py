"""Global search for the poses at which a scan fits a map.

Very many poses are scored in a likelihood field so broad that some of them are near enough; the
best are then refined in the fine field. Without refinement, the right place could lose against a
wrong one only because no tried pose was close enough.
"""

from __future__ import annotations

from math import pi

import numpy as np
from numpy.random import Generator

from tangy_hw.device_protocols import Pose
from tangy_hw.navigation.likelihood import LikelihoodField
from tangy_hw.navigation.occupancy import OccupancyMap
from tangy_hw.navigation.particles import anywhere, around, resample
from tangy_hw.navigation.poses import IDENTITY, Floats, wrap

BROAD = 0.3  # metres: sigma of the broad field
GLANCED = 60  # beams used until the poses are refined
GLANCE = 12.0  # exponent on its scores
SHARE_NEAR = 0.2  # share of the poses that are tried near the last estimate
NEAR = (0.5, 0.5, pi)  # m, m, rad: their standard deviations
NUDGES = ((0.2, 0.15), (0.1, 0.07), (0.05, 0.03), (0.02, 0.015))  # deviations: metres, radians
EACH = 12  # poses tried around each pose, for each of the nudges


class Search:
    """Proposes poses on a map."""

    def __init__(self, map_: OccupancyMap, field: LikelihoodField, rng: Generator) -> None:
        """Start.

        Args:
            map_: the map to search.
            field: the fine likelihood field of that map.
            rng: the random generator.
        """
        self._fine = field
        self._broad = LikelihoodField(map_, BROAD)
        self._free = map_.free_points()
        self._resolution = map_.resolution
        self._rng = rng

    def places(
        self, points: Floats, count: int, tried: int, last: Pose | None
    ) -> tuple[Floats, Floats]:
        """Return poses (count, 3) at which beams fit, and their scores (count,), 0 to 1.

        Args:
            points: ends of the beams (n, 2) in the robot's frame.
            count: number of poses to return; several may be at the same place.
            tried: number of poses to try first.
            last: the last estimated pose, if it was right lately: some poses are tried around it,
                with any heading, as if the wheels had missed a turn.
        """
        near = around(last or IDENTITY, NEAR, int(SHARE_NEAR * tried) if last else 0, self._rng)
        far = anywhere(self._free, self._resolution, tried - len(near), self._rng)
        drawn = np.vstack((near, far))
        some = points[:: max(1, len(points) // GLANCED)]
        weights = self._broad.scores(drawn, some) ** GLANCE
        poses = resample(drawn, weights / weights.sum(), count, self._rng)
        scores = self._fine.scores(poses, some)
        for metres, radians in NUDGES:
            poses, scores = self._nudged(poses, scores, some, metres, radians)
        return poses, self._fine.scores(poses, points)

    def anywhere(self, count: int) -> Floats:
        """Return random poses (count, 3) on the free floor."""
        return anywhere(self._free, self._resolution, count, self._rng)

    def _nudged(
        self, poses: Floats, scores: Floats, points: Floats, metres: float, radians: float
    ) -> tuple[Floats, Floats]:
        """Return the best of random poses around each pose, or the pose itself."""
        nudges = self._rng.normal(0.0, 1.0, (len(poses), EACH, 3)) * (metres, metres, radians)
        nudged = (poses[:, None] + nudges).reshape(-1, 3)
        fits = self._fine.scores(nudged, points).reshape(len(poses), EACH)
        best = fits.argmax(axis=1)
        chosen = nudged.reshape(len(poses), EACH, 3)[np.arange(len(poses)), best]
        better = fits.max(axis=1) > scores
        moved = np.where(better[:, None], chosen, poses)
        moved[:, 2] = wrap(moved[:, 2])
        return moved, np.maximum(fits.max(axis=1), scores)
