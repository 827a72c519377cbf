"""Where the robot is: adaptive Monte Carlo localisation with recovery (Thrun et al., ch. 8.3).

Particles are moved by the wheels, weighed by how well the scan fits a likelihood field, and
resampled. Two averages of that fit, a fast and a slow one, tell a robot that was carried off: while
the fast one is much the lower, some particles are drawn anew, where the scan fits.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot, sqrt

import numpy as np
from numpy.random import Generator

from tangy_hw.devices import Pose, Scan
from tangy_hw.navigation.likelihood import LikelihoodField, covered, thin
from tangy_hw.navigation.occupancy import OccupancyMap
from tangy_hw.navigation.particles import (
    MOST,
    anywhere,
    around,
    likeliest,
    move,
    needed,
    resample,
)
from tangy_hw.navigation.poses import HERE, Floats, between, compose, wrap

LOST = 0.85  # of the usual fit: below this the robot is probably not where it thinks
DOUBT = 0.95  # of the usual fit: below this a scan says little about what is usual
MOVED, TURNED = 0.1, 0.1  # metres and radians after which the particles are weighed again
FAST, SLOW = 0.1, 0.002  # shares of a new value in the averages of the fit
USUAL, BELIEF = (
    0.75,
    10,
)  # the fit at a right pose before any scan, and how many scans that is worth
SHARPNESS = 30.0  # the exponent that makes a weight of the fit
START = (0.1, 0.1, 0.05)  # metres, metres, radians: how exactly a start is told
FARTHEST = 20.0  # metres beyond which beams are not used
FIRST_GLOBAL = 20_000  # poses that are tried first when nothing is known
TRIED = 2000  # poses that are tried for each renewal while lost
GLANCE = 10.0  # the exponent with which the first of all looks judges
GENTLE = 0.1  # of the sharpness, while several places are possible
WIDE = 120  # beams that count while several places are possible: few tell them apart
UNSETTLED, SETTLING = 0.5, 20  # metres of spread, and scans without it until one place is believed
FEWEST_BEAMS = 10  # that must have met something
SEEN = 0.2  # share of the beams that something on the map must explain, or contradict
BLIND = 0.02  # the squared error of the wheels, while only they are known: they do not spin
BROAD = 0.3  # metres: the width of the field with which new places are looked for


@dataclass(frozen=True, eq=False)
class Estimate:
    """Where the robot thinks it is.

    `covariance` (3, 3) is that of the likeliest cluster of particles, `spread` the root mean square
    distance in metres of all particles from `pose`; `fit` is how well scans fit lately, 1 is as
    usual; `count` is how many particles there are.
    """

    pose: Pose
    covariance: Floats
    spread: float
    fit: float
    count: int

    @property
    def lost(self) -> bool:
        """Whether it looks as if the robot were not where it thinks."""
        return self.fit < LOST and self.spread > 0.5


class Localisation:
    """Follows the robot over a map."""

    def __init__(
        self, map_: OccupancyMap, rng: Generator, start: Pose | None = None, laser: Pose = HERE
    ) -> None:
        """Begin.

        Args:
            map_: what the laser should see.
            rng: where chance comes from.
            start: where the robot is, within some 10 cm; None: it may be anywhere.
            laser: where the scanner sits on the robot.
        """
        self._map = map_
        self._rng = rng
        self._laser = laser
        self._field = LikelihoodField(map_)
        self._broad = LikelihoodField(map_, BROAD)
        self._free = map_.free_points()
        self._odometry: Pose | None = None
        self._global = False
        self.place(start)

    def place(self, pose: Pose | None) -> None:
        """Take it that the robot is at a pose now (None: anywhere), as staff say."""
        self._global = pose is None
        if pose is None:
            self._particles = anywhere(self._free, self._map.resolution, MOST, self._rng)
        else:
            self._particles = around(pose, START, MOST // 4, self._rng)
        self._weights = np.full(len(self._particles), 1.0 / len(self._particles))
        self._fast = self._slow = USUAL
        self._scans = BELIEF
        self._unsettled = SETTLING if pose is None else 0
        self._odometry = None
        self._sum_up()

    @property
    def particles(self) -> Floats:
        """The poses that are thought possible (n, 3)."""
        return self._particles

    def update(self, odometry: Pose, scan: Scan) -> Estimate:
        """Take in what wheels and laser say at one moment, and return where the robot is.

        Args:
            odometry: the pose that the wheels have counted, in any frame that stays.
            scan: what the laser saw from there.
        """
        points = thin(scan, FARTHEST, self._laser)
        first = self._odometry is None
        step = HERE if self._odometry is None else between(self._odometry, odometry)
        if first:
            self._odometry = odometry
        moved = hypot(step.x, step.y) > MOVED or abs(step.heading) > TURNED
        here = compose(self._anchor, step)
        if self._global and len(points):
            self._look_around(points)
        evidence = self._field.evidence(here, points)
        if len(points) < FEWEST_BEAMS or covered(scan) or evidence.share < SEEN:
            if moved:  # only the wheels count
                self._odometry = odometry
                self._particles = move(self._particles, step, self._rng, BLIND)
                self._sum_up()
                here = self._anchor
            return self._told(here)
        renewed = moved or first or self._fast < LOST * self._slow
        if renewed:
            self._odometry = odometry
            self._particles = move(self._particles, step, self._rng)
            wide = self._unsettled > 0
            self._weigh(thin(scan, FARTHEST, self._laser, WIDE) if wide else points)
            self._unsettled = SETTLING if self._spread > UNSETTLED else max(0, self._unsettled - 1)
            here = self._anchor
            evidence = self._field.evidence(here, points)
        self._fast += FAST * (evidence.score - self._fast)
        if renewed:
            self._scans += 1
            doubtful = self._fast < DOUBT * self._slow  # and so no measure of what is usual
            share = SLOW if doubtful else max(SLOW, 1 / self._scans)
            self._slow += share * (evidence.score - self._slow)
            self._renew(points)
        return self._told(here)

    def _look_around(self, points: Floats) -> None:
        """Find the places at which a first scan fits, out of very many."""
        self._global = False
        tried = anywhere(self._free, self._map.resolution, FIRST_GLOBAL, self._rng)
        weights = self._broad.scores(tried, points) ** GLANCE
        self._particles = resample(tried, weights / weights.sum(), MOST, self._rng)

    def _weigh(self, points: Floats) -> None:
        scores = self._field.scores(self._particles, points)
        scores = np.where(self._field.on_floor(self._particles), scores, 0.1 * scores)
        # chance decides how near to a place the nearest particle is: do not judge by that at first
        sharpness = SHARPNESS if not self._unsettled else SHARPNESS * GENTLE
        weights = scores**sharpness
        total = weights.sum()
        self._weights = weights / total if total > 0 else np.full(len(weights), 1 / len(weights))
        self._sum_up()

    def _sum_up(self) -> None:
        self._anchor, self._covariance = likeliest(self._particles, self._weights)
        x, y = self._particles[:, 0] - self._anchor.x, self._particles[:, 1] - self._anchor.y
        self._spread = sqrt(float(self._weights @ (x * x + y * y)))

    def _renew(self, points: Floats) -> None:
        """Resample; while the robot seems lost, draw a part anew where the scan fits."""
        drawn = resample(self._particles, self._weights, len(self._particles), self._rng)
        count = needed(drawn)
        renewed = self._particles[:0]
        share = max(0.0, 1.0 - self._fast / (LOST * self._slow))
        if share > 0:
            tried = anywhere(self._free, self._map.resolution, TRIED, self._rng)
            weights = self._broad.scores(tried, points[::2]) ** SHARPNESS
            fresh = int(min(0.5, share) * count) + 1
            renewed = resample(tried, weights / weights.sum(), fresh, self._rng)
        kept = resample(self._particles, self._weights, count - len(renewed), self._rng)
        self._particles = np.vstack((kept, renewed))
        self._weights = np.full(len(self._particles), 1.0 / len(self._particles))

    def _told(self, pose: Pose) -> Estimate:
        fit = self._fast / self._slow
        where = Pose(pose.x, pose.y, wrap(pose.heading))
        return Estimate(where, self._covariance, self._spread, fit, len(self._particles))
