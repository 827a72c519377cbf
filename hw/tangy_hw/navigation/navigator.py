"""The navigator: localisation, path planning and path following.

It has no connections and no clock: about ten times a second, its owner passes wheel odometry and a
laser scan, and sends the returned twist to the base.
"""

from __future__ import annotations

from dataclasses import replace
from math import hypot, pi
from typing import Literal

import numpy as np
from numpy.random import Generator

from tangy_hw.device_protocols import STILL, Odometry, Pose, Scan, Twist
from tangy_hw.navigation.clearance import REACH
from tangy_hw.navigation.limits import MotionLimits
from tangy_hw.navigation.localisation import WIDE, Estimate, Localisation
from tangy_hw.navigation.occupancy import OccupancyMap
from tangy_hw.navigation.path_checks import comes_too_near, leaves
from tangy_hw.navigation.people_tracker import Track
from tangy_hw.navigation.planning import (
    FOOTPRINT,
    KEEP,
    RADIUS,
    Path,
    PlanError,
    check_goal,
    plan,
)
from tangy_hw.navigation.poses import (
    IDENTITY,
    Floats,
    compose,
    lengths,
    relative_pose,
    transform_points,
)
from tangy_hw.navigation.progress import ProgressCheck, StallDetector
from tangy_hw.navigation.pursuit import Pursuit
from tangy_hw.navigation.slip_detection import SlipDetector
from tangy_hw.navigation.surroundings import Blocker, Surroundings
from tangy_profiles.health import OK, Fact, Reading

State = Literal["idle", "driving", "spinning", "replanned", "blocked", "arrived", "failed"]
"""No goal; on its way; turning to localise itself; on another path; no path just now; at the goal;
no path possible, or not localised."""

PATIENCE = 1.0  # seconds that something may block the path before replanning
PATIENCE_WALKING = 3.0  # the same for a person who walks
AGAIN = 1.0  # seconds between two attempts to plan while there is no path
NO_WAY = 2.0  # seconds without a path before it is reported
SPIN = 0.5  # rad/s while it turns to localise itself
LOOKS_ROUND = 2  # full turns without a pose before it gives up
ASTRAY = 0.5  # metres off the path at which it replans
TAKEN = 0.6  # metres driven on another path before it is reported: it may end as well
SLOW = 0.1  # m/s: above this the robot stops before it takes another path
SLIPS = 0.3  # metres of disagreement with the scans that mean slip


