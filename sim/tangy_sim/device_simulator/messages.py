"""ROS messages of the bench's robot, in ROS 1 form."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import cos, floor, sin
from typing import Any

from tangy_sim.device_simulator.floor import FloorPose

Message = dict[str, Any]
OK, WARN, ERROR, STALE = range(4)
"""Levels of diagnostic_msgs/DiagnosticStatus."""


def time(seconds: float) -> dict[str, int]:
    """Return a time or duration in s."""
    whole = floor(seconds)
    return {"secs": whole, "nsecs": min(round((seconds - whole) * 1e9), 999_999_999)}


def header(seconds: float, frame: str) -> Message:
    """Return a header with a time in s."""
    return {"stamp": time(seconds), "frame_id": frame}


def odometry(seconds: float, pose: FloorPose, forward: float, turn: float) -> Message:
    """Return nav_msgs/Odometry (s, m/s, rad/s), without covariances."""
    where = {
        "position": {"x": pose.x, "y": pose.y, "z": 0.0},
        "orientation": {"x": 0.0, "y": 0.0, "z": sin(pose.heading / 2), "w": cos(pose.heading / 2)},
    }
    how = {
        "linear": {"x": forward, "y": 0.0, "z": 0.0},
        "angular": {"x": 0.0, "y": 0.0, "z": turn},
    }
    return {
        "header": header(seconds, "odom"),
        "child_frame_id": "base_link",
        "pose": {"pose": where},
        "twist": {"twist": how},
    }


def joint_states(
    seconds: float, positions: Mapping[str, float], speeds: Mapping[str, float]
) -> Message:
    """Return sensor_msgs/JointState of joints in rad and rad/s, by name, at a time in s."""
    return {
        "header": header(seconds, ""),
        "name": list(positions),
        "position": list(positions.values()),
        "velocity": [speeds[name] for name in positions],
        "effort": [],
    }


def diagnostics(seconds: float, devices: Mapping[str, tuple[int, str]]) -> Message:
    """Return diagnostic_msgs/DiagnosticArray at a time in s: each device's level and message."""
    return {
        "header": header(seconds, ""),
        "status": [
            {
                "level": level,
                "name": name,
                "message": says,
                "hardware_id": "bench",
                "values": [{"key": "hardware_error", "value": str(level == ERROR).lower()}],
            }
            for name, (level, says) in devices.items()
        ],
    }


def trajectory(message: Mapping[str, Any]) -> tuple[Sequence[str], Sequence[float], float]:
    """Parse trajectory_msgs/JointTrajectory: names, positions (rad) and time (s) of its last point.

    Raises:
        KeyError, IndexError, TypeError, ValueError: the message is invalid.
    """
    point = message["points"][-1]
    after = point.get("time_from_start", {})
    whole = after.get("secs", after.get("sec", 0))
    rest = after.get("nsecs", after.get("nanosec", 0))
    positions = [float(one) for one in point["positions"]]
    names = [str(name) for name in message["joint_names"]]
    if len(names) != len(positions):
        raise ValueError("a position for each joint")
    return names, positions, float(whole) + float(rest) / 1e9
