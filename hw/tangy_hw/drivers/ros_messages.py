"""Conversion between rosbridge's ROS messages and Tangy's values; pure functions.

Times are {"secs", "nsecs"} in ROS 1 and {"sec", "nanosec"} in ROS 2; parsing accepts both. Other
messages raise KeyError, TypeError or ValueError, which `Rosbridge` reports.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tangy_hw.device_protocols import Odometry, Pose, Scan, Twist
from tangy_profiles.health import ERROR, OK, STALE, WARN, DeviceState

Message = Mapping[str, Any]

LEVELS: tuple[DeviceState, ...] = (OK, WARN, ERROR, STALE)
"""By their number in diagnostic_msgs/DiagnosticStatus."""


def number(value: object) -> float:
    """Return a finite number.

    Raises:
        ValueError: it is none.
    """
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise ValueError(f"{value!r:.40} is no finite number")
    return float(value)


def time_message(seconds: float, ros: int) -> dict[str, int]:
    """Return a time or duration in s in the form of this ROS version."""
    whole = math.floor(seconds)
    rest = min(round((seconds - whole) * 1e9), 999_999_999)
    return {"secs": whole, "nsecs": rest} if ros == 1 else {"sec": whole, "nanosec": rest}


def seconds_of(message: Message) -> float:
    """Return a time or duration of either form in s."""
    whole = message["secs"] if "secs" in message else message["sec"]
    rest = message["nsecs"] if "nsecs" in message else message["nanosec"]
    return number(whole) + number(rest) / 1e9


def stamp_of(message: Message) -> float | None:
    """Return the time in a message's header in s; None if it is not filled in."""
    stamp = message.get("header", {}).get("stamp")
    return (seconds_of(stamp) or None) if stamp else None


def header(frame: str, ros: int) -> dict[str, Any]:
    """Return a header with time 0, which means now."""
    return {"stamp": time_message(0, ros), "frame_id": frame}


def heading_of(quaternion: Message) -> float:
    """Return the heading (rad) of a quaternion; all zeros (not filled in) mean 0."""
    x, y, z, w = (number(quaternion[axis]) for axis in "xyzw")
    return math.atan2(2 * (w * z + x * y), w * w + x * x - y * y - z * z)


def quaternion_message(heading: float) -> dict[str, float]:
    """Return a heading in rad as a quaternion."""
    return {"x": 0.0, "y": 0.0, "z": math.sin(heading / 2), "w": math.cos(heading / 2)}


def pose_of(message: Message) -> Pose:
    """Return a geometry_msgs/Pose as a planar pose."""
    place = message["position"]
    return Pose(number(place["x"]), number(place["y"]), heading_of(message["orientation"]))


def pose_message(pose: Pose) -> dict[str, Any]:
    """Return a pose as geometry_msgs/Pose."""
    return {
        "position": {"x": pose.x, "y": pose.y, "z": 0.0},
        "orientation": quaternion_message(pose.heading),
    }


def twist_of(message: Message) -> Twist:
    """Return a geometry_msgs/Twist of a base that drives forward and turns."""
    return Twist(number(message["linear"]["x"]), number(message["angular"]["z"]))


def twist_message(twist: Twist) -> dict[str, Any]:
    """Return a twist as geometry_msgs/Twist."""
    return {
        "linear": {"x": twist.forward, "y": 0.0, "z": 0.0},
        "angular": {"x": 0.0, "y": 0.0, "z": twist.turn},
    }


def odometry_of(message: Message) -> Odometry:
    """Return a nav_msgs/Odometry."""
    return Odometry(pose_of(message["pose"]["pose"]), twist_of(message["twist"]["twist"]))


def scan_of(message: Message, turned: float = 0.0) -> tuple[Scan, NDArray[np.float64]]:
    """Return a sensor_msgs/LaserScan, and its raw ranges (n,) in m.

    Ranges outside the scanner's limits, and missing ones (null, as rosbridge writes infinity), are
    inf in the scan.

    Args:
        message: the message.
        turned: rotation of the scanner to the left of the robot's front, in rad.

    Raises:
        KeyError, TypeError, ValueError: it is no valid scan.
    """
    raw = np.array(message["ranges"], float)
    first, step = number(message["angle_min"]), number(message["angle_increment"])
    least, most = number(message["range_min"]), number(message["range_max"])
    if raw.ndim != 1 or not len(raw) or not step or most <= 0:
        raise ValueError("a scan has ranges, a step between its beams, and a greatest range")
    with np.errstate(invalid="ignore"):
        known = (raw >= max(least, 1e-6)) & (raw <= most)
    return Scan(first + turned, step, np.where(known, raw, np.inf), most), raw


