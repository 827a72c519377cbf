"""Computes the clearance along an arc from laser points.

`people_guard` decides how much of a command may be driven past people.
"""

from __future__ import annotations

from math import inf, sqrt

import numpy as np

from tangy_hw.device_protocols import Twist
from tangy_hw.navigation.limits import MotionLimits
from tangy_hw.navigation.people_guard import NearbyPeople, limit_near_people
from tangy_hw.navigation.poses import Floats, lengths

REACH = 3.0  # metres beyond which obstacles are ignored
MARGIN = 0.02  # metres of error that a scan may have
AWAY = 0.02  # metres by which driving must approach a point for it to count
STRAIGHT = 0.02  # 1/m of curvature below which an arc counts as a line
SPOT = 0.02  # m/s below which a robot turns on the spot


def free_ahead(points: Floats, curvature: float, half: float | Floats) -> float:
    """Return how far, in m, the robot's centre can go on an arc until the robot touches a point.

    Args:
        points: obstacles (n, 2) in the robot's frame, in m.
        curvature: curvature of the arc in 1/m, positive to the left.
        half: half the width that must be free, in m; (n,) if it differs for each point.
    """
    if not len(points):
        return inf
    x, y = points[:, 0], points[:, 1]
    wide = np.broadcast_to(np.asarray(half, dtype=np.float64), x.shape)
    if abs(curvature) < STRAIGHT:
        hit = (np.abs(y) < wide) & (x > 0)
        off, along = y[hit], x[hit]
    else:
        centre = 1.0 / curvature
        away = np.hypot(x, y - centre) - abs(centre)
        angle = np.arctan2(x, np.sign(curvature) * (centre - y))
        hit = (np.abs(away) < wide) & (angle > 0) & (angle < 2.0)
        off, along = away[hit], angle[hit] * abs(centre)
    if not len(along):
        return inf
    return float(np.min(along - np.sqrt(wide[hit] ** 2 - off**2)))


def room_ahead(points: Floats, curvature: float, limits: MotionLimits) -> float:
    """Return how many metres the robot may go on an arc of some curvature (1/m, positive left).

    `points` (n, 2) are obstacles in the robot's frame, in m. An obstacle that is already closer
    than the clearance counts only if driving brings the robot nearer to it, so the robot can always
    drive away.
    """
    if not len(points):
        return inf
    at_most = np.maximum(lengths(points) - AWAY, 0.0)
    return (
        free_ahead(points, curvature, np.minimum(limits.radius + MARGIN, at_most))
        - limits.clearance
    )


def speed_in(room: float, limits: MotionLimits) -> float:
    """Return the speed in m/s from which a robot can stop within `room` m."""
    return sqrt(2 * limits.planned_braking * max(0.0, min(room, REACH)))


def limit_by_clearance(
    twist: Twist, points: Floats, around: NearbyPeople, limits: MotionLimits
) -> Twist:
    """Return a twist reduced to the available clearance: on the same arc, or turning only.

    The robot slows down near obstacles and stops before close ones, but may still turn: a round
    robot touches nothing by turning, and it turns slowly next to close obstacles. A robot with
    corners turns only if they stay clear of everything, as of people. It always drives backwards
    slowly, because its scanner sees little there.

    Args:
        twist: the commanded twist.
        points: obstacles (n, 2) in the robot's frame, in m.
        around: points that may be people.
        limits: the motion limits.
    """
    forward, turn = limits.clamped(twist)
    if abs(forward) >= SPOT:
        view = points if forward > 0 else points * np.array([-1.0, 1.0])
        most = speed_in(room_ahead(view, turn / forward, limits), limits)
        most = min(most, limits.unseen_speed) if forward < 0 else most
        if most >= SPOT:
            slower = min(1.0, most / abs(forward))
            safe = limit_near_people(Twist(forward * slower, turn * slower), around, limits)
            if abs(safe.forward) >= SPOT:
                return safe
    near = float(lengths(points).min()) if len(points) else inf
    if near < limits.radius + limits.close_range:
        turn = max(-limits.close_turn, min(limits.close_turn, turn))
    return limit_near_people(Twist(0.0, turn), NearbyPeople(around.tracks, points), limits)
