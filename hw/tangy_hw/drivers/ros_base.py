"""A base through ROS: publishes geometry_msgs/Twist, subscribes to nav_msgs/Odometry."""

from __future__ import annotations

import asyncio
import logging
import math
from contextlib import suppress

from tangy_hw.device_protocols import STILL, DeviceError, Odometry, Stamped, Twist
from tangy_hw.drivers.latest_value import LatestValue
from tangy_hw.drivers.ros_messages import Message, odometry_of, stamp_of
from tangy_hw.drivers.ros_status import RosDiagnostics, state_told
from tangy_hw.drivers.ros_velocity import VelocityTopic
from tangy_hw.drivers.rosbridge import Rosbridge
from tangy_hw.drivers.velocity_watchdog import VelocityWatchdog
from tangy_profiles.health import Reading

_LOG = logging.getLogger(__name__)

LIVES_SECONDS = 0.2  # a command's time to live; see docs/decisions/faults.md
MOST_SECONDS = 1.0  # upper bound of this setting
REPEAT_SECONDS = 0.1  # between repetitions of a command; bases expect 10 Hz


class RosBase:
    """A base that drives by the latest command; velocity commands precede all other messages."""

    def __init__(
        self,
        bridge: Rosbridge,
        *,
        drive: str = "/cmd_vel",
        odometry: str = "/odom",
        stamped: bool = False,
        lives: float = LIVES_SECONDS,
        repeat: float = REPEAT_SECONDS,
        watchdog: VelocityWatchdog | None = None,
        diagnostics: RosDiagnostics | None = None,
    ) -> None:
        """Set its topics.

        Args:
            bridge: the link to the robot.
            drive: topic for velocity commands.
            odometry: topic of its odometry.
            stamped: it takes geometry_msgs/TwistStamped, as some ROS 2 bases do.
            lives: time to live of a command in s.
            repeat: s between repetitions of a command that still lives; 0: the caller repeats.
            watchdog: stops the base if this process hangs.
            diagnostics: diagnostics of the robot, if it publishes any.
        """
        self.name = "base"
        self._bridge, self._diagnostics = bridge, diagnostics
        self._velocity = VelocityTopic(bridge, drive, stamped=stamped)
        self._odometry_topic = odometry
        self._lives, self._repeat, self._watchdog = lives, repeat, watchdog
        self._newest: LatestValue[Odometry] = LatestValue(bridge.clock)
        self._twist, self._since = STILL, -math.inf
        self._moved = asyncio.Event()
        self._repeating: asyncio.Task[None] | None = None
        bridge.on_connect(self._connected)

    @property
    def odometry(self) -> Stamped[Odometry] | None:
        """The newest odometry; None before the first."""
        return self._newest.stamped

    async def start(self) -> None:
        """Subscribe to odometry; the base stands still until the first command."""
        await self._bridge.start()
        if self._repeating is None:
            self._newest.restart()
            self._velocity.advertise()
            if self._watchdog is not None:
                self._watchdog.start()
            self._bridge.subscribe(self._odometry_topic, "nav_msgs/Odometry", self._hear)
            self._repeating = asyncio.create_task(self._repeat_on())

    async def close(self) -> None:
        """Stop the base, and unsubscribe."""
        await self.stop()
        task, self._repeating = self._repeating, None
        if task is not None:
            self._bridge.unsubscribe(self._odometry_topic, self._hear)
            task.cancel()
            await asyncio.wait({task})
        if self._watchdog is not None:
            await self._watchdog.close()

    def reading(self) -> Reading:
        """Return the age of the odometry, and the state of the base in the diagnostics."""
        return self._newest.reading(self.name, state_told(self._diagnostics, self.name))

    async def drive(self, twist: Twist) -> None:
        """Drive at a twist until the next command, or until this one has expired.

        Raises:
            DeviceError: there is no link, or the twist is not finite.
        """
        if not all(map(math.isfinite, twist)):
            raise DeviceError(f"{self.name} cannot drive {twist}.")
        if self._repeating is None:
            raise DeviceError(f"{self.name} is switched off.")
        self._twist, self._since = twist, self._bridge.clock()
        self._moved.set()
        self._say(twist)

    async def stop(self) -> None:
        """Stop now; queued velocity commands are dropped."""
        _LOG.info("stops the wheels")
        self._twist = STILL
        with suppress(DeviceError):
            self._say(STILL)

    def _say(self, twist: Twist) -> None:
        self._velocity.say(twist)
        if self._watchdog is not None:  # only of what was sent: it stops the base if a link is lost
            self._watchdog.note(drives=twist != STILL)

    def _connected(self) -> None:
        """Stop at a new connection: the last command of the old one is unknown."""
        self._twist = STILL
        if self._repeating is not None:
            self._say(STILL)

    def _hear(self, message: Message) -> None:
        self._newest.take(odometry_of(message), stamp_of(message))

    async def _repeat_on(self) -> None:
        while True:
            await self._moved.wait()
            self._moved.clear()
            while self._repeat and self._twist != STILL:
                await asyncio.sleep(self._repeat)
                if self._bridge.clock() - self._since > self._lives:
                    await self.stop()
                elif self._twist != STILL:
                    with suppress(DeviceError):
                        self._velocity.say(self._twist)