def joints_of(message: Message) -> dict[str, float]:
    """Return the positions of a sensor_msgs/JointState by joint, in rad."""
    names, positions = message["name"], message["position"]
    if not positions:  # some messages have only velocities or efforts
        return {}
    return {str(name): number(position) for name, position in zip(names, positions, strict=True)}


def trajectory_message(joints: Mapping[str, float], seconds: float, ros: int) -> dict[str, Any]:
    """Return a trajectory_msgs/JointTrajectory to one point.

    Args:
        joints: goal positions in rad, by joint.
        seconds: duration of the movement.
        ros: 1 or 2.
    """
    point = {
        "positions": list(joints.values()),
        "velocities": [],
        "accelerations": [],
        "effort": [],
        "time_from_start": time_message(seconds, ros),
    }
    return {"header": header("", ros), "joint_names": list(joints), "points": [point]}


def statuses_of(message: Message) -> list[tuple[str, DeviceState, str, dict[str, str]]]:
    """Return name, state, message and values of each status in a DiagnosticArray.

    Raises:
        KeyError, TypeError, ValueError: it is no valid array.
    """
    found: list[tuple[str, DeviceState, str, dict[str, str]]] = []
    for status in message["status"]:
        level = status["level"]
        if isinstance(level, str) and len(level) == 1:  # a byte as a string, from some bridges
            level = ord(level) if level < " " else int(level)
        if isinstance(level, bool) or not isinstance(level, int) or not 0 <= level < len(LEVELS):
            raise ValueError(f"{level!r:.40} is no level of a diagnosis")
        values = {str(pair["key"]): str(pair["value"]) for pair in status.get("values", ())}
        said = str(status.get("message", ""))
        found.append((str(status["name"]), LEVELS[level], said, values))
    return found


def within(pose: Pose, origin: Pose) -> Pose:
    """Transform a pose from the frame of `origin` into its parent frame."""
    cos, sin = math.cos(origin.heading), math.sin(origin.heading)
    return Pose(
        origin.x + cos * pose.x - sin * pose.y,
        origin.y + sin * pose.x + cos * pose.y,
        _wrapped(origin.heading + pose.heading),
    )


def seen_from(pose: Pose, origin: Pose) -> Pose:
    """Transform a pose into the frame of `origin`; the inverse of `within`."""
    cos, sin = math.cos(origin.heading), math.sin(origin.heading)
    x, y = pose.x - origin.x, pose.y - origin.y
    return Pose(cos * x + sin * y, cos * y - sin * x, _wrapped(pose.heading - origin.heading))


def joined_names(text: str) -> dict[str, str]:
    """Parse "limb/joint = robot's name, ..." of a robot's profile.

    Raises:
        ValueError: the text is invalid.
    """
    names: dict[str, str] = {}
    for part in filter(None, (part.strip() for part in text.split(","))):
        ours, equals, theirs = (piece.strip() for piece in part.partition("="))
        if not (ours and equals and theirs) or ours in names:
            raise ValueError(part)
        names[ours] = theirs
    return names


def near_share(raw: NDArray[np.float64], near: float) -> float:
    """Return the share of beams (n,) that end within `near` m; a range of 0 is no return."""
    with np.errstate(invalid="ignore"):
        return float(np.mean((raw > 0) & (raw < near)))


def changed_share(scans: Sequence[NDArray[np.float64]]) -> float:
    """Return the share of beams that changed between scans (n,)."""
    ranges = np.nan_to_num(np.stack(scans), nan=np.inf)
    return float(np.mean(ranges.min(0) != ranges.max(0)))


def _wrapped(angle: float) -> float:
    return math.remainder(angle, math.tau)
