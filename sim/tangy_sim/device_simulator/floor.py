"""Obstacles on the bench's floor: walls, the table, chairs, people's legs, dropped objects.

The laser sees legs and walls; the robot also bumps into the table top. Coordinates are in m in the
room's frame (see `tangy_profiles.room`).
"""

from __future__ import annotations

from collections.abc import Iterable
from math import cos, hypot, pi, sin
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tangy_profiles.room import Point, Room

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Real = NDArray[np.float64]

TABLE_LEG = 0.033  # m, radius
LEG_INSET = 0.1  # m from the table's edges to the centres of its legs
LEG = 0.06  # m, radius of a person's leg at scanner height
CHAIR_LEG = 0.02  # m, radius
CHAIR = 0.42  # m between neighbouring legs of a chair
FIDGETS = 0.2  # leg movements per second and leg
RING = 1.0  # m from the robot to the chairs around it


class FloorPose(NamedTuple):
    """Position and heading; heading 0 is along x, in rad."""

    x: float
    y: float
    heading: float


class Circle(NamedTuple):
    """A round obstacle."""

    x: float
    y: float
    radius: float


def chair(x: float, y: float, turned: float = 0.0) -> tuple[Circle, ...]:
    """Return the legs of a chair with its centre at (x, y) in m, rotated by rad."""
    half = CHAIR / 2**0.5
    return tuple(
        Circle(x + half * cos(angle), y + half * sin(angle), CHAIR_LEG)
        for angle in (turned + pi / 4 + quarter * pi / 2 for quarter in range(4))
    )


class Floor:
    """The floor of a room with seated people."""

    def __init__(self, room: Room, people: int, random: np.random.Generator) -> None:
        self.room = room
        self._random = random
        self._seats = room.seated(people)
        left, near, right, far = room.table
        self.walls: Real = np.array(
            [
                (0, 0, room.width, 0),
                (room.width, 0, room.width, room.depth),
                (room.width, room.depth, 0, room.depth),
                (0, room.depth, 0, 0),
            ],
            float,
        )
        """Segments (n, 4): x and y of both ends."""
        inset = LEG_INSET
        self._still = [
            Circle(x, y, TABLE_LEG)
            for x in (left + inset, right - inset)
            for y in (near + inset, far - inset)
        ]
        for seat in self._seats:
            self._still += chair(seat.x, seat.y)
        self._legs = [self._placed(seat, side) for seat in self._seats for side in (-1, 1)]
        self._still_for = self._waiting()
        self.dropped: list[Circle] = []
        """Obstacles put in the robot's way; call `changed` after changing them."""
        self.changed()

    def _placed(self, seat: Point, side: int) -> Circle:
        """Place a person's foot before the chair, at a slightly different place each time."""
        dx, dy = self._random.uniform(-0.06, 0.06), self._random.uniform(-0.12, 0.08)
        return Circle(seat.x + 0.13 * side + dx, seat.y - 0.3 + dy, LEG)

    def changed(self) -> None:
        """Update the obstacles after a change."""
        self.circles: Real = np.array([*self._still, *self._legs, *self.dropped], float)

    def step(self, seconds: float) -> None:
        """Advance by a time in s, in which people may move their legs."""
        self._still_for -= seconds
        while self._still_for <= 0:
            self._still_for += self._waiting()
            number = int(self._random.integers(len(self._legs)))
            seat = self._seats[number // 2]
            self._legs[number] = self._placed(seat, -1 if number % 2 == 0 else 1)
            self.changed()

    def _waiting(self) -> float:
        """Draw the time until the next leg movement, in s."""
        return float(self._random.exponential(1 / (FIDGETS * len(self._legs))))

    def clear(self, x: float, y: float, radius: float) -> bool:
        """Return whether a round object (m) fits there: in the room, clear of all obstacles."""
        room = self.room
        if not (radius <= x <= room.width - radius and radius <= y <= room.depth - radius):
            return False
        left, near, right, far = room.table
        if hypot(max(left - x, 0, x - right), max(near - y, 0, y - far)) < radius:
            return False
        away = np.hypot(self.circles[:, 0] - x, self.circles[:, 1] - y)
        return bool((away > radius + self.circles[:, 2]).all())

    def block(self, pose: FloorPose) -> None:
        """Put chairs around the robot, too close to get out between them."""
        count = int(2 * pi * RING / 0.45)
        ways = [2 * pi * number / count for number in range(count)]
        self._drop(Circle(pose.x + RING * cos(way), pose.y + RING * sin(way), 0.2) for way in ways)

    def drop_ahead(self, pose: FloorPose, ahead: float) -> bool:
        """Put a chair `ahead` m before the robot; return whether there was room for it."""
        x, y = pose.x + ahead * cos(pose.heading), pose.y + ahead * sin(pose.heading)
        if not self.clear(x, y, 0.9):  # leave a way round
            return False
        self._drop([Circle(x, y, 0.22)])
        return True

    def _drop(self, things: Iterable[Circle]) -> None:
        there = [thing for thing in things if self.clear(thing.x, thing.y, 0.05)]
        self.dropped += there
        self.changed()

    def tidy(self) -> None:
        """Remove everything that was put in the robot's way."""
        self.dropped.clear()
        self.changed()
