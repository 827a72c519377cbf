"""Protocol of localisation and path following: our navigator, or the robot's own."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol

from tangy_hw.device_protocols import Odometry, Pose, Scan, Twist
from tangy_hw.navigation.localisation import Estimate
from tangy_hw.navigation.navigator import State
from tangy_hw.navigation.people_tracker import Track
from tangy_hw.navigation.planning import Path
from tangy_hw.navigation.poses import Floats
from tangy_hw.navigation.surroundings import Held
from tangy_profiles.health import Fact, Reading


class NavigatorProtocol(Protocol):
    """Takes a goal, then wheel odometry and laser scans again and again."""

    @property
    def state(self) -> State:
        """How it stands with the goal."""
        ...

    @property
    def drives(self) -> bool:
        """Whether an external navigation drives the base now; commands alone do not stop it."""
        ...

    @property
    def estimate(self) -> Estimate | None:
        """Where the robot thinks it is; None: that is not known yet."""
        ...

    @property
    def path(self) -> Path | None:
        """The path it follows, if known."""
        ...

    @property
    def lets(self) -> Held:
        """The kind of person it waits for, while it waits."""
        ...

    @property
    def tracks(self) -> tuple[Track, ...]:
        """The tracked people and things that are not on the map, in the robot's frame."""
        ...

    @property
    def obstacles(self) -> Floats:
        """Points seen that are not on the map, (n, 2)."""
        ...

    @property
    def unseen(self) -> Floats:
        """Keep-out points that no laser sees, (n, 2) in the robot's frame, if known."""
        ...

    @property
    def particles(self) -> Floats:
        """The poses it thinks possible (n, 3)."""
        ...

    def go(self, goal: Pose) -> None:
        """Begin to drive to a pose; another goal takes the place of the one before."""
        ...

    def spin(self) -> None:
        """Begin to turn on the spot, so that the robot finds itself."""
        ...

    def cancel(self) -> None:
        """Stand still, and forget the goal; never raises."""
        ...

    def held(self) -> None:
        """Take note that the robot must not drive now, whatever was to be."""
        ...

    def place(self, pose: Pose | None) -> None:
        """Take it that the robot is at a pose now (None: anywhere), as staff say."""
        ...

    def finds_way(self, goal: Pose) -> bool:
        """Say whether there may be a way again to where there was none."""
        ...

    def tick(self, odometry: Odometry, scan: Scan | None, dt: float) -> Twist:
        """Take the newest data, and return the base's command for the next `dt` s."""
        ...

    def facts(self) -> Mapping[str, Fact]:
        """Return path, fit, spread, slip and still, as the diagnosis knows them."""
        ...

    def readings(self, age: float = 0.0) -> tuple[Reading, Reading]:
        """Return the readings of "localisation" and "navigator", with their age in s."""
        ...
