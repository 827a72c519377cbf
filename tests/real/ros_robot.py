"""A robot for tests: a ROS 1 node by Debian's rospy, with a move_base of Debian's actionlib.

It follows /cmd_vel for half a second; its /move_base drives straight to a goal, and finds
no path to goals with x beyond 50 m. It publishes at the rates of real robots.
"""

from __future__ import annotations

import math
import threading
from typing import Any

import actionlib  # type: ignore[import-not-found]
import rospy  # type: ignore[import-not-found]
from diagnostic_msgs.msg import (  # type: ignore[import-not-found]
    DiagnosticArray,
    DiagnosticStatus,
    KeyValue,
)
from geometry_msgs.msg import Twist  # type: ignore[import-not-found]
from move_base_msgs.msg import (  # type: ignore[import-not-found]
    MoveBaseAction,
    MoveBaseFeedback,
    MoveBaseResult,
)
from nav_msgs.msg import Odometry  # type: ignore[import-not-found]
from sensor_msgs.msg import JointState, LaserScan  # type: ignore[import-not-found]
from std_msgs.msg import Bool, String  # type: ignore[import-not-found]
from trajectory_msgs.msg import JointTrajectory  # type: ignore[import-not-found]

RATE = 20
HOLDS = 0.5
SPEED = 2.0


class Robot:
    """The whole robot, in one node."""

    def __init__(self) -> None:
        self.x = self.y = self.heading = 0.0
        self.forward = self.turn = 0.0
        self.told = -math.inf
        self.joints = {"head/neck nod": 0.0, "head/neck shake": 0.0}
        self.error = False
        self.lock = threading.Lock()
        self.said = rospy.Publisher("/voice/said", String, queue_size=5)
        rospy.Subscriber("/cmd_vel", Twist, self.drive)
        rospy.Subscriber("/joint_trajectory", JointTrajectory, self.pose)
        rospy.Subscriber("/voice/say", String, lambda message: self.said.publish(message.data))
        rospy.Subscriber("/test/error", Bool, lambda message: setattr(self, "error", message.data))
        self.action = actionlib.SimpleActionServer("/move_base", MoveBaseAction, self.go, False)
        self.action.start()

    def drive(self, twist: Any) -> None:
        with self.lock:
            self.forward, self.turn = twist.linear.x, twist.angular.z
            self.told = rospy.get_time()

    def pose(self, trajectory: Any) -> None:
        (point,) = trajectory.points
        when = point.time_from_start.to_sec()
        goals = dict(zip(trajectory.joint_names, point.positions, strict=True))
        rospy.Timer(rospy.Duration(when), lambda _: self.joints.update(goals), oneshot=True)

    def go(self, goal: Any) -> None:
        target = goal.target_pose.pose.position
        if target.x > 50:
            self.action.set_aborted(MoveBaseResult(), "Failed to find a valid plan")
            return
        rate = rospy.Rate(RATE)
        while not rospy.is_shutdown():
            if self.action.is_preempt_requested():
                self.action.set_preempted()
                return
            with self.lock:
                dx, dy = target.x - self.x, target.y - self.y
                far = math.hypot(dx, dy)
                step = min(1.0, SPEED / RATE / max(far, 1e-9))
                self.x, self.y = self.x + step * dx, self.y + step * dy
                feedback = MoveBaseFeedback()
                feedback.base_position.pose.position.x = self.x
                feedback.base_position.pose.position.y = self.y
                feedback.base_position.pose.orientation.w = 1.0
            self.action.publish_feedback(feedback)
            if far < SPEED / RATE:
                self.action.set_succeeded(MoveBaseResult())
                return
            rate.sleep()

    def odometry(self) -> Any:
        with self.lock:
            if rospy.get_time() - self.told > HOLDS:
                self.forward = self.turn = 0.0
            self.heading += self.turn / RATE
            self.x += self.forward * math.cos(self.heading) / RATE
            self.y += self.forward * math.sin(self.heading) / RATE
            message = Odometry()
            message.header.stamp = rospy.Time.now()
            pose, twist = message.pose.pose, message.twist.twist
            pose.position.x, pose.position.y = self.x, self.y
            pose.orientation.z = math.sin(self.heading / 2)
            pose.orientation.w = math.cos(self.heading / 2)
            twist.linear.x, twist.angular.z = self.forward, self.turn
        return message

    def scan(self) -> Any:
        message = LaserScan(angle_min=-2.0, angle_max=2.0, angle_increment=4 / 359)
        message.header.stamp = rospy.Time.now()
        message.range_min, message.range_max = 0.1, 10.0
        message.ranges = [math.inf, math.nan, 0.05] + [3.0] * 357
        return message

    def diagnosis(self) -> Any:
        level = DiagnosticStatus.ERROR if self.error else DiagnosticStatus.OK
        value = KeyValue("load", "7")
        status = DiagnosticStatus(level, "robot/Arms: servos", "elbow overheated", "1", [value])
        return DiagnosticArray(status=[status])

    def run(self) -> None:
        topics: list[tuple[Any, Any, int]] = [
            (rospy.Publisher("/odom", Odometry, queue_size=1), self.odometry, 1),
            (rospy.Publisher("/scan", LaserScan, queue_size=1), self.scan, 2),
            (rospy.Publisher("/stop_button", Bool, queue_size=1), lambda: Bool(False), 2),
            (rospy.Publisher("/diagnostics", DiagnosticArray, queue_size=1), self.diagnosis, 4),
            (
                rospy.Publisher("/joint_states", JointState, queue_size=1),
                lambda: JointState(name=list(self.joints), position=list(self.joints.values())),
                1,
            ),
        ]
        rate = rospy.Rate(RATE)
        turn = 0
        while not rospy.is_shutdown():
            for publisher, says, every in topics:
                if turn % every == 0:
                    publisher.publish(says())
            turn += 1
            rate.sleep()


if __name__ == "__main__":
    rospy.init_node("robot")
    Robot().run()
