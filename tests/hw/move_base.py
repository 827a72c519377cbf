"""The robot's own navigation for tests, at the other end of a link: move_base of ROS 1."""

from __future__ import annotations

from typing import Any

from tangy_hw.device_protocols import Pose
from tangy_hw.drivers.ros_messages import pose_message
from tangy_sim.servers.rosbridge_server import RosbridgeServer


class MoveBase:
    """move_base at the other end: it accepts goals, and a test decides how they end."""

    def __init__(self, server: RosbridgeServer) -> None:
        self.server = server
        self.goals: dict[str, Any] = {}
        self.cancelled: list[str] = []
        self.takes = True
        server.on_message("/move_base/goal", self.take)
        server.on_message("/move_base/cancel", lambda message: self.cancelled.append(message["id"]))

    def take(self, message: Any) -> None:
        self.goals[message["goal_id"]["id"]] = message["goal"]["target_pose"]
        if self.takes:
            self.say(1)

    @property
    def newest(self) -> str:
        return list(self.goals)[-1]

    def say(self, code: int, text: str = "", key: str = "") -> None:
        status = {"goal_id": {"id": key or self.newest}, "status": code, "text": text}
        self.server.publish("/move_base/status", "", {"status_list": [status]})

    def end(self, code: int, text: str = "") -> None:
        status = {"goal_id": {"id": self.newest}, "status": code, "text": text}
        self.server.publish("/move_base/result", "", {"status": status, "result": {}})

    def feed(self, pose: Pose) -> None:
        feedback = {"base_position": {"pose": pose_message(pose)}}
        self.server.publish("/move_base/feedback", "", {"feedback": feedback})

    def place(self, pose: Pose, spread: float = 0.1) -> None:
        """Publish the pose on amcl_pose."""
        covariance = [0.0] * 36
        covariance[0] = covariance[7] = spread**2 / 2
        where = {"pose": pose_message(pose), "covariance": covariance}
        self.server.publish("/amcl_pose", "", {"pose": where})

    def idle(self) -> None:
        """Publish that it runs, without a goal."""
        self.server.publish("/move_base/status", "", {"status_list": []})
