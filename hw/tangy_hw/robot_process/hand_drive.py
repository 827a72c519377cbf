"""Driving by hand: as somebody at the keys says, but up to nothing that the scanner sees."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np

from tangy_hw.device_protocols import STILL, Pose, Scan, Twist
from tangy_hw.navigation.clearance import REACH, guarded
from tangy_hw.navigation.limits import MotionLimits
from tangy_hw.navigation.people_guard import Around
from tangy_hw.navigation.people_tracker import Track
from tangy_hw.navigation.poses import HERE, Floats, endpoints

HOLDS_SECONDS = 0.4  # for which a command of somebody at the keys holds

Held = Literal["", "slow", "stands"]
"""What was done about the last command: it was carried out, slower, or not at all."""


class HandDrive:
    """Drives as somebody says who holds a key; nothing that is near is driven up to.

    Where the robot is on a map does not matter, and whatever is seen may be somebody.
    """

    def __init__(self, limits: MotionLimits, laser: Pose = HERE) -> None:
        self.held: Held = ""
        self._limits, self._laser = limits, laser
        self._told = STILL
        self._until = 0.0

    def tell(self, twist: Twist, now: float) -> None:
        """Take a command, `now` in s; it holds for a moment."""
        self._told, self._until = self._limits.clamped(twist), now + HOLDS_SECONDS

    def end(self) -> None:
        """Forget the command."""
        self._told, self.held = STILL, ""

    def command(
        self,
        scan: Scan | None,
        now: float,
        unseen: Floats | None = None,
        tracks: Sequence[Track] = (),
    ) -> Twist | None:
        """Return how to drive now; None where nobody drives by hand.

        Args:
            scan: what the laser sees.
            now: the time in s.
            unseen: what is there as well (n, 2), in the robot's frame.
            tracks: who is around, in the robot's frame.
        """
        if self._told == STILL:
            return None
        if now >= self._until:
            self.end()
            return STILL
        if scan is None:
            self.held = "stands"
            return STILL
        points = endpoints(scan, REACH, self._laser)
        around = Around(tracks, points)
        if unseen is not None and len(unseen):
            points = np.vstack((points, unseen))
        twist = guarded(self._told, points, around, self._limits)
        self.held = _held(self._told, twist)
        return twist


def _held(told: Twist, twist: Twist) -> Held:
    if twist == told:
        return ""
    return "stands" if twist.forward == 0 and told.forward != 0 else "slow"
