"""Detects wheel slip: compares wheel odometry with laser scans.

Wheels that slip on a wet floor, or count with the wrong sign, lead a robot astray slowly, because
localisation compensates for a while. So odometry is compared with matched scans, step by step, over
the last stretch of the way.
"""

from __future__ import annotations

from collections import deque
from math import hypot

import numpy as np

from tangy_hw.device_protocols import Pose, Scan
from tangy_hw.navigation.poses import IDENTITY, Floats, relative_pose, wrap
from tangy_hw.navigation.scan_matching import Reference, ScanMatch

STEP, TURN = 0.1, 0.15  # metres and radians of odometry between compared scans
STEPS = 8  # steps in the sum: most of a metre
KEPT = 50  # scans after which a step is dropped: 5 s at ten a second
FITS = 0.6  # share of points that must match
FARTHEST = 0.4  # metres off the odometry above which a match is rejected
ARM = 0.25  # metres from the robot's centre to its wheels: converts a turn into metres


class SlipDetector:
    """Difference between wheel odometry and matched scans over the last stretch of the way."""

    def __init__(self, laser: Pose = IDENTITY) -> None:
        self._laser = laser
        self._steps: deque[tuple[int, Floats]] = deque(maxlen=STEPS)
        self._count = 0
        self._reference: Reference | None = None
        self._from = IDENTITY

    def update(self, odometry: Pose, scan: Scan) -> float:
        """Update with simultaneous odometry and scan; return the disagreement in m."""
        self._count += 1
        while self._steps and self._steps[0][0] < self._count - KEPT:
            self._steps.popleft()
        if self._reference is None:
            self._begin(odometry, scan)
        else:
            step = relative_pose(self._from, odometry)
            if hypot(step.x, step.y) > STEP or abs(step.heading) > TURN:
                self._compare(self._reference, step, scan)
                self._begin(odometry, scan)
        return self.metres

    @property
    def metres(self) -> float:
        """Disagreement in m: length of the sum of the steps' differences."""
        if not self._steps:
            return 0.0
        return float(np.linalg.norm(np.sum([step for _, step in self._steps], axis=0)))

    def reset(self) -> None:
        """Reset, for example after a repair of the wheels."""
        self._steps.clear()
        self._reference = None

    def _begin(self, odometry: Pose, scan: Scan) -> None:
        self._reference, self._from = Reference(scan, self._laser), odometry

    def _compare(self, reference: Reference, step: Pose, scan: Scan) -> None:
        match = reference.match(scan, step, self._laser)
        if match.fits < FITS:  # perhaps the robot stood still, or went the other way
            others = (IDENTITY, Pose(-step.x, -step.y, step.heading))
            match = max(
                (match, *(reference.match(scan, other, self._laser) for other in others)),
                key=lambda one: one.fits,
            )
        off = _off(step, match)
        if match.fits >= FITS and hypot(off[0], off[1]) <= FARTHEST:
            self._steps.append((self._count, off))


def _off(step: Pose, match: ScanMatch) -> Floats:
    """Return the difference between odometry and a match: x, y, and rotation, in m."""
    floor = match.told @ np.array([step.x - match.pose.x, step.y - match.pose.y])
    return np.array([*floor, ARM * wrap(step.heading - match.pose.heading)])
