"""Status of a robot through ROS: its diagnostics, and its emergency stop."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from tangy_hw.drivers.latest_value import LatestValue
from tangy_hw.drivers.ros_messages import Message, statuses_of
from tangy_hw.drivers.rosbridge import Rosbridge
from tangy_profiles.health import ERROR, OK, STALE, WARN, DeviceState, Reading

HOLDS_SECONDS = 5.0  # for which a status is valid; ROS publishes one a second
NAMES = 500  # statuses kept per message
WORSE = (OK, WARN, STALE, ERROR)


class DeviceStatus(NamedTuple):
    """Status of a device: its state, a sentence, values, and time of arrival."""

    state: DeviceState
    says: str
    values: Mapping[str, str]
    stamp: float


class RosDiagnostics:
    """Latest status of each device, from diagnostic_msgs/DiagnosticArray.

    A status belongs to the device named by the last part of its name, up to a colon: "/robot/Stop
    Button: state" belongs to stop_button.
    """

    def __init__(
        self,
        bridge: Rosbridge,
        *,
        name: str = "diagnostics",
        topic: str = "/diagnostics",
        names: Mapping[str, str] | None = None,
    ) -> None:
        """Set the topic.

        Args:
            bridge: the link to the robot.
            name: its name in the robot's profile.
            topic: name of the topic.
            names: devices by the names of their statuses, if these follow another scheme.
        """
        self.name = name
        self._bridge, self._topic = bridge, topic
        self._names = dict(names or {})
        self._newest: LatestValue[None] = LatestValue(bridge.clock)
        self._said: dict[str, dict[str, DeviceStatus]] = {}
        self._begun = False

    async def start(self) -> None:
        """Subscribe to the topic."""
        await self._bridge.start()
        if not self._begun:
            self._begun = True
            self._bridge.subscribe(self._topic, "diagnostic_msgs/DiagnosticArray", self._hear)

    async def close(self) -> None:
        """Unsubscribe."""
        self._begun = False
        self._bridge.unsubscribe(self._topic, self._hear)

    def reading(self) -> Reading:
        """Return the age of the newest message."""
        return self._newest.reading(self.name)

    def of(self, device: str) -> DeviceStatus | None:
        """Return the worst current status of a device; None if there is none."""
        now = self._bridge.clock()
        said = self._said.get(device, {}).values()
        held = [one for one in said if now - one.stamp <= HOLDS_SECONDS]
        return max(held, key=lambda one: WORSE.index(one.state), default=None)

    def age(self, device: str) -> float | None:
        """Return the age of a device's newest status in s; None if there was none."""
        stamps = [one.stamp for one in self._said.get(device, {}).values()]
        return max(self._bridge.clock() - max(stamps), 0.0) if stamps else None

    def device(self, name: str) -> str:
        """Return the device that a status belongs to, by the name of the status."""
        if name in self._names:
            return self._names[name]
        return name.split(":")[0].rstrip("/").split("/")[-1].strip().lower().replace(" ", "_")

    def _hear(self, message: Message) -> None:
        statuses = statuses_of(message)
        self._newest.take(None)
        for name, state, says, values in statuses[:NAMES]:
            diagnosis = DeviceStatus(state, says, values, self._bridge.clock())
            self._said.setdefault(self.device(name), {})[name] = diagnosis


def state_told(diagnostics: RosDiagnostics | None, device: str) -> DeviceState:
    """Return the state of a device by the diagnostics; OK if they do not mention it."""
    diagnosis = None if diagnostics is None else diagnostics.of(device)
    return OK if diagnosis is None else diagnosis.state


class RosStopButton:
    """An emergency stop that keeps publishing on std_msgs/Bool whether it is pressed."""

    def __init__(
        self,
        bridge: Rosbridge,
        *,
        topic: str = "/stop_button",
        pressed: bool = True,
        changes_only: bool = False,
    ) -> None:
        """Set its topic.

        Args:
            bridge: the link to the robot.
            topic: name of the topic.
            pressed: value that means pressed; some publish False.
            changes_only: it publishes changes only, so its age is that of the link.
        """
        self.name = "stop_button"
        self._bridge, self._topic = bridge, topic
        self._pressed, self._changes_only = pressed, changes_only
        self._newest: LatestValue[bool] = LatestValue(bridge.clock)
        self._begun = False

    @property
    def latched(self) -> bool:
        """Whether it is pressed."""
        return self._newest.stamped is not None and self._newest.stamped.value

    async def start(self) -> None:
        """Subscribe to the topic."""
        await self._bridge.start()
        if not self._begun:
            self._begun = True
            self._newest.restart()
            self._bridge.subscribe(self._topic, "std_msgs/Bool", self._hear)

    async def close(self) -> None:
        """Unsubscribe."""
        self._begun = False
        self._bridge.unsubscribe(self._topic, self._hear)

    def reading(self) -> Reading:
        """Return the fact whether it is pressed, with the age of that message."""
        reading = self._newest.reading(self.name, OK, {"latched": self.latched})
        if self._changes_only and self._newest.stamped is not None:
            reading = reading._replace(age=min(reading.age, self._bridge.reading().age))
        return reading

    def _hear(self, message: Message) -> None:
        if not isinstance(message["data"], bool):
            raise TypeError("it says neither yes nor no")
        self._newest.take(message["data"] == self._pressed)
