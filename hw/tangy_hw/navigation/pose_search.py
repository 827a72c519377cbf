"""Looking for the places at which a scan fits, when nothing is known of where it was taken.

Very many poses are tried in a field so broad that one of them is near enough; the best are then
moved about in the fine field until they fit as well as they can. Without that, a right place would
lose against a wrong one only because no pose was tried quite there.
"""

from __future__ import annotations

import numpy as np
from numpy.random import Generator

from tangy_hw.navigation.likelihood import LikelihoodField
from tangy_hw.navigation.occupancy import OccupancyMap
from tangy_hw.navigation.particles import anywhere, resample
from tangy_hw.navigation.poses import Floats, wrap

BROAD = 0.3  # metres: the width of the broad field
GLANCE = 12.0  # the exponent with which that one judges
NUDGES = ((0.2, 0.15), (0.1, 0.07), (0.05, 0.03), (0.02, 0.015))  # metres and radians
EACH = 16  # poses that are tried around each place with each of the nudges


class Search:
    """Proposes places on a map."""

    def __init__(self, map_: OccupancyMap, field: LikelihoodField, rng: Generator) -> None:
        """Begin.

        Args:
            map_: where places are looked for.
            field: the fine field of that map.
            rng: where chance comes from.
        """
        self._fine = field
        self._broad = LikelihoodField(map_, BROAD)
        self._free = map_.free_points()
        self._resolution = map_.resolution
        self._rng = rng

    def places(self, points: Floats, count: int, tried: int) -> tuple[Floats, Floats]:
        """Return poses (count, 3) at which beams fit, and how well (count,), 0 to 1.

        Args:
            points: where the beams end (n, 2), in the robot's frame.
            count: how many poses are returned; several may be of one place.
            tried: how many are tried first.
        """
        drawn = anywhere(self._free, self._resolution, tried, self._rng)
        some = points[:: max(1, len(points) // 60)]
        weights = self._broad.scores(drawn, some) ** GLANCE
        poses = resample(drawn, weights / weights.sum(), count, self._rng)
        scores = self._fine.scores(poses, points)
        for metres, radians in NUDGES:
            poses, scores = self._nudged(poses, scores, points, metres, radians)
        return poses, scores

    def anywhere(self, count: int) -> Floats:
        """Return poses (count, 3) anywhere on the free floor."""
        return anywhere(self._free, self._resolution, count, self._rng)

    def _nudged(
        self, poses: Floats, scores: Floats, points: Floats, metres: float, radians: float
    ) -> tuple[Floats, Floats]:
        """Return the best of some poses around each, or that pose itself."""
        nudges = self._rng.normal(0.0, 1.0, (len(poses), EACH, 3)) * (metres, metres, radians)
        around = (poses[:, None] + nudges).reshape(-1, 3)
        fits = self._fine.scores(around, points).reshape(len(poses), EACH)
        best = fits.argmax(axis=1)
        chosen = around.reshape(len(poses), EACH, 3)[np.arange(len(poses)), best]
        better = fits.max(axis=1) > scores
        moved = np.where(better[:, None], chosen, poses)
        moved[:, 2] = wrap(moved[:, 2])
        return moved, np.maximum(fits.max(axis=1), scores)
