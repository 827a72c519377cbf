"""A laser scanner through ROS: sensor_msgs/LaserScan."""

from __future__ import annotations

from collections import deque

import numpy as np
from numpy.typing import NDArray

from tangy_hw.device_protocols import Scan, Stamped
from tangy_hw.drivers.latest_value import LatestValue
from tangy_hw.drivers.ros_messages import Message, changed_share, near_share, scan_of, stamp_of
from tangy_hw.drivers.ros_status import RosDiagnostics, state_told
from tangy_hw.drivers.rosbridge import Rosbridge
from tangy_profiles.health import Fact, Reading

NEAR = 0.15  # m, a hand's breadth: nearer returns come from an object that covers the scanner
WINDOW = 1.0  # s in which ranges change, unless the scanner is covered
SEEN = 0.8  # share of that time that scans must span before the change is reported


class RosLaser:
    """A scanner of a ROS robot; its reading has the same facts as that of `ScipLaser`."""

    def __init__(
        self,
        bridge: Rosbridge,
        *,
        topic: str = "/scan",
        turned: float = 0.0,
        diagnostics: RosDiagnostics | None = None,
    ) -> None:
        """Set its topic and mounting.

        Args:
            bridge: the link to the robot.
            topic: name of the topic.
            turned: rotation of the scanner to the left of the robot's front, in rad.
            diagnostics: diagnostics of the robot, if it publishes any.
        """
        self.name = "laser"
        self._bridge, self._topic, self._turned = bridge, topic, turned
        self._diagnostics = diagnostics
        self._newest: LatestValue[Scan] = LatestValue(bridge.clock)
        self._seen: deque[tuple[float, NDArray[np.float64]]] = deque()
        self._begun = False

    @property
    def scan(self) -> Stamped[Scan] | None:
        """The newest scan; None before the first."""
        return self._newest.stamped

    async def start(self) -> None:
        """Subscribe to its topic."""
        await self._bridge.start()
        if not self._begun:
            self._begun = True
            self._seen.clear()
            self._newest.restart()
            self._bridge.subscribe(self._topic, "sensor_msgs/LaserScan", self._hear)

    async def close(self) -> None:
        """Unsubscribe."""
        self._begun = False
        self._bridge.unsubscribe(self._topic, self._hear)

    def reading(self) -> Reading:
        """Return the age of the newest scan, and the facts about its view.

        `near_share` is the share of beams that end within a hand's breadth; `variety` the share
        that changed within a second, once a second was seen.
        """
        facts: dict[str, Fact] = {}
        if self._seen:
            facts["near_share"] = near_share(self._seen[-1][1], NEAR)
            if self._seen[-1][0] - self._seen[0][0] >= SEEN * WINDOW:
                facts["variety"] = changed_share([ranges for _, ranges in self._seen])
        return self._newest.reading(self.name, state_told(self._diagnostics, self.name), facts)

    def _hear(self, message: Message) -> None:
        scan, raw = scan_of(message, self._turned)
        self._newest.take(scan, stamp_of(message))
        now = self._bridge.clock()
        if self._seen and len(self._seen[-1][1]) != len(raw):
            self._seen.clear()  # its settings have changed
        self._seen.append((now, raw))
        while now - self._seen[0][0] > WINDOW:
            self._seen.popleft()
