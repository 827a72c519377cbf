"""Dead reckoning: the pose by wheel odometry alone, while staff drive without a map.

It plans no paths. It tracks people as `Navigator` does, so that driving by keys slows down near
them, and records scans from which a map can be drawn.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from tangy_hw.device_protocols import STILL, Odometry, Pose, Scan, Twist
from tangy_hw.navigation.localisation import Estimate
from tangy_hw.navigation.navigator import State
from tangy_hw.navigation.people_tracker import PeopleTracker, Track
from tangy_hw.navigation.planning import Path
from tangy_hw.navigation.poses import IDENTITY, Floats, compose, relative_pose
from tangy_hw.navigation.scan_recorder import ScanRecorder
from tangy_hw.navigation.surroundings import Blocker
from tangy_profiles.health import ERROR, OK, DeviceState, Fact, Reading

NOWHERE: Floats = np.zeros((0, 2))


class DeadReckoning:
    """Integrates wheel odometry from a start pose; implements `NavigatorProtocol`."""

    drives = False
    state: State = "idle"
    path: Path | None = None
    yields_to: Blocker = ""
    obstacles = unseen = NOWHERE
    particles: Floats = np.zeros((0, 3))

    def __init__(
        self, recorder: ScanRecorder, start: Pose = IDENTITY, laser: Pose = IDENTITY
    ) -> None:
        """Start at a pose.

        Args:
            recorder: records the scans.
            start: the robot's pose in the frame of the new map.
            laser: pose of the scanner on the robot.
        """
        self._recorder, self._laser = recorder, laser
        self._pose = start
        self._odometry: Pose | None = None
        self._time = 0.0
        self._tracker = PeopleTracker(laser)
        self.tracks: tuple[Track, ...] = ()

    @property
    def estimate(self) -> Estimate:
        """Pose by wheel odometry; its error is unknown."""
        return Estimate(self._pose, np.zeros((3, 3)), 0.0, 1.0, 1)

    def tick(
        self, odometry: Odometry, scan: Scan | None, dt: float, at_scan: Pose | None = None
    ) -> Twist:
        """Update pose and tracks for `dt` s and record the scan; always return a zero twist."""
        if self._odometry is not None:
            self._pose = compose(self._pose, relative_pose(self._odometry, odometry.pose))
        self._odometry = odometry.pose
        self._time += dt
        if scan is not None:
            then = odometry.pose if at_scan is None else at_scan
            tracks = self._tracker.update(then, scan, dt, None)
            self.tracks = tuple(one.seen_from(then) for one in tracks)
            pose = compose(self._pose, relative_pose(odometry.pose, then))
            self._recorder.note(scan, compose(pose, self._laser), self._time)
        return STILL

    def go(self, goal: Pose) -> None:
        """Do nothing: there is no map to plan on."""

    def spin(self) -> None:
        """Do nothing: there is no map to localise on."""

    def cancel(self) -> None:
        """Do nothing: the robot never drives by itself."""

    def held(self) -> None:
        """Do nothing: the robot never drives by itself."""

    def place(self, pose: Pose | None) -> None:
        """Set the pose, as given by staff; None keeps the current one."""
        self._pose = self._pose if pose is None else pose

    def finds_way(self, goal: Pose) -> bool:
        """Return False: there is no map to plan on."""
        return False

    def facts(self) -> Mapping[str, Fact]:
        """Return path, fit, spread, slip and still, with values that report no problem."""
        return {"path": "clear", "fit": 1.0, "spread": 0.0, "slip": 0.0, "still": 0.0}

    def readings(self, age: float = 0.0) -> tuple[Reading, Reading]:
        """Return the readings of "localisation" and "navigator"; `age` is in s.

        Localisation is in error if the scans cannot be recorded.
        """
        state: DeviceState = ERROR if self._recorder.failed else OK
        return (
            Reading("localisation", age, state, {"fit": 1.0, "spread": 0.0}),
            Reading("navigator", age, OK, {"path": "clear"}),
        )
