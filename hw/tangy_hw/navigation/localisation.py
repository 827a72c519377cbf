"""Adaptive Monte Carlo localisation with recovery (Thrun et al., ch. 8.3).

Particles move with the odometry, are weighted by the fit of the scan to a likelihood field, and
resampled. A fast and a slow average of that fit detect a robot that was carried away: while the
fast one is much lower, some particles are redrawn where the scan fits.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot, sqrt

import numpy as np
from numpy.random import Generator

from tangy_hw.device_protocols import Pose, Scan
from tangy_hw.navigation.likelihood import LikelihoodField, covered, thin
from tangy_hw.navigation.occupancy import OccupancyMap
from tangy_hw.navigation.particles import MOST, around, likeliest, move, needed, resample
from tangy_hw.navigation.pose_search import Search
from tangy_hw.navigation.poses import HERE, Floats, between, compose, wrap

LOST = 0.85  # of the usual fit: below this the robot is probably not where it thinks
WIDE = 0.5  # metres of spread from which on it thinks more than one place possible
DOUBT = 0.95  # of the usual fit: below this a scan does not update the usual fit
MOVED, TURNED = 0.1, 0.1  # metres and radians after which the particles are weighed again
FAST, SLOW = 0.1, 0.002  # shares of a new value in the averages of the fit
USUAL, BELIEF = (
    0.75,
    10,
)  # the fit at a right pose before any scan, and how many scans that is worth
SHARPNESS = 30.0  # the exponent that makes a weight of the fit
START = (0.1, 0.1, 0.05)  # metres, metres, radians: spread of a given start
FARTHEST = 20.0  # metres beyond which beams are not used
FEWEST_BEAMS = 10  # that must have met something
SEEN = 0.2  # share of the beams that something on the map must explain, or contradict
BLIND = 0.02  # the squared error of the wheels, while only they are known: they do not spin
GENTLE = 0.15  # of the sharpness, while several places are possible
EVERY = 360  # beams that count while several places are possible: few tell them apart
SETTLING = 15  # scans with a good fit at one place until it is believed
JUMP, PROOF = 0.5, 0.75  # metres to another place, which must prove itself from such a fit on
FRESH = 0.1  # share of the particles that is redrawn until then
FIRST_TRIED, TRIED, PLACES = 20_000, 4000, 40  # poses looked at first, and then; kept of them


@dataclass(frozen=True, eq=False)
class Estimate:
    """Where the robot thinks it is.

    `covariance` (3, 3) is that of the likeliest cluster of particles, `spread` the root mean square
    distance in metres of all particles from `pose`; `fit` is how well scans fit lately, 1 is as
    usual; `count` is how many particles there are. `settled` says that one place has been
    believed for a while.
    """

    pose: Pose
    covariance: Floats
    spread: float
    fit: float
    count: int
    settled: bool = True

    @property
    def lost(self) -> bool:
        """Whether the scans contradict the estimated pose."""
        return self.fit < LOST and self.spread > WIDE

    @property
    def found(self) -> bool:
        """Whether it is localised: one pose is believed, and no other is likely."""
        return self.settled and not self.lost and self.spread < WIDE


class Localisation:
    """Follows the robot over a map."""

    def __init__(
        self, map_: OccupancyMap, rng: Generator, start: Pose | None = None, laser: Pose = HERE
    ) -> None:
        """Begin.

        Args:
            map_: the map.
            rng: where chance comes from.
            start: where the robot is, within some 10 cm; None: it may be anywhere.
            laser: where the scanner sits on the robot.
        """
        self._rng = rng
        self._laser = laser
        self._field = LikelihoodField(map_)
        self._search = Search(map_, self._field, rng)
        self._odometry: Pose | None = None
        self._global = False
        self.place(start)

    def place(self, pose: Pose | None) -> None:
        """Take it that the robot is at a pose now (None: anywhere), as staff say."""
        self._global = pose is None
        if pose is None:
            self._particles = self._search.anywhere(MOST)
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
        """Update with odometry and a scan of one moment, and return the estimated pose.

        Args:
            odometry: the pose that the wheels have counted, in any frame that stays.
            scan: the scan from there.
        """
        points = thin(scan, FARTHEST, self._laser)
        first = self._odometry is None
        step = HERE if self._odometry is None else between(self._odometry, odometry)
        if first:
            self._odometry = odometry
        moved = hypot(step.x, step.y) > MOVED or abs(step.heading) > TURNED
        here = compose(self._anchor, step)
        evidence = self._field.evidence(here, points)
        seen = len(points) >= FEWEST_BEAMS and not covered(scan)
        if not seen or (evidence.share < SEEN and not self._global):
            if moved:  # only the wheels count
                self._odometry = odometry
                self._particles = move(self._particles, step, self._rng, BLIND)
                self._sum_up()
                here = self._anchor
            return self._told(here)
        if not (moved or first or self._fast < LOST * self._slow):
            self._fast += FAST * (evidence.score - self._fast)
            return self._told(here)
        self._odometry = odometry
        self._particles = move(self._particles, step, self._rng)
        every = thin(scan, FARTHEST, self._laser, EVERY) if self._unsettled else points
        self._weigh(every)
        if not first and hypot(self._anchor.x - here.x, self._anchor.y - here.y) > JUMP:
            self._fast = min(self._fast, PROOF * self._slow)  # it was wrong before, or is now
        score = self._field.evidence(self._anchor, every).score
        self._note(score, moved or first)
        self._renew(every)
        return self._told(self._anchor)

    def _note(self, score: float, moved: bool) -> None:
        """Take a score into both averages, and see whether the robot has found one place."""
        self._fast += FAST * (score - self._fast)
        self._scans += 1
        doubtful = self._fast < DOUBT * self._slow  # so it must not change the usual fit
        share = SLOW if doubtful else max(SLOW, 1 / self._scans)
        self._slow += share * (score - self._slow)
        if self._fast < LOST * self._slow:
            self._unsettled = SETTLING
        elif moved:
            self._unsettled = max(0, self._unsettled - 1)

    def _weigh(self, points: Floats) -> None:
        scores = self._field.scores(self._particles, points)
        scores = np.where(self._field.on_floor(self._particles), scores, 0.1 * scores)
        # of two places that look alike, more than one scan must decide
        weights = scores ** (SHARPNESS * GENTLE if self._unsettled else SHARPNESS)
        total = weights.sum()
        self._weights = weights / total if total > 0 else np.full(len(weights), 1 / len(weights))
        self._sum_up()

    def _sum_up(self) -> None:
        self._anchor, self._covariance = likeliest(self._particles, self._weights)
        self._spread = self._spread_now()

    def _spread_now(self) -> float:
        x, y = self._particles[:, 0] - self._anchor.x, self._particles[:, 1] - self._anchor.y
        return sqrt(float(self._weights @ (x * x + y * y)))

    def _renew(self, points: Floats) -> None:
        """Resample; until the pose has settled, redraw a part where the scan fits."""
        drawn = resample(self._particles, self._weights, len(self._particles), self._rng)
        count, renewed = needed(drawn), self._particles[:0]
        if self._unsettled:
            tried = FIRST_TRIED if self._global else TRIED
            places, scores = self._search.places(points, PLACES, tried)
            weights = scores ** (SHARPNESS * GENTLE)
            share = 1.0 if self._global else max(FRESH, 1 - self._fast / (LOST * self._slow))
            fresh = int(min(1.0 if self._global else 0.5, share) * count)
            renewed = resample(places, weights / weights.sum(), fresh, self._rng)
            self._global = False
        kept = resample(self._particles, self._weights, count - len(renewed), self._rng)
        self._particles = np.vstack((kept, renewed))
        self._weights = np.full(len(self._particles), 1.0 / len(self._particles))
        self._spread = self._spread_now()  # includes the particles added again

    def _told(self, pose: Pose) -> Estimate:
        where = Pose(pose.x, pose.y, wrap(pose.heading))
        return Estimate(
            where,
            self._covariance,
            self._spread,
            self._fast / self._slow,
            len(self._particles),
            self._unsettled == 0,
        )
