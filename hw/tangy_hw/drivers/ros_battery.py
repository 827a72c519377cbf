"""A robot's battery through ROS: sensor_msgs/BatteryState."""

from __future__ import annotations

from tangy_hw.drivers.latest_value import LatestValue
from tangy_hw.drivers.ros_messages import Message, number
from tangy_hw.drivers.rosbridge import Rosbridge
from tangy_profiles.health import OK, Fact, Reading

CHARGING, FULL = 1, 4  # of power_supply_status


class RosBattery:
    """Reports the charge of the battery, and whether it is charging."""

    def __init__(self, bridge: Rosbridge, *, topic: str = "/battery_state") -> None:
        """Set its topic.

        Args:
            bridge: the link to the robot.
            topic: name of the topic.
        """
        self.name = "battery"
        self._bridge, self._topic = bridge, topic
        self._newest: LatestValue[dict[str, Fact]] = LatestValue(bridge.clock)
        self._begun = self._to_hundred = False

    async def start(self) -> None:
        """Subscribe to its topic."""
        await self._bridge.start()
        if not self._begun:
            self._begun = True
            self._newest.restart()
            self._bridge.subscribe(self._topic, "sensor_msgs/BatteryState", self._hear)

    async def close(self) -> None:
        """Unsubscribe."""
        self._begun = False
        self._bridge.unsubscribe(self._topic, self._hear)

    def reading(self) -> Reading:
        """Return `charge` from 0 to 1 and `charging`, with their age."""
        stamped = self._newest.stamped
        return self._newest.reading(self.name, OK, {} if stamped is None else stamped.value)

    def _hear(self, message: Message) -> None:
        status = message["power_supply_status"]
        self._to_hundred |= (message["percentage"] or 0.0) > 1.0  # otherwise 1 % would read as full
        charge = charge_of(message, to_hundred=self._to_hundred)
        self._newest.take({"charge": charge, "charging": status in (CHARGING, FULL)})


def charge_of(message: Message, *, to_hundred: bool = False) -> float:
    """Return the charge of a battery from 0 to 1.

    Unmeasured values are NaN, null in JSON; without a `percentage`, use charge by capacity. Some
    robots send percentages up to 100: those that have sent more than 1 (`to_hundred`).

    Raises:
        ValueError, KeyError, TypeError: the message has no usable values.
    """
    share = message["percentage"]
    if share is None:
        full = message["capacity"] or message["design_capacity"]
        share = number(message["charge"]) / number(full)
    share = number(share)
    return min(max(share / 100 if to_hundred or share > 1.0 else share, 0.0), 1.0)