class Navigator:
    """Drives a robot to goals on a map."""

    def __init__(
        self,
        map_: OccupancyMap,
        rng: Generator,
        start: Pose | None = None,
        *,
        limits: MotionLimits | None = None,
        laser: Pose = IDENTITY,
        people: Floats | None = None,
    ) -> None:
        """Start at a pose.

        Args:
            map_: the map.
            rng: the random generator.
            start: the robot's pose, within some 10 cm; None: it may be anywhere.
            limits: the motion limits.
            laser: pose of the scanner on the robot.
            people: positions where people may be (n, 2); the robot drives slowly near them.
        """
        self.map = map_
        self.limits = limits or MotionLimits()
        self.people = np.zeros((0, 2)) if people is None else people
        self.state: State = "idle"
        self.why = ""
        """Reason for `failed` or `blocked`: one sentence."""
        self.goal: Pose | None = None
        self.path: Path | None = None
        self.slip = 0.0
        larger = self.limits.radius - FOOTPRINT
        self._radius, self._keep, self._laser = RADIUS + larger, KEEP + larger, laser
        self._localisation = Localisation(map_, rng, start, laser)
        self._around = Surroundings(map_, laser, self.limits)
        self._slip_detector = SlipDetector(laser)
        self._stall_detector, self._progress = StallDetector(), ProgressCheck()
        self.yields_to: Blocker = ""
        """Kind of person it is waiting for, if any."""
        self._pursuit: Pursuit | None = None
        self._given_up: Floats | None = None
        self._way = "clear"
        self._estimate: Estimate | None = None
        self._told = STILL
        self._turned = self._turn_to = 0.0
        self._waited = self._without = self._since_plan = 0.0
        self._detour: tuple[float, float] | None = None

    drives = False
    """The base is driven only by the commands that `tick` returns."""

    # ------------------------------------------------------------------------------- commands
    def go(self, goal: Pose) -> None:
        """Drive to a pose; a new goal replaces the previous one.

        `state` (failed) and `why` report a problem with the goal.
        """
        self.cancel()
        self.goal = goal
        try:
            check_goal(self.map, (goal.x, goal.y), self._radius)
        except PlanError as error:
            self.state, self.why = "failed", str(error)
            return
        self.state = "driving"
        self._since_plan = AGAIN
        self._without = 0.0

    def spin(self, angle: float = 2 * pi) -> None:
        """Turn slowly on the spot by an angle in rad, to localise the robot."""
        if self.state != "spinning":
            self.cancel()
        self.state = "spinning"
        self._turned, self._turn_to = 0.0, angle

    def replan(self) -> None:
        """Plan a new path to the goal, even if the current one is not blocked."""
        if self.goal is not None and self.state not in ("arrived", "failed"):
            self._since_plan = AGAIN
            self._pursuit = None

    def cancel(self) -> None:
        """Stop, and drop the goal."""
        self.state, self.why, self.goal = "idle", "", None
        self._stop_following()
        self._way = "clear"

    def held(self) -> None:
        """Record that the robot must stop now, despite the last command."""
        self._told = STILL

    def place(self, pose: Pose | None) -> None:
        """Set the pose given by staff; None: the robot may be anywhere."""
        self._localisation.place(pose)
        self._around.forget()
        self._stop_following()

    def finds_way(self, goal: Pose) -> bool:
        """Return whether a path leads from here past everything that is seen.

        What seems to walk counts as well: it may be a chair, and the path would not be free.
        """
        if self._estimate is None:
            return False
        here = self._estimate.pose
        ends = (here.x, here.y), (goal.x, goal.y)
        return plan(self.map, *ends, self._around.points, self._radius, self._keep) is not None

    # -------------------------------------------------------------- state
    @property
    def estimate(self) -> Estimate | None:
        """Estimated pose; None before the first scan."""
        return self._estimate

    @property
    def tracks(self) -> tuple[Track, ...]:
        """Tracked people and objects that are not on the map, in the robot's frame."""
        return self._around.tracks

    @property
    def obstacles(self) -> Floats:
        """Seen points that are not on the map (n, 2)."""
        return self._around.points

    @property
    def unseen(self) -> Floats:
        """Keep-out points that no laser sees, such as the edge of a table top (n, 2).

        In the robot's frame; none if the robot is not localised.
        """
        estimate = self._estimate
        if estimate is None or not estimate.found:
            return np.zeros((0, 2))
        pose, edge = estimate.pose, self.map.keep_out_edge
        edge = edge[lengths(edge - (pose.x, pose.y)) < REACH]
        return transform_points(edge, relative_pose(pose, IDENTITY))

    @property
    def particles(self) -> Floats:
        """Particles: possible poses (n, 3)."""
        return self._localisation.particles

    def facts(self) -> dict[str, Fact]:
        """Return path, fit, spread, slip and still, as the diagnosis expects them."""
        estimate = self._estimate
        return {
            "path": self._way,
            "fit": estimate.fit if estimate else 1.0,
            "spread": estimate.spread if estimate else 0.0,
            "slip": self.slip,
            "still": self._stall_detector.seconds,
        }

    def readings(self, age: float = 0.0) -> tuple[Reading, Reading]:
        """Return the readings of "localisation" and "navigator"; `age` is in s."""
        facts = self.facts()
        place = {"fit": facts["fit"], "spread": facts["spread"]}
        return (
            Reading("localisation", age, OK, place),
            Reading("navigator", age, OK, {"path": facts["path"]}),
        )

    # ------------------------------------------------------------------ driving
    def tick(
        self, odometry: Odometry, scan: Scan | None, dt: float, at_scan: Pose | None = None
    ) -> Twist:
        """Update with the latest odometry and scan, and return the twist for the next `dt` s.

        Without a scan the robot stops, because it cannot see obstacles.

        Args:
            odometry: the latest odometry.
            scan: the latest scan.
            dt: s until the next tick.
            at_scan: the pose by odometry when the scan was taken; None: that of `odometry`.
        """
        self._stall_detector.update(odometry.pose, self._told, dt)
        if scan is None:
            self._told = STILL
            return STILL
        then = odometry.pose if at_scan is None else at_scan
        seen = self._localisation.update(then, scan)
        self.slip = self._slip_detector.update(then, scan)
        self._around.see(seen, then, scan, dt)
        now = compose(seen.pose, relative_pose(then, odometry.pose))
        estimate = self._estimate = replace(seen, pose=now)
        self._told = self._command(estimate, odometry, scan, dt)
        return self._told

    def _command(self, estimate: Estimate, odometry: Odometry, scan: Scan, dt: float) -> Twist:
        if self.state == "spinning":
            return self._spin(estimate, odometry, dt)
        if self.goal is None or self.state in ("idle", "arrived", "failed"):
            return STILL
        if estimate.lost or estimate.spread > WIDE:
            self._turned, self._turn_to = 0.0, 2 * pi
            self.state = "spinning"
            self._stop_following()
            self._around.forget()
            return STILL
        self._since_plan += dt
        if self._pursuit is None:
            self._find_way(estimate.pose, self.goal, dt)
        if self._pursuit is None:
            return STILL
        return self._follow(self._pursuit, self.goal, estimate.pose, odometry, scan, dt)

    def _spin(self, estimate: Estimate, odometry: Odometry, dt: float) -> Twist:
        self._turned += abs(odometry.twist.turn) * dt
        if self.goal is not None:  # it turns until it is localised
            done = estimate.found and self._turned > pi / 2
            if not done and self._turned >= LOOKS_ROUND * 2 * pi:
                self.state, self.why = "failed", "It does not find its place."
                return STILL
        else:
            done = self._turned >= abs(self._turn_to)
        if done:
            self.state = "idle" if self.goal is None else "driving"
            self._since_plan, self.yields_to = AGAIN, ""
            return STILL
        spin = Twist(0.0, SPIN if self._turn_to > 0 else -SPIN)
        safe = self._around.turned(spin)
        self.yields_to = ""
        if safe == STILL:  # there may be room for its corners the other way
            self.yields_to = self._around.held(spin) or "object"
            self._turn_to = -self._turn_to
        return safe

    def _find_way(self, pose: Pose, goal: Pose, dt: float) -> None:
        """Plan from time to time; report if there has been no path for a while."""
        self._without += dt
        if self._since_plan >= AGAIN:
            self._since_plan = 0.0
            path = self._plan(pose, goal)
            if path is not None:
                self._take(path, goal, pose)
                return
        if self._without >= NO_WAY:
            self._block("Something stands in every way there.")

    def _plan(self, pose: Pose, goal: Pose) -> Path | None:
        ends = (pose.x, pose.y), (goal.x, goal.y)
        standing, walking = self._around.standing, self._around.walking
        return plan(self.map, *ends, standing, self._radius, self._keep, walking)

    def _take(self, path: Path, goal: Pose, pose: Pose) -> None:
        """Follow a path; a detour from an abandoned path is reported once it is driven."""
        if self._way == "none":  # the path is free again
            self._way = "clear"
        elif self._given_up is not None and leaves(path.points, self._given_up):
            self._detour = (pose.x, pose.y)
        self.state = "replanned" if self._way == "replanned" else "driving"
        self.why = ""
        self.path = path
        self._pursuit = Pursuit(path.points, goal.heading, self.limits, self._laser)
        self._given_up = None
        self._waited = self._without = 0.0

    def _block(self, why: str) -> None:
        self.state, self._way, self.why = "blocked", "none", why

    def _stop_following(self) -> None:
        self.path = self._pursuit = self._given_up = None
        self.yields_to = ""
        self._waited = self._without = 0.0
        self._detour = None
        self._progress.restart()

    def _follow(
        self, pursuit: Pursuit, goal: Pose, pose: Pose, odometry: Odometry, scan: Scan, dt: float
    ) -> Twist:
        ahead = pursuit.ahead
        if lengths(ahead[:1] - (pose.x, pose.y))[0] > ASTRAY:  # localisation jumped
            self._pursuit = None
            return STILL
        gone = self._detour
        if gone is not None and hypot(pose.x - gone[0], pose.y - gone[1]) > TAKEN:
            self.state, self._way, self._detour = "replanned", "replanned", None
        obstacles = self._around.standing
        wary_of = np.vstack((self.people, obstacles))
        wanted = pursuit.command(
            pose, self.limits.reached(self._told, odometry.twist), scan, dt, wary_of
        )
        twist = self._around.limited(wanted)
        if pursuit.state == "arrived":
            self.state, self._way = "arrived", "clear"
            self._stop_following()
            return STILL
        self.yields_to = self._around.held(wanted)
        stands = pursuit.state == "waiting" or (self.yields_to != "" and twist == STILL)
        if stands or comes_too_near(ahead, obstacles, pose, goal, self._radius, self._keep):
            self._waited += dt
        else:
            self._waited = 0.0
        patience = PATIENCE_WALKING if self.yields_to == "walking" else PATIENCE
        if self._waited >= patience and self._since_plan >= AGAIN:
            self._since_plan = 0.0
            path, self._given_up = self._plan(pose, goal), ahead
            if path is not None:
                self._take(path, goal, pose)
                return twist if twist.forward < SLOW else STILL
            self._pursuit = None
            return STILL
        # slipping wheels do not count against it
        slips = self._stall_detector.seconds > 0.5 or self.slip > SLIPS
        if not self._progress.made(pose, dt, excused=slips):
            self._pursuit, self._given_up, self._since_plan = None, ahead, -AGAIN
            self._progress.restart()
            self._block("It comes no further.")
            return STILL
        return twist
