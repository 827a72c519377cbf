"""A robot that a navigator drives through a room, in simulated time."""

from __future__ import annotations

from collections.abc import Callable
from math import hypot, pi

import numpy as np

from tangy_hw.device_protocols import STILL, Odometry, Pose, Twist
from tangy_hw.navigation.navigator import Navigator, State
from tangy_hw.navigation.occupancy import map_of_room
from tangy_hw.navigation.poses import wrap
from tangy_profiles.room import load_room
from tests.hw.raycast import Segments, Wheels, driven, look, room_sides

ROOM = load_room()
MAP = map_of_room(ROOM)
FRONT = Pose(ROOM.front.x, ROOM.front.y, pi / 2)
PEOPLE = [f"user-{number}" for number in range(len(ROOM.seats))]
Box = tuple[float, float, float, float]
TABLE: Box = ROOM.table
CHAIR: Box = (6.2, 2.5, 6.6, 2.9)
ROW: Box = (0.05, 2.7, 9.95, 3.0)


def at_seat(place: int) -> Pose:
    """Return the pose from which the robot helps a person."""
    stand = ROOM.stand(PEOPLE[place], PEOPLE)
    return Pose(stand.x, stand.y, pi / 2)


class DrivenRobot:
    """A robot in the room, in simulated time."""

    def __init__(self, *boxes: Box, seed: int = 0) -> None:
        self.rng = np.random.default_rng(seed)
        self.true, self.wheels = FRONT, Wheels(self.rng)
        self.boxes = list(boxes)
        self.elsewhere: Segments | None = None  # seen instead of the room
        self.grip = 1.0
        self.stuck = self.blind = False
        self.twist, self.time = STILL, 0.0
        self.seen: list[tuple[State, str]] = []
        self.touched = False
        self.navigator = Navigator(MAP, np.random.default_rng(seed + 1), FRONT)

    def run(self, seconds: float, until: Callable[[], bool] = lambda: False) -> bool:
        """Let time pass; return whether the condition was met."""
        for _ in range(round(seconds * 10)):
            sides = self.elsewhere if self.elsewhere is not None else room_sides(ROOM, *self.boxes)
            scan = None if self.blind else look(sides, self.true, self.rng, beams=240)
            odometry = Odometry(self.wheels.pose, self.twist)
            told = self.navigator.tick(odometry, scan, 0.1)
            seen = (self.navigator.state, str(self.navigator.facts()["path"]))
            if not self.seen or self.seen[-1] != seen:
                self.seen.append(seen)
            if until():
                return True
            self.twist = STILL if self.stuck else told
            self.wheels.turn(self.twist, 0.1)
            goes = Twist(self.twist.forward * self.grip, self.twist.turn * self.grip)
            self.true = driven(self.true, goes, 0.1)
            self.touched |= any(self._away(box) < 0.25 for box in (*self.boxes, TABLE))
            self.time += 0.1
        return False

    def _away(self, box: Box) -> float:
        left, near, right, far = box
        x, y = self.true.x, self.true.y
        return hypot(max(left - x, 0, x - right), max(near - y, 0, y - far))

    def arrives(self, seconds: float = 60) -> bool:
        return self.run(seconds, lambda: self.navigator.state == "arrived")

    def off(self, goal: Pose) -> tuple[float, float]:
        turned = abs(wrap(self.true.heading - goal.heading))
        return hypot(self.true.x - goal.x, self.true.y - goal.y), turned
