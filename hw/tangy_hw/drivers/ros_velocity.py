"""Topic on which a base takes velocity commands through ROS."""

from __future__ import annotations

from tangy_hw.device_protocols import Twist
from tangy_hw.drivers.ros_messages import Message, header, twist_message
from tangy_hw.drivers.rosbridge import Rosbridge


class VelocityTopic:
    """Publishes geometry_msgs/Twist, or TwistStamped for some ROS 2 bases."""

    def __init__(
        self, bridge: Rosbridge, topic: str = "/cmd_vel", *, stamped: bool = False
    ) -> None:
        self._bridge, self._topic, self._stamped = bridge, topic, stamped

    def advertise(self) -> None:
        """Advertise the topic, now and at every new connection."""
        kind = "geometry_msgs/TwistStamped" if self._stamped else "geometry_msgs/Twist"
        self._bridge.advertise(self._topic, kind)

    def say(self, twist: Twist) -> None:
        """Publish a command ahead of all other messages.

        Raises:
            DeviceError: there is no connection.
        """
        message: Message = twist_message(twist)
        if self._stamped:
            message = {"header": header("base_link", self._bridge.ros), "twist": message}
        self._bridge.publish(self._topic, message, urgent=True)
