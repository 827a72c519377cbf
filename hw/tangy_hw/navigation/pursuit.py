"""Path following: pure pursuit with limits, turns on the spot, and stops for obstacles.

The base is round and can always turn on the spot; it only drives forwards, where its laser looks.
Steering law: R. Coulter, "Implementation of the pure pursuit path tracking algorithm", 1992:
curvature = 2 y / L^2, where y is the lateral offset, positive to the left, of the point of the path
at the look-ahead distance L.
"""

from __future__ import annotations

from math import atan2, hypot, sqrt
from typing import Literal

import numpy as np

from tangy_hw.device_protocols import STILL, Pose, Scan, Twist
from tangy_hw.navigation.clearance import REACH, room_ahead, speed_in
from tangy_hw.navigation.limits import MotionLimits
from tangy_hw.navigation.poses import IDENTITY, Floats, endpoints, lengths, relative_pose, wrap

State = Literal["driving", "turning", "waiting", "arrived"]
"""On the path; turning on the spot; waiting for an obstacle to go away; at the goal."""

NEAREST, PER_SPEED, FURTHEST = 0.3, 0.6, 0.8  # metres of look-ahead: minimum, per m/s, maximum
AIM = 0.6  # radians off the path beyond which the robot turns on the spot first
AIMED = 0.1  # radians off at which it starts to drive
THERE, FACING = 0.05, 0.04  # metres and radians off the goal within which it has arrived
PASSED = 0.15  # metres from the goal within which it does not turn back to it
CREEP = 0.03  # m/s below which it stands still


class Pursuit:
    """Follows one path, and turns to the final heading at its end."""

    def __init__(
        self,
        path: Floats,
        heading: float | None = None,
        limits: MotionLimits | None = None,
        laser: Pose = IDENTITY,
    ) -> None:
        """Start at the beginning of a path.

        Args:
            path: points (n, 2) some centimetres apart, as `planning.plan` returns them.
            heading: final heading in rad; None: any.
            limits: the motion limits.
            laser: pose of the scanner on the robot.
        """
        self.path = path
        self.heading = heading
        self.limits = limits or MotionLimits()
        self.laser = laser
        self.state: State = "turning"
        self._at = 0
        steps = lengths(np.diff(path, axis=0))
        self._left = np.concatenate((np.cumsum(steps[::-1])[::-1], [0.0]))
        self._close = False
        self._aiming = True

    @property
    def left(self) -> float:
        """Remaining metres of the path."""
        return float(self._left[self._at])

    @property
    def ahead(self) -> Floats:
        """Remaining points of the path (n, 2)."""
        return self.path[self._at :]

    def command(
        self,
        pose: Pose,
        twist: Twist,
        scan: Scan,
        dt: float,
        wary_of: Floats | None = None,
    ) -> Twist:
        """Return the twist for the next `dt` s.

        Args:
            pose: pose of the robot in the frame of the path.
            twist: its current twist.
            scan: the current scan.
            dt: seconds until the next command.
            wary_of: positions where people may be (n, 2), in the frame of the path.
        """
        if self.state == "arrived":
            return STILL
        self._advance(pose)
        goal = relative_pose(pose, Pose(float(self.path[-1, 0]), float(self.path[-1, 1]), 0.0))
        off = hypot(goal.x, goal.y)
        if off < THERE or (off < PASSED and (self._close or goal.x < 0)):
            self._close = off < PASSED
            return self._face(pose, twist, dt)
        return self._drive(pose, twist, endpoints(scan, REACH, self.laser), dt, wary_of)

    def _advance(self, pose: Pose) -> None:
        """Advance to the point of the path nearest to the robot, never back."""
        window = self.path[self._at : self._at + 40]
        self._at += int(np.argmin(lengths(window - (pose.x, pose.y))))

    def _face(self, pose: Pose, twist: Twist, dt: float) -> Twist:
        off = 0.0 if self.heading is None else wrap(self.heading - pose.heading)
        if abs(off) < FACING and abs(twist.turn) < 0.2:
            self.state = "arrived"
            return STILL
        self.state = "turning"
        return self._turn(off, twist, dt)

    def _drive(
        self, pose: Pose, twist: Twist, seen: Floats, dt: float, wary_of: Floats | None
    ) -> Twist:
        limits = self.limits
        look = min(FURTHEST, NEAREST + PER_SPEED * abs(twist.forward))
        gone = self.left - self._left[self._at :]
        beyond = int(np.searchsorted(gone, look))
        target = self.path[min(self._at + beyond, len(self.path) - 1)]
        to = relative_pose(pose, Pose(float(target[0]), float(target[1]), 0.0))
        off = atan2(to.y, to.x)
        if abs(off) > AIM or (self._aiming and abs(off) > AIMED):
            self._aiming = True
            self.state = "turning"
            return self._turn(off, twist, dt)
        self._aiming = False
        far = max(hypot(to.x, to.y), 0.1)
        curvature = 2 * to.y / far**2
        left = max(self.left, hypot(self.path[-1][0] - pose.x, self.path[-1][1] - pose.y))
        most = min(
            limits.max_speed, sqrt(2 * limits.planned_braking * left) * 0.8, left * 1.5 + CREEP
        )
        if abs(curvature) > 0.01:
            most = min(most, limits.max_turn / abs(curvature))
        room = room_ahead(seen, curvature, limits)
        if room + limits.clearance > left:  # obstacles behind the goal do not block it
            room = max(room, left)
        most = min(most, speed_in(room, limits))
        if wary_of is not None and len(wary_of):
            near = float(lengths(wary_of - (pose.x, pose.y)).min())
            most = min(most, limits.people_speed) if near < limits.people_range else most
        if most < CREEP:
            self.state = "waiting"
            return STILL
        self.state = "driving"
        forward = min(most, max(0.0, twist.forward) + limits.acceleration * dt)
        return Twist(
            forward, float(np.clip(curvature * forward, -limits.max_turn, limits.max_turn))
        )

    def _turn(self, off: float, twist: Twist, dt: float) -> Twist:
        """Turn on the spot by an angle in rad, no faster than the robot can brake."""
        limits = self.limits
        if abs(twist.forward) > 2 * CREEP:  # stop first
            return Twist(max(0.0, twist.forward - limits.planned_braking * dt), 0.0)
        fast = min(limits.max_turn, sqrt(limits.turn_acceleration * abs(off)) * 0.7, 2.5 * abs(off))
        fast = max(fast, min(0.15, abs(off) / max(dt, 1e-3)))
        fast = min(fast, abs(twist.turn) + limits.turn_acceleration * dt)
        return Twist(0.0, fast if off > 0 else -fast)
