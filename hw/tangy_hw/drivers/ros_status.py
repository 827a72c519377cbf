"""Status of a robot behind ROS: its diagnostics, and its emergency stop."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from tangy_hw.drivers.ros_messages import Message, statuses_of
from tangy_hw.drivers.ros_newest import Newest
from tangy_hw.drivers.rosbridge import Rosbridge
from tangy_profiles.health import ERROR, OK, STALE, WARN, DeviceState, Reading

HOLDS_SECONDS = 5.0  # for which a diagnosis holds; ROS tells one a second
NAMES = 500  # diagnoses that are kept
WORSE = (OK, WARN, STALE, ERROR)


class DeviceStatus(NamedTuple):
    """The status of a device: its state, a sentence, values, and when it arrived."""

    state: DeviceState
    says: str
    values: Mapping[str, str]
    stamp: float


class RosDiagnostics:
    """The newest diagnosis of each device, from diagnostic_msgs/DiagnosticArray.

    A diagnosis is of the device whose name is the last part of its own, before a colon:
    "/robot/Stop Button: state" is of stop_button.
    """

    def __init__(
        self,
        bridge: Rosbridge,
        *,
        name: str = "diagnostics",
        topic: str = "/diagnostics",
        names: Mapping[str, str] | None = None,
    ) -> None:
        """Name the topic.

        Args:
            bridge: the link to the robot.
            name: of the device, as in the profile of the robot.
            topic: its name.
            names: devices by how their diagnoses are named, where that is otherwise.
        """
        self.name = name
        self._bridge, self._topic = bridge, topic
        self._names = dict(names or {})
        self._newest: Newest[None] = Newest(bridge.clock)
        self._said: dict[str, dict[str, DeviceStatus]] = {}
        self._begun = False

    async def start(self) -> None:
        """Begin to hear them."""
        await self._bridge.start()
        if not self._begun:
            self._begun = True
            self._bridge.subscribe(self._topic, "diagnostic_msgs/DiagnosticArray", self._hear)

    async def close(self) -> None:
        """End."""
        self._begun = False
        self._bridge.unsubscribe(self._topic, self._hear)

    def reading(self) -> Reading:
        """Return the age of the newest of them."""
        return self._newest.reading(self.name)

    def of(self, device: str) -> DeviceStatus | None:
        """Return the worst that is said of a device now; None: nothing is, or not any more."""
        now = self._bridge.clock()
        said = self._said.get(device, {}).values()
        held = [one for one in said if now - one.stamp <= HOLDS_SECONDS]
        return max(held, key=lambda one: WORSE.index(one.state), default=None)

    def age(self, device: str) -> float | None:
        """Return how long ago anything was said of a device, in s; None: never."""
        stamps = [one.stamp for one in self._said.get(device, {}).values()]
        return max(self._bridge.clock() - max(stamps), 0.0) if stamps else None

    def device(self, name: str) -> str:
        """Return which device a diagnosis of some name is of."""
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
    """Return the state that diagnostics give a device; OK where they say nothing of it."""
    diagnosis = None if diagnostics is None else diagnostics.of(device)
    return OK if diagnosis is None else diagnosis.state


class RosStopButton:
    """An emergency stop that says on std_msgs/Bool whether it is pressed, again and again."""

    def __init__(
        self,
        bridge: Rosbridge,
        *,
        name: str = "stop_button",
        topic: str = "/stop_button",
        pressed: bool = True,
        changes_only: bool = False,
    ) -> None:
        """Name its topic.

        Args:
            bridge: the link to the robot.
            name: of the device, as in the profile of the robot.
            topic: its name.
            pressed: what it says when it is pressed; some say that they are not.
            changes_only: it speaks when it changes alone, so its age is that of the link.
        """
        self.name = name
        self._bridge, self._topic = bridge, topic
        self._pressed, self._changes_only = pressed, changes_only
        self._newest: Newest[bool] = Newest(bridge.clock)
        self._begun = False

    @property
    def latched(self) -> bool:
        """Whether it is pressed."""
        return self._newest.stamped is not None and self._newest.stamped.value

    async def start(self) -> None:
        """Begin to hear it."""
        await self._bridge.start()
        if not self._begun:
            self._begun = True
            self._newest.restart()
            self._bridge.subscribe(self._topic, "std_msgs/Bool", self._hear)

    async def close(self) -> None:
        """End."""
        self._begun = False
        self._bridge.unsubscribe(self._topic, self._hear)

    def reading(self) -> Reading:
        """Return whether it is pressed, and how long ago it said so."""
        reading = self._newest.reading(self.name, OK, {"latched": self.latched})
        if self._changes_only and self._newest.stamped is not None:
            reading = reading._replace(age=min(reading.age, self._bridge.reading().age))
        return reading

    def _hear(self, message: Message) -> None:
        if not isinstance(message["data"], bool):
            raise TypeError("it says neither yes nor no")
        self._newest.take(message["data"] == self._pressed)
