"""Global search for the poses at which a scan fits a map.

Very many poses are scored with a few beams in a field so broad that some of them are near enough.
The best of them are refined, in narrower fields and with more beams, and fewer are kept each time.
Without this, the right place would often be dropped because no tried pose was close enough: in a
building of 400 m2, of 100 searches of 3,000 poses only 15 would find it, instead of 40.
"""

from __future__ import annotations

from math import pi
from typing import NamedTuple

import numpy as np
from numpy.random import Generator

from tangy_hw.device_protocols import Pose
from tangy_hw.navigation.likelihood import LikelihoodField, evenly
from tangy_hw.navigation.occupancy import OccupancyMap
from tangy_hw.navigation.particles import around
from tangy_hw.navigation.poses import IDENTITY, Floats, wrap

BROAD, MIDDLE = 0.8, 0.3  # metres: sigmas of the broader fields
BROAD_CELLS, MIDDLE_CELLS = 4, 2  # cells of the map, in a row, that are one cell of these fields
GLANCED, GUESSED, LOOKED = 20, 30, 60  # beams used in the broad, the middle and the fine field
GUESSES, CHOICES = 20, 65  # one of so many tried poses is refined in the middle and the fine field
SHARE_NEAR = 0.2  # share of the poses that are tried near the last estimate
NEAR = (0.5, 0.5, pi)  # m, m, rad: their standard deviations


class Nudges(NamedTuple):
    """Poses tried around each pose: how many, and their standard deviations in m and rad."""

    each: int
    metres: float
    radians: float


COARSE, FINE = Nudges(8, 0.3, 0.15), Nudges(8, 0.15, 0.1)
FINEST = (Nudges(12, 0.05, 0.03), Nudges(12, 0.02, 0.015))


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
        self._middle = LikelihoodField(map_, MIDDLE, MIDDLE_CELLS)
        self._broad = LikelihoodField(map_, BROAD, BROAD_CELLS)
        # in random order, so that neighbours in the list are places anywhere on the floor
        self._free = rng.permutation(map_.free_points())
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
        far = self.anywhere(tried - len(near))
        poses = np.vstack((near, far))
        glance, guess, look = (evenly(points, beams) for beams in (GLANCED, GUESSED, LOOKED))
        scores = self._broad.scores(poses, glance)
        poses = _best(poses, scores, max(count, tried // GUESSES))
        poses, scores = nudged(poses, guess, self._middle, COARSE, self._rng)
        poses = _best(poses, scores, max(count, tried // CHOICES))
        poses, scores = nudged(poses, look, self._fine, FINE, self._rng)
        poses = _best(poses, scores, count)
        for nudges in FINEST:
            poses, _ = nudged(poses, look, self._fine, nudges, self._rng)
        return poses, self._fine.scores(poses, points)

    def anywhere(self, count: int) -> Floats:
        """Return random poses (count, 3) on the free floor."""
        first = int(self._rng.integers(len(self._free)))
        places = self._free[first : first + count]
        if len(places) < count:
            chosen = np.arange(first, first + count)
            places = self._free.take(chosen, axis=0, mode="wrap")
        return np.column_stack((places, self._rng.uniform(-pi, pi, count)))


def nudged(
    poses: Floats, points: Floats, field: LikelihoodField, nudges: Nudges, rng: Generator
) -> tuple[Floats, Floats]:
    """Return the best of random poses around each of the poses (n, 3), or itself; with scores."""
    deviations = nudges.metres, nudges.metres, nudges.radians
    tried = np.empty((len(poses), nudges.each + 1, 3))
    tried[:, 0] = poses
    offs = rng.standard_normal((len(poses), nudges.each, 3))
    offs *= deviations
    np.add(poses[:, None], offs, out=tried[:, 1:])
    every = tried.reshape(-1, 3)
    fits = field.scores(every, points)
    best = fits.reshape(len(poses), nudges.each + 1).argmax(axis=1)
    best += np.arange(0, len(every), nudges.each + 1)
    chosen = every.take(best, axis=0)
    chosen[:, 2] = wrap(chosen[:, 2])
    return chosen, fits.take(best)


def _best(poses: Floats, scores: Floats, count: int) -> Floats:
    """Return the `count` poses with the highest scores."""
    if count >= len(poses):
        return poses
    return poses.take(np.argpartition(-scores, count)[:count], axis=0)
