"""How much room there is along an arc, by what the scanner sees: the one look of all who drive.

A scanner a hand's breadth above the floor sees legs. Of what may be somebody, room counts from
where a torso and toes are; of what the map has, from what is seen.
"""

from __future__ import annotations

from math import inf, pi, sqrt
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from tangy_hw.device_protocols import Twist
from tangy_hw.navigation.limits import MotionLimits
from tangy_hw.navigation.poses import Floats, lengths

Mask: TypeAlias = NDArray[np.bool_]

REACH = 3.0  # metres beyond which nothing matters yet
MARGIN = 0.02  # metres by which a scan may be wrong
AWAY = 0.02  # metres by which driving must bring something nearer than it is, to count
STRAIGHT = 0.02  # 1/m of curvature below which an arc is a line
ASIDE = pi / 4  # radians off straight ahead within which a body counts as being before it
SPOT = 0.02  # m/s below which a robot turns on the spot


class Seen(NamedTuple):
    """What a scanner sees around: points (n, 2) in the robot's frame in m, nearer than `REACH`.

    `bodies` (n,) says which of them may be somebody.
    """

    points: Floats
    bodies: Mask

    def behind(self) -> Seen:
        """Return the same as a robot sees it that drives backwards: what is behind is before it."""
        return Seen(self.points * np.array([-1.0, 1.0]), self.bodies)


class Clearance(NamedTuple):
    """How far, in m, the robot may go along an arc (`free`), and how far a body is on it (`body`).

    `free` ends short of what would be touched; `body` where the robot would come up to somebody.
    """

    free: float
    body: float


def free_ahead(points: Floats, curvature: float, half: float | Floats) -> float:
    """Return how many metres a robot's middle can go on an arc until it touches one of the points.

    Args:
        points: what is around (n, 2), in the robot's frame.
        curvature: of the arc, 1/m, positive to the left.
        half: half the width that must be free, in metres; (n,) where it differs from point to
            point.
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


def room_ahead(seen: Seen, curvature: float, limits: MotionLimits) -> Clearance:
    """Return how much room there is before a robot on an arc (1/m, positive to the left).

    What it stands near already does not count as long as driving brings it no nearer: it is
    possible to drive away from everything.
    """
    points, bodies = seen
    if not len(points):
        return Clearance(inf, inf)
    at_most = np.maximum(lengths(points) - AWAY, 0.0)
    half = limits.radius + MARGIN + np.where(bodies, limits.torso, 0.0)
    free = free_ahead(points, curvature, np.minimum(half, at_most)) - limits.gap
    return Clearance(free, _body_ahead(points[bodies], curvature, limits))


def _body_ahead(points: Floats, curvature: float, limits: MotionLimits) -> float:
    """Return how far a body is before the robot: on the arc, or aside from where it may step in."""
    if not len(points):
        return inf
    reach = limits.radius + limits.torso
    there = lengths(points)
    aside = np.abs(np.arctan2(points[:, 1], points[:, 0])) < ASIDE
    on_it = free_ahead(points, curvature, np.minimum(reach + limits.gap, there - AWAY))
    return min(on_it, float(there[aside].min() - reach) if aside.any() else inf)


def speed_in(room: Clearance, limits: MotionLimits) -> float:
    """Return how fast a robot may drive into some room, in m/s: it must be able to stop in it."""
    fast = sqrt(2 * limits.brake * max(0.0, min(room.free, REACH)))
    return min(fast, limits.careful) if room.body < limits.near else fast


def guarded(twist: Twist, seen: Seen, limits: MotionLimits) -> Twist:
    """Return a twist as it may be driven by hand, past what is seen: on the same arc, or turning.

    It is slower before what is near and stands before what is close; then it still turns. Where a
    scanner sees little, which is behind, it is slow whatever is seen. A round robot touches nothing
    more by turning; beside what is close it does so slowly.
    """
    forward, turn = limits.clamped(twist)
    if abs(forward) >= SPOT:
        view = seen if forward > 0 else seen.behind()
        most = speed_in(room_ahead(view, turn / forward, limits), limits)
        most = min(most, limits.unseen) if forward < 0 else most
        if most >= SPOT:
            slower = min(1.0, most / abs(forward))
            return Twist(forward * slower, turn * slower)
    near = float(lengths(seen.points).min()) if len(seen.points) else inf
    if near < limits.radius + limits.torso + limits.gap:
        turn = max(-limits.turn_close, min(limits.turn_close, turn))
    return Twist(0.0, turn)
