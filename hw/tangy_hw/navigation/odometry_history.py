"""Recent wheel odometry, to find the pose at which a scan was taken."""

from __future__ import annotations

from collections import deque
from itertools import pairwise

from tangy_hw.device_protocols import Odometry, Pose, Stamped, Twist
from tangy_hw.navigation.poses import compose, relative_pose

KEPT_SECONDS = 2.0
AHEAD_SECONDS = 0.3  # for which the last speed is assumed; a robot without news stands


class OdometryHistory:
    """The odometry of the last seconds, in the order of measurement."""

    def __init__(self) -> None:
        self._known: deque[tuple[float, Odometry]] = deque()

    def note(self, newest: Stamped[Odometry]) -> None:
        """Add the newest odometry, unless it is known."""
        known, time = self._known, newest.time
        if known and time <= known[-1][0]:
            if newest.value == known[-1][1]:
                return
            known.clear()  # the clock was set, or the base switched on again
        known.append((time, newest.value))
        while known[0][0] < time - KEPT_SECONDS:
            known.popleft()

    def at(self, time: float) -> Pose:
        """Return the pose by wheel odometry at a time (s): between two known ones, or soon after.

        Raises:
            IndexError: no odometry is known.
        """
        last, odometry = self._known[-1]
        if time >= last:
            return _moved(odometry.pose, odometry.twist, min(time - last, AHEAD_SECONDS))
        for (before, one), (after, other) in pairwise(self._known):
            if before <= time < after:
                step = relative_pose(one.pose, other.pose)
                share = (time - before) / (after - before)
                return compose(one.pose, Pose(*(share * value for value in step)))
        return self._known[0][1].pose


def _moved(pose: Pose, twist: Twist, seconds: float) -> Pose:
    """Return where a base is after driving like this for some s, in a straight line."""
    turned = twist.turn * seconds
    half = compose(pose, Pose(0.0, 0.0, turned / 2))
    return compose(half, Pose(twist.forward * seconds, 0.0, turned / 2))
