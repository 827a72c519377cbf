"""Arithmetic of poses on the floor, and scans as points.

Poses are `devices.Pose` or rows of arrays (n, 3): x and y in metres, heading in radians.
"""

from __future__ import annotations

from math import cos, pi, sin
from typing import TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray

from tangy_hw.device_protocols import Pose, Scan

Floats: TypeAlias = NDArray[np.float64]
Angle = TypeVar("Angle", float, Floats)

HERE = Pose(0.0, 0.0, 0.0)


def wrap(angle: Angle) -> Angle:
    """Return an angle, or an array of them, between -pi and pi."""
    return (angle + pi) % (2 * pi) - pi


def compose(start: Pose, step: Pose) -> Pose:
    """Return the pose after a step given in the frame of its starting pose."""
    c, s = cos(start.heading), sin(start.heading)
    return Pose(
        start.x + c * step.x - s * step.y,
        start.y + s * step.x + c * step.y,
        wrap(start.heading + step.heading),
    )


def between(start: Pose, end: Pose) -> Pose:
    """Return the step that leads from one pose to another, in the frame of the first."""
    c, s = cos(start.heading), sin(start.heading)
    x, y = end.x - start.x, end.y - start.y
    return Pose(c * x + s * y, c * y - s * x, wrap(end.heading - start.heading))


def placed(points: Floats, pose: Pose) -> Floats:
    """Transform points (n, 2) from the frame of a pose into its parent frame."""
    c, s = cos(pose.heading), sin(pose.heading)
    turned = points @ np.array([[c, s], [-s, c]]) + np.array([pose.x, pose.y])
    return np.asarray(turned, dtype=np.float64)


def lengths(steps: Floats) -> Floats:
    """Return how long vectors (n, 2) are."""
    return np.asarray(np.hypot(steps[:, 0], steps[:, 1]), dtype=np.float64)


def bearings(scan: Scan) -> Floats:
    """Return which way each beam looks (n,), from straight ahead."""
    return scan.first + scan.step * np.arange(len(scan.ranges), dtype=np.float64)


def endpoints(
    scan: Scan, farthest: float = np.inf, laser: Pose = HERE, nearest: float = 0.0
) -> Floats:
    """Return where beams end (m, 2), in the robot's frame; those that met nothing are left out.

    Args:
        scan: the scan.
        farthest: metres beyond which a beam does not count.
        laser: where the scanner sits on the robot.
        nearest: metres short of which a beam does not count.
    """
    met = (scan.ranges > nearest) & (scan.ranges < min(farthest, scan.farthest))
    angles, ranges = bearings(scan)[met], scan.ranges[met]
    points = np.column_stack((ranges * np.cos(angles), ranges * np.sin(angles)))
    return points if laser == HERE else placed(points, laser)
