"""Surroundings that are not on the map: obstacles, and people who walk by."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Literal

import numpy as np

from tangy_hw.device_protocols import Pose, Scan, Twist
from tangy_hw.navigation.clearance import REACH
from tangy_hw.navigation.limits import MotionLimits
from tangy_hw.navigation.localisation import Estimate
from tangy_hw.navigation.obstacles import Obstacles
from tangy_hw.navigation.occupancy import OccupancyMap
from tangy_hw.navigation.people_guard import NearbyPeople, limit_near_people
from tangy_hw.navigation.people_tracker import PeopleTracker, Track
from tangy_hw.navigation.poses import IDENTITY, Floats, endpoints, lengths, transform_points

Blocker = Literal["", "walking", "standing", "object"]
"""What the robot waits for: nothing, a person who walks or stands, or probably an object."""

SURE = 0.3  # metres of pose spread up to which points become obstacles
WALKS = 0.25  # m/s above which a track counts as walking
WALKERS = 0.5  # metres around a walking person within which points belong to them
STAYS = 3.0  # seconds after which a point belongs to nobody who walks
CREEPS = Twist(0.02, 0.05)  # m/s and rad/s: people do not see a robot move that is slower than both
AHEAD = (0.0, 0.7, 1.4, 2.1)  # seconds ahead for which paths avoid walkers


class Surroundings:
    """Keeps scanned points that are not on the map: as tracks, people and obstacles."""

    def __init__(self, map_: OccupancyMap, laser: Pose, limits: MotionLimits) -> None:
        """Start empty.

        Args:
            map_: the map, whose walls are ignored.
            laser: pose of the scanner on the robot.
            limits: motion limits, also near people.
        """
        self._obstacles = Obstacles(map_, laser)
        self._tracker = PeopleTracker(laser)
        self._laser, self._limits = laser, limits
        self._pose = IDENTITY
        self._tracks: tuple[Track, ...] = ()
        self._unconfirmed: tuple[Track, ...] = ()
        self._returns: Floats = np.zeros((0, 2))
        self._ends = self._returns
        """Those of `_returns` (n, 2) that are not on the map; all in the robot's frame."""

    def see(self, estimate: Estimate, odometry: Pose, scan: Scan, dt: float) -> None:
        """Update with a scan at the estimated pose, `dt` s after the previous one."""
        self._pose = estimate.pose
        if estimate.spread < SURE:
            self._obstacles.see(estimate.pose, scan, dt)
        unmapped = self._obstacles.unmapped(estimate.pose, scan) if estimate.found else None
        tracks = self._tracker.update(odometry, scan, dt, unmapped)
        self._tracks = tuple(one.seen_from(odometry) for one in tracks)
        fast = self._limits.approach_turned
        self._unconfirmed = tuple(
            replace(one.seen_from(odometry), pace=fast) for one in self._tracker.unconfirmed
        )
        points = self._returns = endpoints(scan, REACH, self._laser)
        if unmapped is not None:
            points = points[self._obstacles.among(transform_points(points, estimate.pose))]
        self._ends = points

    def forget(self) -> None:
        """Forget all obstacles, for example if the estimated pose was wrong."""
        self._obstacles.forget()

    @property
    def tracks(self) -> tuple[Track, ...]:
        """Tracks, in the robot's frame."""
        return self._tracks

    @property
    def points(self) -> Floats:
        """Points of obstacles that are not on the map (n, 2), in the map's frame."""
        return self._obstacles.points

    @property
    def standing(self) -> Floats:
        """Points of obstacles (n, 2) without those of walking people.

        What has been there for `STAYS` remains: a track that takes one leg of several for another
        seems to walk, and the robot would plan through legs that stand.
        """
        points, walkers = self.points, self._walkers
        if not len(points) or not walkers:
            return points
        at = transform_points(np.array([(one.x, one.y) for one in walkers]), self._pose)
        apart = ((points[:, None] - at[None]) ** 2).sum(axis=2).min(axis=1)
        return np.asarray(points[(apart > WALKERS**2) | (self._obstacles.seconds > STAYS)])

    @property
    def walking(self) -> Floats:
        """Current and predicted positions of walking people (n, 2), in the map's frame."""
        found = [
            (one.x + one.vx * after, one.y + one.vy * after)
            for one in self._walkers
            for after in AHEAD
        ]
        return transform_points(np.array(found, dtype=np.float64).reshape(-1, 2), self._pose)

    def limited(self, twist: Twist) -> Twist:
        """Return the part of a command that may be driven near the people around.

        What a first scan shows may be a person who walks: until it is confirmed, it counts as one
        who walks as fast as people are assumed to.
        """
        around = NearbyPeople((*self._tracks, *self._unconfirmed), self._ends)
        return limit_near_people(twist, around, self._limits)

    def turned(self, twist: Twist) -> Twist:
        """Return the part of a turn on the spot that keeps corners clear of walls, too."""
        around = NearbyPeople((*self._tracks, *self._unconfirmed), self._returns)
        return limit_near_people(twist, around, self._limits)

    def held(self, twist: Twist) -> Blocker:
        """Return for what it stands or creeps instead; "" if it does not."""
        limited = self.limited(twist)
        if limited == twist or not _creeps(limited):
            return ""
        walkers = self._walkers
        if not _creeps(self._limited_without(walkers, twist)):
            return "walking"
        people = [one for one in self._tracks if one.person and one not in walkers]
        return "object" if _creeps(self._limited_without(walkers + people, twist)) else "standing"

    def _limited_without(self, left_out: Sequence[Track], twist: Twist) -> Twist:
        """Return the part of a command that may be driven if some tracks were not there."""
        others = [one for one in self._tracks if one not in left_out]
        ends = self._ends[~_near(self._ends, left_out)]
        return limit_near_people(twist, NearbyPeople(others, ends), self._limits)

    @property
    def _walkers(self) -> list[Track]:
        return [one for one in self._tracks if one.speed > WALKS]


def _creeps(twist: Twist) -> bool:
    return abs(twist.forward) < CREEPS.forward and abs(twist.turn) < CREEPS.turn


def _near(points: Floats, tracks: Sequence[Track]) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    near = np.zeros(len(points), dtype=np.bool_)
    for one in tracks:
        near |= lengths(points - (one.x, one.y)) < WALKERS
    return near
