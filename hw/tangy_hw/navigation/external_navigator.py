"""Navigation by the robot's own stack: sends it goals, and cancels them.

Its velocity commands do not pass through Tangy. If the robot must not drive, the goal is cancelled,
and sent again once the robot may drive. Until the robot confirms the cancellation, it counts as
driving, and the owner of this object commands the base to stop. A person who walks into the robot's
way also cancels the goal, because Tangy cannot change the robot's speed here.
"""

from __future__ import annotations

import asyncio
from math import pi

import numpy as np

from tangy_hw.device_protocols import STILL, ExternalNavigation, Odometry, Pose, Scan, Twist
from tangy_hw.navigation.clearance import REACH
from tangy_hw.navigation.limits import MotionLimits
from tangy_hw.navigation.localisation import Estimate
from tangy_hw.navigation.navigator import SPIN, State
from tangy_hw.navigation.people_guard import WALKS, NearbyPeople, limit_near_people
from tangy_hw.navigation.people_tracker import PeopleTracker, Track
from tangy_hw.navigation.poses import IDENTITY, Floats, endpoints
from tangy_hw.navigation.surroundings import Blocker
from tangy_profiles.health import Fact, Reading

AGAIN_SECONDS = 0.5  # seconds that the robot must be allowed to drive before the goal is sent again
CLEARING_SECONDS = 10.0  # seconds that people get to clear a path, which cannot be checked


