"""Adaptive Monte Carlo localisation with recovery (Thrun et al., ch. 8.3).

Particles move with the odometry, are weighted by the fit of the scan to a likelihood field, and
resampled. A fast and a slow average of the fit detect a kidnapped robot: while the fast average is
much lower, some particles are drawn again where the scan fits. A place is believed after some scans
that fit, if they support it more than any other place that a search of the whole map finds.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot, inf, sqrt

import numpy as np
from numpy.random import Generator

from tangy_hw.device_protocols import Pose, Scan
from tangy_hw.navigation.likelihood import BEAMS, NEAREST, LikelihoodField, covered, evenly
from tangy_hw.navigation.occupancy import OccupancyMap
from tangy_hw.navigation.particles import (
    FEWEST,
    MOST,
    around,
    likeliest,
    move,
    near,
    needed,
    resample,
)
from tangy_hw.navigation.pose_search import Search
from tangy_hw.navigation.poses import (
    IDENTITY,
    Floats,
    compose,
    endpoints,
    relative_pose,
    wrap,
)
from tangy_hw.navigation.recent_scans import FEWEST as FEWEST_SCANS
from tangy_hw.navigation.recent_scans import RecentScans

LOST = 0.85  # of the usual fit: below this the estimated pose is probably wrong
WIDE = 0.5  # metres of spread above which several places are possible
DOUBT = 0.95  # of the usual fit: below this, a scan does not update the usual fit
MOVED, TURNED = 0.1, 0.1  # metres and radians after which particles are weighted again
FAST, SLOW = 0.1, 0.002  # weights of a new value in the averages of the fit
WEIGHTIEST = 3  # usual steps that one long step counts for at most
USUAL, BELIEF = 0.75, 10  # prior for the usual fit at a correct pose, and its weight in scans
SHARPNESS = 30.0  # exponent that turns the fit into a weight
START = (0.1, 0.1, 0.05)  # m, m, rad: standard deviations of a given start
FARTHEST = 20.0  # metres beyond which beams are ignored
FEWEST_BEAMS = 10  # beams with a return that a scan needs
SEEN = 0.2  # share of beams that the map must explain or contradict
BLIND = 0.02  # odometry noise without scans: the squared error for each squared unit moved
GENTLE = 0.15  # factor on SHARPNESS while several places are possible
EVERY = 120  # beams used while several places are possible: few beams tell them apart
SETTLING, AGAIN = 9.0, 5.0  # scans with a good fit before a place is compared, and once more
LEAD = 0.15  # by which recent scans must support it more than any other: see `RecentScans.compare`
PATIENCE = 3  # comparisons in vain for want of scans, after which the scans of one place may do
JUMP, PROOF = 0.5, 0.75  # metres of a jump that resets the fast fit, and the share it resets to
FRESH = 0.1  # share of the particles drawn again until then
FIRST_TRIED, TRIED, PLACES = 5000, 3000, 16  # poses tried at first, later, and kept

LATELY = 5  # searches for which the last settled pose may be near


@dataclass(frozen=True, eq=False)
class Estimate:
    """Estimated pose of the robot.

    `covariance` (3, 3) is that of the most likely cluster of particles, `spread` the root mean
    square distance in m of all particles from `pose`, `fit` the recent fit of the scans relative to
    the usual one (1), and `count` the number of particles. `settled` says whether one place has
    been believed for a while.
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
        """Whether the robot is localised: one pose is believed, and no other is likely."""
        return self.settled and not self.lost and self.spread < WIDE


