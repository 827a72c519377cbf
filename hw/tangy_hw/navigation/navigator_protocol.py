"""Protocol of localisation and path following, by Tangy's navigator or the robot's own."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol

from tangy_hw.device_protocols import Odometry, Pose, Scan, Twist
from tangy_hw.navigation.localisation import Estimate
from tangy_hw.navigation.navigator import State
from tangy_hw.navigation.people_tracker import Track
from tangy_hw.navigation.planning import Path
from tangy_hw.navigation.poses import Floats
from tangy_hw.navigation.surroundings import Blocker
from tangy_profiles.health import Fact, Reading


class NavigatorProtocol(Protocol):
    """Drives to a goal; updated with wheel odometry and laser scans."""

    @property
    def state(self) -> State:
        """Progress towards the goal."""
        ...

    @property
    def drives(self) -> bool:
        """Whether an external stack drives the base now; velocity commands alone do not stop it."""
        ...

    @property
    def estimate(self) -> Estimate | None:
        """Estimated pose; None if unknown."""
        ...

    @property
    def path(self) -> Path | None:
        """Current path, if known."""
        ...

    @property
    def yields_to(self) -> Blocker:
        """Kind of person it is waiting for, if any."""
        ...

    @property
    def tracks(self) -> tuple[Track, ...]:
        """Tracked people and objects that are not on the map, in the robot's frame."""
        ...

    @property
    def obstacles(self) -> Floats:
        """Seen points that are not on the map (n, 2)."""
        ...

    @property
    def unseen(self) -> Floats:
        """Keep-out points that no laser sees (n, 2), in the robot's frame, if known."""
        ...

    @property
    def particles(self) -> Floats:
        """Particles: possible poses (n, 3)."""
        ...

    def go(self, goal: Pose) -> None:
        """Start driving to a pose; a new goal replaces the previous one."""
        ...

    def spin(self) -> None:
        """Start turning on the spot, to localise the robot."""
        ...

    def cancel(self) -> None:
        """Stop, and drop the goal; never raises."""
        ...

    def held(self) -> None:
        """Record that the robot must not drive now."""
        ...

    def place(self, pose: Pose | None) -> None:
        """Set the pose given by staff; None: the robot may be anywhere."""
        ...

    def finds_way(self, goal: Pose) -> bool:
        """Return whether a blocked path to a goal may be free again."""
        ...

    def tick(
        self, odometry: Odometry, scan: Scan | None, dt: float, at_scan: Pose | None = None
    ) -> Twist:
        """Update with the latest data, and return the twist for the next `dt` s.

        `at_scan` is the pose by odometry when the scan was taken; None: that of `odometry`.
        """
        ...

    def facts(self) -> Mapping[str, Fact]:
        """Return path, fit, spread, slip and still, as the diagnosis expects them."""
        ...

    def readings(self, age: float = 0.0) -> tuple[Reading, Reading]:
        """Return the readings of "localisation" and "navigator", with their age in s."""
        ...
