"""Notices that a robot does not move: wheels that do not turn, and a way without progress."""

from __future__ import annotations

from math import hypot

from tangy_hw.device_protocols import Pose, Twist
from tangy_hw.navigation.poses import relative_pose

PROGRESS, PROGRESS_SECONDS = 0.5, 10.0  # metres of progress required per period in s
TOLD = Twist(0.02, 0.05)  # m/s and rad/s: commands below both need not turn the wheels
SHARE = 0.1  # of a command that the wheels must follow


class StallDetector:
    """Measures for how long the wheels have not turned as they were told."""

    def __init__(self) -> None:
        self._before: Pose | None = None
        self.seconds = 0.0
        """Seconds that the wheels have not turned despite the commands."""

    def update(self, odometry: Pose, told: Twist, dt: float) -> None:
        """Update with the odometry `dt` s after the last, between which this was `told`."""
        before, self._before = self._before, odometry
        if before is None or (abs(told.forward) < TOLD.forward and abs(told.turn) < TOLD.turn):
            self.seconds = 0.0
            return
        step = relative_pose(before, odometry)
        moved = (
            hypot(step.x, step.y) > SHARE * abs(told.forward) * dt + 1e-6
            or abs(step.heading) > SHARE * abs(told.turn) * dt + 1e-6
        )
        self.seconds = 0.0 if moved else self.seconds + dt


class ProgressCheck:
    """Checks whether a robot gets `PROGRESS` m further within `PROGRESS_SECONDS`."""

    def __init__(self) -> None:
        self._mark: tuple[float, float] | None = None
        self._seconds = 0.0

    def restart(self) -> None:
        """Measure from the next pose on."""
        self._mark, self._seconds = None, 0.0

    def made(self, pose: Pose, dt: float, *, excused: bool = False) -> bool:
        """Return whether it makes progress, `dt` s after the last pose; always if `excused`."""
        mark = self._mark
        if excused or mark is None or hypot(pose.x - mark[0], pose.y - mark[1]) > PROGRESS:
            self._mark, self._seconds = (pose.x, pose.y), 0.0
        self._seconds += dt
        return self._seconds < PROGRESS_SECONDS