class Localisation:
    """Estimates the robot's pose on a map."""

    def __init__(
        self, map_: OccupancyMap, rng: Generator, start: Pose | None = None, laser: Pose = IDENTITY
    ) -> None:
        """Start.

        Args:
            map_: the map.
            rng: the random generator.
            start: the robot's pose, within some 10 cm; None: it may be anywhere.
            laser: pose of the scanner on the robot.
        """
        self._rng = rng
        self._laser = laser
        self._field = LikelihoodField(map_)
        self._search = Search(map_, self._field, rng)
        self._recent = RecentScans(self._field, rng)
        self._odometry: Pose | None = None
        self._global = False
        self.place(start)

    def place(self, pose: Pose | None) -> None:
        """Restart at a pose given by staff; None: the robot may be anywhere."""
        self._global = pose is None
        if pose is None:
            self._particles = self._search.anywhere(MOST)
        else:
            self._particles = around(pose, START, FEWEST, self._rng)
        self._weights = np.full(len(self._particles), 1.0 / len(self._particles))
        self._fast = self._slow = USUAL
        self._scans = BELIEF
        self._settled = pose is not None
        self._unsettled = 0.0 if self._settled else SETTLING
        self._recent.forget()
        self._in_vain = 0
        self._searches = 0 if pose else LATELY
        self._odometry = None
        self._sum_up()

    @property
    def particles(self) -> Floats:
        """Particles: possible poses (n, 3)."""
        return self._particles

    def update(self, odometry: Pose, scan: Scan) -> Estimate:
        """Update with simultaneous odometry and scan, and return the estimate.

        Args:
            odometry: pose by wheel odometry, in any fixed frame.
            scan: the scan.
        """
        ends = endpoints(scan, FARTHEST, self._laser, NEAREST)
        points = evenly(ends, BEAMS)
        first = self._odometry is None
        step = IDENTITY if self._odometry is None else relative_pose(self._odometry, odometry)
        if first:
            self._odometry = odometry
        moved = hypot(step.x, step.y) > MOVED or abs(step.heading) > TURNED
        here = compose(self._anchor, step)
        seen = len(points) >= FEWEST_BEAMS and not covered(scan)
        if not seen or not (self._global or self._field.tells(here, points, SEEN)):
            if moved:  # move by odometry alone
                self._odometry = odometry
                self._particles = move(self._particles, step, self._rng, BLIND)
                self._sum_up()
                here = self._anchor
            return self._told(here)
        if not (moved or first or self._fast < LOST * self._slow):
            self._fast += FAST * (self._field.evidence(here, points).score - self._fast)
            return self._told(here)
        self._odometry = odometry
        self._particles = move(self._particles, step, self._rng)
        every = points if self._settled else evenly(ends, EVERY)
        self._weigh(every)
        if not first and hypot(self._anchor.x - here.x, self._anchor.y - here.y) > JUMP:
            self._fast = min(self._fast, PROOF * self._slow)  # one of the two poses is wrong
        score = self._field.evidence(self._anchor, every).score
        steps = min(max(hypot(step.x, step.y) / MOVED, 1.0), WEIGHTIEST)
        self._note(score, steps, moved or first)
        self._renew(odometry, every)
        return self._told(self._anchor)

    def _note(self, score: float, steps: float, moved: bool) -> None:
        """Update both averages with a score, and count the scans until the pose has settled.

        A scan after a way of several `MOVED` counts as so many scans (`steps`).
        """
        self._fast += (1 - (1 - FAST) ** steps) * (score - self._fast)
        self._scans += 1
        doubtful = self._fast < DOUBT * self._slow  # so it must not change the usual fit
        share = SLOW if doubtful else max(SLOW, 1 / self._scans)
        self._slow += share * (score - self._slow)
        if self._fast < LOST * self._slow:
            self._settled, self._unsettled = False, SETTLING
            self._recent.forget()
        elif moved:
            self._unsettled = max(0.0, self._unsettled - steps)

    def _weigh(self, points: Floats) -> None:
        scores = self._field.scores(self._particles, points)
        scores = np.where(self._field.on_floor(self._particles), scores, 0.1 * scores)
        # more than one scan must decide between places that look alike
        weights = scores ** (SHARPNESS if self._settled else SHARPNESS * GENTLE)
        total = weights.sum()
        self._weights = weights / total if total > 0 else np.full(len(weights), 1 / len(weights))
        self._sum_up()

    def _sum_up(self) -> None:
        self._anchor, self._covariance = likeliest(self._particles, self._weights)
        self._spread = self._spread_now()

    def _spread_now(self) -> float:
        x, y = self._particles[:, 0] - self._anchor.x, self._particles[:, 1] - self._anchor.y
        return sqrt(float(self._weights @ (x * x + y * y)))

    def _renew(self, odometry: Pose, points: Floats) -> None:
        """Resample; until the pose has settled, draw some particles again where the scan fits."""
        drawn = resample(self._particles, self._weights, len(self._particles), self._rng)
        count, renewed = needed(drawn), self._particles[:0]
        if self._settled:
            self._searches = 0
        elif not self._unsettled:
            fewest = FEWEST_SCANS if self._in_vain < PATIENCE else 1
            compared = self._recent.compare(self._anchor, odometry, points, fewest=fewest)
            self._in_vain = self._in_vain + 1 if compared.lead == -inf else 0
            self._settled = compared.lead > LEAD
            self._unsettled = 0.0 if self._settled else AGAIN
            if self._settled:  # the comparison ruled out all other places
                there = self._weights * near(self._particles, self._anchor)
                if total := there.sum():
                    self._weights = there / total
            elif compared.rival is not None and compared.over_rival < -LEAD:
                renewed = around(compared.rival, START, count // 2, self._rng)
        else:
            tried = FIRST_TRIED if self._global else TRIED
            self._searches += 1
            last = self._anchor if self._searches <= LATELY else None
            places, scores = self._search.places(points, PLACES, tried, last)
            self._recent.note(odometry, points, places, scores)
            weights = scores ** (SHARPNESS * GENTLE)
            share = 1.0 if self._global else max(FRESH, 1 - self._fast / (LOST * self._slow))
            fresh = int(min(1.0 if self._global else 0.5, share) * count)
            renewed = resample(places, weights / weights.sum(), fresh, self._rng)
            self._global = False
        kept = resample(self._particles, self._weights, count - len(renewed), self._rng)
        self._particles = np.vstack((kept, renewed))
        self._weights = np.full(len(self._particles), 1.0 / len(self._particles))
        self._spread = self._spread_now()  # includes the new particles

    def _told(self, pose: Pose) -> Estimate:
        where = Pose(pose.x, pose.y, wrap(pose.heading))
        return Estimate(
            where,
            self._covariance,
            self._spread,
            self._fast / self._slow,
            len(self._particles),
            self._settled,
        )
