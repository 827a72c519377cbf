"""Arithmetic of planar poses, and scans as points.

Poses are `Pose` values or rows of arrays (n, 3): x and y in m, heading in rad.
"""

from __future__ import annotations

from dataclasses import replace
from math import cos, pi, sin
from typing import TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray

from tangy_hw.device_protocols import Pose, Scan

Floats: TypeAlias = NDArray[np.float64]
Angle = TypeVar("Angle", float, Floats)

IDENTITY = Pose(0.0, 0.0, 0.0)


def wrap(angle: Angle) -> Angle:
    """Return an angle in rad, or an array of angles, wrapped to [-pi, pi)."""
    return (angle + pi) % (2 * pi) - pi


def compose(start: Pose, step: Pose) -> Pose:
    """Return the pose after a step given in the frame of the start."""
    c, s = cos(start.heading), sin(start.heading)
    return Pose(
        start.x + c * step.x - s * step.y,
        start.y + s * step.x + c * step.y,
        wrap(start.heading + step.heading),
    )


def relative_pose(start: Pose, end: Pose) -> Pose:
    """Return the step from one pose to another, in the frame of the first."""
    c, s = cos(start.heading), sin(start.heading)
    x, y = end.x - start.x, end.y - start.y
    return Pose(c * x + s * y, c * y - s * x, wrap(end.heading - start.heading))


def transform_points(points: Floats, pose: Pose) -> Floats:
    """Transform points (n, 2) from the frame of a pose into its parent frame."""
    c, s = cos(pose.heading), sin(pose.heading)
    turned = points @ np.array([[c, s], [-s, c]]) + np.array([pose.x, pose.y])
    return np.asarray(turned, dtype=np.float64)


def lengths(steps: Floats) -> Floats:
    """Return the lengths of vectors (n, 2)."""
    return np.asarray(np.hypot(steps[:, 0], steps[:, 1]), dtype=np.float64)


def bearings(scan: Scan) -> Floats:
    """Return the bearing of each beam (n,) in rad, relative to straight ahead."""
    return scan.first + scan.step * np.arange(len(scan.ranges), dtype=np.float64)


def up_to(scan: Scan, reach: float) -> Scan:
    """Return a scan without returns beyond `reach` m, or beyond its own `farthest`.

    Such a beam ends at the range: it is free so far, and meets nothing.
    """
    farthest = min(scan.farthest, reach)
    beyond = np.isfinite(scan.ranges) & (scan.ranges > farthest)
    if farthest == scan.farthest and not beyond.any():
        return scan
    return replace(scan, ranges=np.where(beyond, farthest, scan.ranges), farthest=farthest)


def endpoints(
    scan: Scan, farthest: float = np.inf, laser: Pose = IDENTITY, nearest: float = 0.0
) -> Floats:
    """Return the ends of the beams with a return (m, 2), in the robot's frame.

    Args:
        scan: the scan.
        farthest: range in m beyond which returns are ignored.
        laser: pose of the scanner on the robot.
        nearest: range in m below which returns are ignored.
    """
    met = (scan.ranges > nearest) & (scan.ranges < min(farthest, scan.farthest))
    angles, ranges = bearings(scan)[met], scan.ranges[met]
    points = np.column_stack((ranges * np.cos(angles), ranges * np.sin(angles)))
    return points if laser == IDENTITY else transform_points(points, laser)
