"""Navigation by the robot's own stack: goals are handed to it, and cancelled there.

What that tells the base does not pass through our hands. So a robot that must not drive has its
goal called off, and goes on with it when it may again; until the robot has confirmed that, it
counts as driving, and the owner commands the base to stand. The same happens if a person walks into
its way: its speed cannot be changed here, but its goal can be cancelled.
"""

from __future__ import annotations

import asyncio
from math import pi

import numpy as np

from tangy_hw.device_protocols import STILL, Odometry, OwnNavigation, Pose, Scan, Twist
from tangy_hw.navigation.limits import MotionLimits
from tangy_hw.navigation.localisation import Estimate
from tangy_hw.navigation.navigator import SPIN, State
from tangy_hw.navigation.people_guard import WALKS, Around, passed
from tangy_hw.navigation.people_tracker import PeopleTracker, Track
from tangy_hw.navigation.poses import HERE, Floats
from tangy_hw.navigation.surroundings import Held
from tangy_profiles.health import Fact, Reading

AGAIN_SECONDS = 0.5  # for which it must be allowed to drive until it goes on
CLEARING_SECONDS = 10.0  # that people have to clear a way, which cannot be looked at before


class ExternalNavigator:
    """Lets a robot's own navigation find place and way."""

    def __init__(
        self, navigation: OwnNavigation, limits: MotionLimits | None = None, laser: Pose = HERE
    ) -> None:
        """Begin without a goal; `laser` is where the scanner sits on the robot."""
        self.state: State = "idle"
        self.why = ""
        """Why it failed or is blocked: one sentence."""
        self.path = None
        self.lets: Held = ""
        """The kind of person it waits for: one who walks into its way."""
        self.tracks: tuple[Track, ...] = ()
        self._tracker, self._limits = PeopleTracker(laser), limits or MotionLimits()
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
        """Send a goal at the next tick; `state` and `why` report its progress."""
        self.cancel()
        self.state, self._goal = "driving", goal

    def spin(self) -> None:
        """Turn on the spot once, by the wheels, so that the scans show its navigation the pose."""
        self.cancel()
        self.state, self._turned = "spinning", 0.0

    def cancel(self) -> None:
        """Call the goal off."""
        self._call_off()
        self.state, self.why, self._goal = "idle", "", None

    def held(self) -> None:
        """Call the goal off for now: the robot must not drive."""
        self._allowed = 0.0
        self._call_off()

    def place(self, pose: Pose | None) -> None:
        """Tell it where it is, as staff say; "anywhere" cannot be told.

        Raises:
            DeviceError: it does not hear.
        """
        if pose is not None:
            self._navigation.place(pose)

    def finds_way(self, goal: Pose) -> bool:
        """Say whether people have had the time to clear the way: only driving shows more."""
        return self._since_blocked >= CLEARING_SECONDS

    def tick(self, odometry: Odometry, scan: Scan | None, dt: float) -> Twist:
        """Hand the goal over when it may drive, and turn to look round; `dt` in s."""
        self._allowed += dt
        self._since_blocked += dt
        self._watch(odometry, scan, dt)
        if self.state == "spinning":
            self._turned += abs(odometry.twist.turn) * dt
            if self._turned < 2 * pi:
                return Twist(0.0, SPIN)
            self.state = "idle"
        goal = self._goal if self.state == "driving" and not self.drives else None
        if goal is not None and self._allowed >= AGAIN_SECONDS:
            self._driving = asyncio.create_task(self._drive(goal))
        return STILL

    def _watch(self, odometry: Odometry, scan: Scan | None, dt: float) -> None:
        """Track people, and make the robot wait for a person who walks into its way."""
        if scan is None:
            return
        tracks = self._tracker.update(odometry.pose, scan, dt)
        self.tracks = tuple(one.seen_from(odometry.pose) for one in tracks)
        if self.lets and self._allowed < AGAIN_SECONDS:
            return  # it goes on when nobody has come for a moment
        walking = [one for one in self.tracks if one.speed > WALKS]
        meets = passed(odometry.twist, Around(walking, np.zeros((0, 2))), self._limits) == STILL
        self.lets = "walking" if self.drives and meets and odometry.twist != STILL else ""
        if self.lets:
            self.held()

    # -------------------------------------------------------------- state
    @property
    def drives(self) -> bool:
        """Whether a goal is active, or its cancellation is not confirmed yet."""
        return self._driving is not None or bool(self._ending)

    @property
    def estimate(self) -> Estimate | None:
        """Where the robot says that it is; None before it has."""
        if self._navigation.pose is None:
            return None
        fit, spread = self._sure()
        return Estimate(self._navigation.pose.value, np.zeros((3, 3)), spread, fit, 0)

    def facts(self) -> dict[str, Fact]:
        """Return path, fit and spread; of how its wheels grip nothing is known."""
        fit, spread = self._sure()
        return {"path": self._way(), "fit": fit, "spread": spread, "slip": 0.0, "still": 0.0}

    def readings(self, age: float = 0.0) -> tuple[Reading, Reading]:
        """Return the readings of "localisation" and "navigator", their age in s the robot's own."""
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
        if self._driving is not asyncio.current_task():  # called off before it began
            return
        state: State = "arrived"
        why = ""
        try:
            await self._navigation.go(goal)
        except Exception as error:  # whatever it was, the drive is over
            none = self._navigation.reading().facts["path"] == "none"
            state, why = "blocked" if none else "failed", str(error)
        if self._driving is asyncio.current_task():  # it was not called off
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
