"""How well the scans of the last metres support a pose, compared with other poses.

One scan often fits at several places that look alike; those of a way of several metres seldom do.
A pose is followed back along the odometry, and refined at each scan, because the odometry drifts.
"""

from __future__ import annotations

from collections import deque
from math import hypot, inf, log, pi
from typing import NamedTuple

import numpy as np
from numpy.random import Generator

from tangy_hw.device_protocols import Pose
from tangy_hw.navigation.likelihood import FLOOR, LikelihoodField, evenly
from tangy_hw.navigation.particles import moved
from tangy_hw.navigation.pose_search import Nudges, nudged
from tangy_hw.navigation.poses import IDENTITY, Floats, relative_pose

APART, TURN_APART = 0.3, 0.3  # metres or radians between two scans that are kept
FEWEST, KEPT = 6, 12  # scans needed to compare places, and scans kept
BEAMS = 60  # of each scan
PLACES = 16  # other places that are followed
ELSEWHERE = 0.6  # metres or radians between two places that contradict each other
ALONG = Nudges(8, 0.08, 0.05)  # for a place that is followed
BY_CHANCE = 0.03  # by which each scan for itself may fit better elsewhere than at the right place
POOR = -0.15  # mean logarithm of a scan's fit below which the right place may not be among them
MANY = 10  # scans from which a place with such fits may be believed all the same
NOWHERE, NOTHING = np.zeros((0, 3)), np.zeros(0)
BACK = (Nudges(12, 0.1, 0.08), Nudges(12, 0.03, 0.025))  # for a pose that is followed back


class Comparison(NamedTuple):
    """A pose's lead over all other places, and over the best other place that was followed."""

    lead: float
    rival: Pose | None = None
    over_rival: float = inf


class RecentScans:
    """The last scans, some way apart, and the places at which they fit."""

    def __init__(self, field: LikelihoodField, rng: Generator) -> None:
        self._field = field
        self._rng = rng
        self._kept: deque[tuple[Pose, Floats, float]] = deque(maxlen=KEPT)
        self._odometry = IDENTITY
        self.forget()

    def forget(self) -> None:
        """Forget everything: the odometry may have been wrong, or the robot was carried."""
        self._kept.clear()
        self._places = NOWHERE

    def note(
        self, odometry: Pose, points: Floats, places: Floats = NOWHERE, scores: Floats = NOTHING
    ) -> None:
        """Take a scan, and follow the places at which the scans fit.

        Args:
            odometry: pose by odometry.
            points: ends of the beams (n, 2) in the robot's frame.
            places: more poses (m, 3) at which the scan fits.
            scores: their scores (m,).
        """
        points = evenly(points, BEAMS)
        followed = moved(self._places, relative_pose(self._odometry, odometry))
        followed, fits = nudged(followed, points, self._field, ALONG, self._rng)
        self._odometry = odometry
        order = np.argsort(-np.concatenate((fits, scores)))
        self._places = _distinct(np.vstack((followed, places))[order], PLACES)
        if self._kept:
            step = relative_pose(self._kept[-1][0], odometry)
            if hypot(step.x, step.y) < APART and abs(step.heading) < TURN_APART:
                return
        best = max(fits.max(initial=FLOOR), scores.max(initial=FLOOR))
        self._kept.append((odometry, points, log(best)))

    def compare(
        self, pose: Pose, odometry: Pose, points: Floats, *, fewest: int = FEWEST
    ) -> Comparison:
        """Take a scan, and compare a pose with the other places that the scans support.

        The lead is by how much the scans support the pose more: the sum over the scans of the
        differences between the logarithms of the fits. It is `inf` if they fit nowhere else, and
        `-inf` while they are too few to say. It may be negative without a better place: each scan
        for itself may fit better somewhere else. It is then only an upper bound, and there is no
        rival. While few scans fit, and poorly, the lead is not positive.

        Args:
            pose: the pose that may be believed, in m and rad.
            odometry: pose by odometry.
            points: ends of the beams (n, 2) in the robot's frame.
            fewest: scans, some way apart, that are needed to say anything.
        """
        self.note(odometry, points)
        poses = _distinct(np.vstack((np.asarray([pose]), self._places)), PLACES + 1)
        if len(self._kept) < fewest:
            return Comparison(-inf)
        if len(poses) == 1:
            return Comparison(inf)
        anywhere = sum(best - BY_CHANCE for _, _, best in self._kept)
        support = self._support(poses, odometry, anywhere)
        rival = 1 + int(support[1:].argmax())
        lead, over_rival = support[0] - max(support[rival], anywhere), support[0] - support[rival]
        if support[0] < POOR * len(self._kept) and len(self._kept) < MANY:
            lead = min(lead, 0.0)
        if over_rival == inf:
            return Comparison(float(lead))
        return Comparison(float(lead), Pose(*poses[rival]), float(over_rival))

    def _support(self, poses: Floats, odometry: Pose, least: float) -> Floats:
        """Return how well the scans support each of the poses (n, 3): sums of logarithms (n,).

        The poses are followed back along the odometry, and refined at each scan. With each scan the
        sums only fall. So a pose other than the first is left behind once its sum is below `least`,
        and counts as `-inf`. If all the others are left behind, and the first pose has a sum below
        `least`, the rest of the scans could not change that, and are left out.
        """
        support, rows, there, now = np.zeros(len(poses)), np.arange(len(poses)), poses, odometry
        for then, seen, _ in reversed(self._kept):
            there, now = moved(there, relative_pose(now, then)), then
            for nudges in BACK:
                there, fits = nudged(there, seen, self._field, nudges, self._rng)
            support[rows] += np.log(fits)
            left = support[rows] < least
            left[0] = False
            if left.any():
                support[rows[left]] = -inf
                rows, there = rows[~left], there[~left]
            if len(rows) == 1 and support[0] < least:
                break
        return support


def _distinct(poses: Floats, most: int) -> Floats:
    """Return the first `most` of the poses (n, 3) that contradict each other."""
    x, y, heading = poses.T[:, :, None] - poses.T[:, None, :]
    turned = np.abs(heading)  # below 2 pi, as headings are wrapped
    agree = x * x + y * y <= ELSEWHERE**2
    agree &= (turned <= ELSEWHERE) | (turned >= 2 * pi - ELSEWHERE)
    left = np.ones(len(poses), dtype=np.bool_)
    chosen: list[int] = []
    while left.any() and len(chosen) < most:
        chosen.append(int(left.argmax()))
        left &= ~agree[:, chosen[-1]]
    return poses[chosen]
