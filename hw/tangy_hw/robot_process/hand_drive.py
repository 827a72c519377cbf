"""Manual driving by keys, with protection from everything that the scanner sees."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Literal

import numpy as np

from tangy_hw.device_protocols import STILL, Pose, Scan, Twist
from tangy_hw.navigation.clearance import REACH, limit_by_clearance
from tangy_hw.navigation.limits import MotionLimits
from tangy_hw.navigation.people_guard import NearbyPeople
from tangy_hw.navigation.people_tracker import Track
from tangy_hw.navigation.poses import IDENTITY, Floats, endpoints

HOLDS_SECONDS = 0.4  # for which a manual command is valid

FIRST_SECONDS = 0.1  # of acceleration in the first command from standing

SET_OFF = 0.9  # m/s at which a person who stands may set off towards the robot

OVERRIDE = 0.08  # maximum m/s while the scanner's protection is overridden

HandDriveResult = Literal["", "slow", "stands", "overridden"]
"""Result of the last command: executed, slower, not executed, or slowly past an obstacle, because
staff held the override key."""


class HandDrive:
    """Drives by a person's held keys, but into nothing that is near.

    The robot's pose on a map does not matter, and every return may be a person.
    """

    def __init__(self, limits: MotionLimits, laser: Pose = IDENTITY) -> None:
        self.held: HandDriveResult = ""
        self._limits, self._laser = replace(limits, set_off=SET_OFF), laser
        self._told = self._given = STILL
        self._given_at = 0.0
        self._overrides = False
        self._until = 0.0

    def tell(self, twist: Twist, now: float, *, overrides: bool = False) -> None:
        """Set a command, `now` in s; it is valid for a moment.

        One that `overrides` drives at a crawl past any obstacle: its sender must watch them.
        """
        limits = self._limits
        if overrides:
            limits = replace(limits, max_speed=OVERRIDE, max_turn=limits.close_turn)
        self._told, self._overrides = limits.clamped(twist), overrides
        self._until = now + HOLDS_SECONDS

    def end(self) -> None:
        """Drop the command."""
        self._told = self._given = STILL
        self.held = ""

    def command(
        self,
        scan: Scan | None,
        now: float,
        unseen: Floats | None = None,
        tracks: Sequence[Track] = (),
    ) -> Twist | None:
        """Return the current velocity command; None if nobody drives manually.

        Args:
            scan: the current scan.
            now: the time in s.
            unseen: keep-out points that the scanner does not see (n, 2), in the robot's frame.
            tracks: tracks around, in the robot's frame.
        """
        if self._told == STILL:
            self._given = STILL
            return None
        if now >= self._until:
            self.end()
            return STILL
        if scan is None:
            self.held, self._given = "stands", STILL
            return STILL
        if self._overrides:
            self.held = "overridden"
            return self._sped_up(self._told, now)
        points = endpoints(scan, REACH, self._laser)
        around = NearbyPeople(tracks, points)
        if unseen is not None and len(unseen):
            points = np.vstack((points, unseen))
        twist = limit_by_clearance(self._told, points, around, self._limits)
        self.held = _held(self._told, twist)
        return self._sped_up(twist, now)

    def _sped_up(self, twist: Twist, now: float) -> Twist:
        """Return the part of a twist that the acceleration of the body allows after the last one.

        The robot may slow down at once. `now` is in s.
        """
        last, seconds = self._given.forward, min(now - self._given_at, HOLDS_SECONDS)
        before = abs(last) if last * twist.forward > 0.0 else 0.0
        if self._given == STILL:
            seconds = FIRST_SECONDS
        most = before + self._limits.acceleration * seconds
        share = min(1.0, most / abs(twist.forward)) if twist.forward else 1.0
        self._given, self._given_at = Twist(twist.forward * share, twist.turn * share), now
        return self._given


def _held(told: Twist, twist: Twist) -> HandDriveResult:
    if twist == told:
        return ""
    return "stands" if twist == STILL or twist.forward == 0 != told.forward else "slow"