class ExternalNavigator:
    """Drives to goals with a robot's own localisation and planner."""

    def __init__(
        self,
        navigation: ExternalNavigation,
        limits: MotionLimits | None = None,
        laser: Pose = IDENTITY,
    ) -> None:
        """Start without a goal; `laser` is the pose of the scanner on the robot."""
        self.state: State = "idle"
        self.why = ""
        """Reason for `failed` or `blocked`: one sentence."""
        self.path = None
        self.yields_to: Blocker = ""
        """What it waits for: a person who walks into its way, or what is too close to turn."""
        self.tracks: tuple[Track, ...] = ()
        self._tracker, self._limits = PeopleTracker(laser), limits or MotionLimits()
        self._laser, self._ends = laser, np.zeros((0, 2))
        self.obstacles: Floats = np.zeros((0, 2))
        self.unseen: Floats = np.zeros((0, 2))
        self.particles: Floats = np.zeros((0, 3))
        self._navigation = navigation
        self._goal: Pose | None = None
        self._driving: asyncio.Task[None] | None = None
        self._ending: set[asyncio.Task[None]] = set()
        self._allowed, self._turned = AGAIN_SECONDS, 0.0
        self._since_blocked = CLEARING_SECONDS

    # ------------------------------------------------------------------------------- commands
    def go(self, goal: Pose) -> None:
        """Set a goal, which the next tick sends; `state` and `why` report the progress."""
        self.cancel()
        self.state, self._goal = "driving", goal

    def spin(self) -> None:
        """Turn once on the spot, so that the robot's localisation sees the whole room."""
        self.cancel()
        self.state, self._turned = "spinning", 0.0

    def cancel(self) -> None:
        """Cancel the goal."""
        self._call_off()
        self.state, self.why, self._goal = "idle", "", None

    def held(self) -> None:
        """Cancel the goal until the robot may drive again."""
        self._allowed = 0.0
        self._call_off()

    def place(self, pose: Pose | None) -> None:
        """Send the robot its pose, as given by staff; None (unknown pose) is ignored.

        Raises:
            DeviceError: the robot cannot be reached.
        """
        if pose is not None:
            self._navigation.place(pose)

    def finds_way(self, goal: Pose) -> bool:
        """Return whether people have had time to clear the path."""
        return self._since_blocked >= CLEARING_SECONDS

    def tick(
        self, odometry: Odometry, scan: Scan | None, dt: float, at_scan: Pose | None = None
    ) -> Twist:
        """Send the goal if the robot may drive, or return the twist of a spin; `dt` is in s."""
        self._allowed += dt
        self._since_blocked += dt
        self._watch(odometry, scan, dt, odometry.pose if at_scan is None else at_scan)
        if self.state == "spinning":
            self._turned += abs(odometry.twist.turn) * dt
            if self._turned < 2 * pi:
                around = NearbyPeople(self.tracks, self._ends)
                spin = limit_near_people(Twist(0.0, SPIN), around, self._limits)
                self.yields_to = "object" if spin == STILL else ""
                return spin
            self.state = "idle"
        goal = self._goal if self.state == "driving" and not self.drives else None
        if goal is not None and self._allowed >= AGAIN_SECONDS:
            self._driving = asyncio.create_task(self._drive(goal))
        return STILL

    def _watch(self, odometry: Odometry, scan: Scan | None, dt: float, at_scan: Pose) -> None:
        """Track people, and hold the robot for a person who walks into its way."""
        if scan is None:
            return
        tracks = self._tracker.update(at_scan, scan, dt)
        self._ends = endpoints(scan, REACH, self._laser)
        self.tracks = tuple(one.seen_from(at_scan) for one in tracks)
        if self.yields_to and self._allowed < AGAIN_SECONDS:
            return  # go on after nobody has come for a moment
        walking = [one for one in self.tracks if one.speed > WALKS]
        meets = (
            limit_near_people(odometry.twist, NearbyPeople(walking, np.zeros((0, 2))), self._limits)
            == STILL
        )
        self.yields_to = "walking" if self.drives and meets and odometry.twist != STILL else ""
        if self.yields_to:
            self.held()

    # -------------------------------------------------------------- state
    @property
    def drives(self) -> bool:
        """Whether a goal is active, or its cancellation is not confirmed yet."""
        return self._driving is not None or bool(self._ending)

    @property
    def estimate(self) -> Estimate | None:
        """Pose that the robot reports; None before the first one."""
        if self._navigation.pose is None:
            return None
        fit, spread = self._sure()
        return Estimate(self._navigation.pose.value, np.zeros((3, 3)), spread, fit, 0)

    def facts(self) -> dict[str, Fact]:
        """Return path, fit and spread; slip and still are 0, because they are not measured here."""
        fit, spread = self._sure()
        return {"path": self._way(), "fit": fit, "spread": spread, "slip": 0.0, "still": 0.0}

    def readings(self, age: float = 0.0) -> tuple[Reading, Reading]:
        """Return the readings of "localisation" and "navigator"; `age` in s is a lower bound."""
        place, way = self._navigation.localisation(), self._navigation.reading()
        return (
            place._replace(device="localisation", age=max(place.age, age)),
            Reading("navigator", max(way.age, age), way.state, {"path": self._way()}, way.rate),
        )

    def _sure(self) -> tuple[float, float]:
        facts = self._navigation.localisation().facts
        return float(facts["fit"]), float(facts["spread"])

    def _way(self) -> Fact:
        if self.state == "blocked":
            return "none"
        driving = self._driving is not None
        return self._navigation.reading().facts["path"] if driving else "clear"

    # ------------------------------------------------------------------ its goal at the robot
    async def _drive(self, goal: Pose) -> None:
        if self._driving is not asyncio.current_task():  # cancelled before it started
            return
        state: State = "arrived"
        why = ""
        try:
            await self._navigation.go(goal)
        except Exception as error:  # any error ends the drive
            none = self._navigation.reading().facts["path"] == "none"
            state, why = "blocked" if none else "failed", str(error)
        if self._driving is asyncio.current_task():  # not cancelled meanwhile
            self._driving = None
            self.state, self.why = state, why
            if state == "blocked":
                self._since_blocked = 0.0

    def _call_off(self) -> None:
        driving, self._driving = self._driving, None
        if driving is not None:
            ending = asyncio.create_task(self._end(driving))
            self._ending.add(ending)
            ending.add_done_callback(self._ending.discard)

    async def _end(self, driving: asyncio.Task[None]) -> None:
        try:
            await self._navigation.cancel()
        finally:
            driving.cancel()
