"""Driving by hand: as somebody at the keys says, but up to nothing that the scanner sees."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Literal

import numpy as np

from tangy_hw.device_protocols import STILL, Pose, Scan, Twist
from tangy_hw.navigation.clearance import REACH, guarded
from tangy_hw.navigation.limits import MotionLimits
from tangy_hw.navigation.people_guard import Around
from tangy_hw.navigation.people_tracker import Track
from tangy_hw.navigation.poses import HERE, Floats, endpoints

HOLDS_SECONDS = 0.4  # for which a command of somebody at the keys holds

OVERRIDE = 0.08  # m/s at most while somebody overrides the look at the scanner

Held = Literal["", "slow", "stands", "overridden"]
"""What was done about the last command: it was carried out, slower, not at all, or slowly past
what is near, as staff wanted it who hold the key for that."""


class HandDrive:
    """Drives as somebody says who holds a key; nothing that is near is driven up to.

    Where the robot is on a map does not matter, and whatever is seen may be somebody.
    """

    def __init__(self, limits: MotionLimits, laser: Pose = HERE) -> None:
        self.held: Held = ""
        self._limits, self._laser = limits, laser
        self._told = STILL
        self._overrides = False
        self._until = 0.0

    def tell(self, twist: Twist, now: float, *, overrides: bool = False) -> None:
        """Take a command, `now` in s; it holds for a moment.

        One that `overrides` drives at a crawl, whatever stands near: who gives it looks there.
        """
        limits = self._limits
        if overrides:
            limits = replace(limits, speed=OVERRIDE, turn=limits.turn_close)
        self._told, self._overrides = limits.clamped(twist), overrides
        self._until = now + HOLDS_SECONDS

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
        """Return the current velocity command; None if nobody drives by hand.

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
        if self._overrides:
            self.held = "overridden"
            return self._told
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
