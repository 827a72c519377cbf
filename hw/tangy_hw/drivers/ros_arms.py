"""Arms and head through ROS: publishes JointTrajectory, subscribes to JointState."""

from __future__ import annotations

import logging
import math
from collections.abc import Mapping, Sequence
from contextlib import suppress

from tangy_hw.device_protocols import DeviceError
from tangy_hw.drivers.joint_moves import TOLERANCE, JointMoves
from tangy_hw.drivers.latest_value import LatestValue
from tangy_hw.drivers.ros_messages import Message, header, joints_of, trajectory_message
from tangy_hw.drivers.ros_status import RosDiagnostics, state_told
from tangy_hw.drivers.rosbridge import Rosbridge
from tangy_profiles.health import ERROR, Reading
from tangy_profiles.reading import plain
from tangy_profiles.robot import Limb

_LOG = logging.getLogger(__name__)

HOLD_SECONDS = 0.1  # in which joints return to where they were at the command to hold
KNOWN_SECONDS = 0.5  # age of positions up to which holding them makes sense


class RosArms:
    """Limbs that take poses. Joints are called "limb/joint", unless the profile names them."""

    def __init__(
        self,
        bridge: Rosbridge,
        limbs: Mapping[str, Limb],
        *,
        name: str = "arms",
        trajectory: str = "/joint_trajectory",
        states: str = "/joint_states",
        torque: str = "/joint_torque",
        names: Mapping[str, str] | None = None,
        tolerance: float = TOLERANCE,
        diagnostics: RosDiagnostics | None = None,
    ) -> None:
        """Set its topics.

        Args:
            bridge: the link to the robot.
            limbs: the limbs of the robot's profile, with their joints.
            name: its name in the robot's profile.
            trajectory: topic for movements.
            states: topic of the joint states.
            torque: topic for std_msgs/Bool, whether the servos hold.
            names: the robot's own names of joints, by "limb/joint".
            tolerance: position error in degrees within which a joint has arrived.
            diagnostics: diagnostics of the robot, if it publishes any.
        """
        self.name = name
        self._bridge, self._diagnostics = bridge, diagnostics
        self._trajectory, self._states, self._torque = trajectory, states, torque
        known = names or {}
        self._joints: dict[str, tuple[str, ...]] = {
            limb.name: tuple(
                known.get(f"{limb.name}/{joint}", f"{limb.name}/{joint}") for joint in limb.joints
            )
            for limb in limbs.values()
        }
        self._newest: LatestValue[dict[str, float]] = LatestValue(bridge.clock)
        self._own = {joint for joints in self._joints.values() for joint in joints}
        self._moves = JointMoves(name, math.radians(tolerance), bridge.clock)
        self._limp = False
        self._begun = False

    @property
    def positions(self) -> Mapping[str, float]:
        """Latest position of each joint in rad, by the robot's own names."""
        return self._moves.positions

    async def start(self) -> None:
        """Subscribe to the joint states."""
        await self._bridge.start()
        if not self._begun:
            self._begun = True
            self._newest.restart()
            self._bridge.advertise(self._trajectory, "trajectory_msgs/JointTrajectory")
            self._bridge.advertise(self._torque, "std_msgs/Bool")
            self._bridge.subscribe(self._states, "sensor_msgs/JointState", self._hear)

    async def close(self) -> None:
        """Unsubscribe; the arms stay as they are."""
        self._begun = False
        self._bridge.unsubscribe(self._states, self._hear)

    def reading(self) -> Reading:
        """Return the age of the joint states, and whether a servo reports an error."""
        state = state_told(self._diagnostics, self.name)
        return self._newest.reading(self.name, state, {"hardware_error": state == ERROR})

    async def pose(self, angles: Mapping[str, Sequence[float]], seconds: float) -> None:
        """Move limbs to joint angles (degrees, by limb) within `seconds` s, and wait.

        Raises:
            DeviceError: there is no such limb or no link, a servo reports an error, another pose
                replaces this one, or a joint does not arrive in time.
        """
        _LOG.info("poses %s within %.1f s", ", ".join(angles), seconds)
        goals: dict[str, float] = {}
        for limb, degrees in angles.items():
            joints = self._joints.get(limb, ())
            if len(joints) != len(degrees) or not all(map(math.isfinite, degrees)):
                raise DeviceError(plain(f"{self.name} cannot take {limb} to {list(degrees)}."))
            goals.update(zip(joints, map(math.radians, degrees), strict=True))
        if not goals:
            return
        if self._limp:
            self._bridge.publish(self._torque, {"data": True})
            self._limp = False
        message = trajectory_message(goals, max(seconds, 0.0), self._bridge.ros)
        self._bridge.publish(self._trajectory, message)
        self._fail_on_error()  # the other joints move anyway: a head can still look
        try:
            await self._moves.arrive(goals, seconds, self._well)
        except DeviceError:
            self._fail_on_error()
            if not self._bridge.connected:
                raise DeviceError(f"{self.name}: the link was lost on the way.") from None
            raise

    async def hold(self) -> None:
        """Stop at the current position with the current torque.

        A trajectory to the current positions replaces the current one. In ROS 1 an empty one
        follows, at which joint_trajectory_controller brakes and holds by its own knowledge of the
        joints; in ROS 2 an empty trajectory is rejected, or ignored.
        """
        self._moves.end(f"{self.name} was told to hold.")
        if self._limp:
            return
        ros, here = self._bridge.ros, self.positions
        with suppress(DeviceError):
            if here and self._newest.age <= KNOWN_SECONDS:
                message = trajectory_message(here, HOLD_SECONDS, ros)
                self._bridge.publish(self._trajectory, message)
            if ros == 1:
                names = [joint for joints in self._joints.values() for joint in joints]
                empty = {"header": header("", ros), "joint_names": names, "points": []}
                self._bridge.publish(self._trajectory, empty)

    async def relax(self) -> None:
        """Switch the torque of all joints off."""
        self._moves.end(f"{self.name} was let hang.")
        self._limp = True
        with suppress(DeviceError):
            self._bridge.publish(self._torque, {"data": False}, urgent=True)

    def _well(self) -> bool:
        return self._bridge.connected and state_told(self._diagnostics, self.name) != ERROR

    def _fail_on_error(self) -> None:
        told = None if self._diagnostics is None else self._diagnostics.of(self.name)
        if told is not None and told.state == ERROR:
            raise DeviceError(plain(f"{self.name}: {told.says or 'a servo reports an error'}"))

    def _hear(self, message: Message) -> None:
        positions = joints_of(message)
        self._newest.take(positions)
        self._moves.hear({joint: positions[joint] for joint in self._own & positions.keys()})
