"""Compares a path with obstacles that were seen later, and with other paths."""

from __future__ import annotations

import numpy as np

from tangy_hw.device_protocols import Pose
from tangy_hw.navigation.clearance import AWAY
from tangy_hw.navigation.planning import BESIDE, RADIUS, near_ends
from tangy_hw.navigation.poses import Floats, lengths

INTO = 0.02  # metres that a path may be nearer to an obstacle than a new one would be
LOOK_AHEAD = 50  # points of the path checked for obstacles: 2.5 m
LEAVES = 0.3  # metres between two paths that make one a detour


def comes_too_near(
    path: Floats, obstacles: Floats, pose: Pose, goal: Pose, radius: float, keep: float
) -> bool:
    """Return whether a path comes closer to an obstacle than allowed and than the robot is.

    Args:
        path: points of the path that are left (n, 2).
        obstacles: obstacles that are not on the map (m, 2).
        pose: pose of the robot.
        goal: goal of the path.
        radius: minimum distance of the robot's centre from obstacles on the map, in m.
        keep: minimum distance from `obstacles`, in m, except beside the ends of the path.
    """
    path = path[:LOOK_AHEAD]
    if not len(path) or not len(obstacles):
        return False
    beside = near_ends(obstacles, ((pose.x, pose.y), (goal.x, goal.y)), keep)
    least = np.where(beside, radius + BESIDE - RADIUS, keep) - INTO
    least = np.minimum(least, lengths(obstacles - (pose.x, pose.y)) - AWAY)
    apart = ((path[::2, None] - obstacles[None]) ** 2).sum(axis=2)
    return bool((apart < np.maximum(least, 0.0) ** 2).any())


def leaves(path: Floats, other: Floats) -> bool:
    """Return whether a path (n, 2) leaves another one (m, 2)."""
    apart = ((path[::4, None] - other[None, ::2]) ** 2).sum(axis=2)
    return bool(apart.min(axis=1).max() > LEAVES**2)
