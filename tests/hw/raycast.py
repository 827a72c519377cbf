"""A laser and wheels for tests: rays against segments, and odometry with known errors."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import cos, pi, sin

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from tangy_hw.device_protocols import Pose, Scan, Twist
from tangy_hw.navigation.occupancy import chair_legs, seat_feet, table_legs
from tangy_hw.navigation.poses import compose
from tangy_profiles.room import Room

CROSS = ((0.03, 0.0), (0.0, 0.03))
Segments = NDArray[np.float64]  # (n, 4): x, y of one end, x, y of the other


def box(left: float, near: float, right: float, far: float) -> list[tuple[float, ...]]:
    """Return the four sides of a box."""
    return [
        (left, near, right, near),
        (right, near, right, far),
        (right, far, left, far),
        (left, far, left, near),
    ]


def sides(*boxes: tuple[float, float, float, float]) -> Segments:
    """Return the sides of boxes (left, near, right, far)."""
    return np.array([side for one in boxes for side in box(*one)])


def room_sides(room: Room, *more: tuple[float, float, float, float]) -> Segments:
    """Return the walls of a room, the legs of its table and of everybody seated, and more boxes.

    A leg is a cross of 6 cm, which casts the same shadow as a round one with half the sides.
    """
    stand = table_legs(room)
    for seat in room.seats:
        stand += [*chair_legs(seat), *seat_feet(room, seat)]
    legs = [(p.x - dx, p.y - dy, p.x + dx, p.y + dy) for p in stand for dx, dy in CROSS]
    return np.vstack((sides((0, 0, room.width, room.depth), *more), legs))


def look(
    segments: Segments,
    pose: Pose,
    rng: Generator | None = None,
    *,
    beams: int = 360,
    angle: float = 1.5 * pi,
    farthest: float = 30.0,
    noise: float = 0.01,
) -> Scan:
    """Return the scan of a laser at a pose; without `rng` it is exact."""
    first, step = -angle / 2, angle / (beams - 1)
    headings = pose.heading + first + step * np.arange(beams)
    dx, dy = np.cos(headings)[:, None], np.sin(headings)[:, None]
    ax, ay, bx, by = segments.T
    ex, ey = bx - ax, by - ay
    across = dx * ey - dy * ex
    with np.errstate(divide="ignore", invalid="ignore"):
        far = ((ax - pose.x) * ey - (ay - pose.y) * ex) / across
        share = ((ax - pose.x) * dy - (ay - pose.y) * dx) / across
    hit = (np.abs(across) > 1e-12) & (far > 0) & (share >= -1e-9) & (share <= 1 + 1e-9)
    ranges = np.where(hit, far, np.inf).min(axis=1)
    if rng is not None:
        ranges = ranges + rng.normal(0, noise, beams)
    ranges[ranges >= farthest] = np.inf
    return Scan(first, step, ranges, farthest)


def driven(pose: Pose, twist: Twist, dt: float) -> Pose:
    """Return the pose of a base after driving for `dt` seconds."""
    turned = twist.turn * dt
    half = turned / 2
    way = twist.forward * dt * (sin(half) / half if abs(half) > 1e-9 else 1.0)
    return compose(pose, Pose(way * cos(half), way * sin(half), turned))


class Wheels:
    """Odometry with errors: of scale, and random ones in proportion."""

    def __init__(self, rng: Generator, scale: float = 1.02, noise: float = 0.05) -> None:
        self.pose = Pose(0.0, 0.0, 0.0)
        self._rng, self._scale, self._noise = rng, scale, noise

    def turn(self, twist: Twist, dt: float) -> Pose:
        """Count this motion, and return the pose by odometry."""
        forward, turn = (1 + self._rng.normal(0, self._noise, 2)) * self._scale
        self.pose = driven(self.pose, Twist(twist.forward * forward, twist.turn * turn), dt)
        return self.pose


def tour(points: Sequence[tuple[float, float]], speed: float = 0.4, dt: float = 0.1) -> list[Twist]:
    """Return the commands, one for each `dt`, that drive from point to point from heading 0."""
    commands, heading = [], 0.0
    for (ax, ay), (bx, by) in pairwise(points):
        way = np.hypot(bx - ax, by - ay)
        off = (np.arctan2(by - ay, bx - ax) - heading + pi) % (2 * pi) - pi
        turns = max(1, int(np.ceil(abs(off) / (1.0 * dt))))
        commands += [Twist(0.0, off / turns / dt)] * turns
        goes = max(1, int(np.ceil(way / (speed * dt))))
        commands += [Twist(way / goes / dt, 0.0)] * goes
        heading += off
    return commands
