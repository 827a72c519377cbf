"""People on legs or wheels in a simulated room, and a robot that drives among them.

The bench has its own geometry, and knows what the robot does not: where torsos are. People
are discs of which a laser sees the legs alone; the robot is a disc of .25 m, or its profile's body,
with a scanner of 270 degrees at 10 Hz (2 cm of noise, 3 % of beams and 1 % of scans lost) whose
commands come .1 s late. Nobody walks through the robot: a person who touches it steps back.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from math import atan2, cos, hypot, inf, pi, sin
from typing import Literal

import numpy as np
from numpy.random import Generator

from tangy_hw.device_protocols import STILL, Odometry, Pose, Scan, Twist
from tangy_hw.navigation.navigator import Navigator
from tangy_hw.navigation.occupancy import map_of_room
from tangy_hw.navigation.poses import wrap
from tangy_profiles.room import load_room
from tangy_sim.device_simulator.lidar import cast
from tests.hw.raycast import Wheels, driven, room_sides

TICK = 0.1  # s
LATE = 1  # ticks until a command is carried out
BEAMS, ANGLE = 360, 1.5 * pi
NOISE, NO_BEAM, NO_SCAN = 0.02, 0.03, 0.01
ROBOT, TORSO, LEG, APART = 0.25, 0.22, 0.06, 0.1  # m; the last: from a leg to the person's middle
STRIDE, STEPS = 0.2, 1.0  # m that a leg swings to either side; swings a second
GAIN, BRAKE, TURNS = 0.8, 1.0, 3.0  # m/s^2, m/s^2, rad/s^2 of the base
MOVES = 0.02  # m/s from which on the robot counts as driving
LONGEST = 120.0  # s
BACK, BUMPED = 0.5, 2.0  # m/s and s for which people step back after they touched the robot
CHAIR = 0.35  # m, the radius of an occupied wheelchair
ROOM = load_room()
MAP = map_of_room(ROOM)
WALLS = room_sides(ROOM)

Kind = Literal["ahead", "behind", "stood"]
"""The kind of touch: the robot touched a person ahead, or aside or behind; a person touched it."""


@dataclass
class Person:
    """A person on two legs or in a wheelchair; `step` moves them, given the robot's pose."""

    x: float
    y: float
    heading: float
    step: Callable[[Person, Drive], None] = lambda person, drive: None
    gone: float = 0.0
    radius: float = TORSO
    touches: bool = False
    bumped: float = 0.0
    """The time in s until which they step back from a robot that they touched."""
    now: tuple[float, float] = (0.0, 0.0)
    """The last step, in m."""

    def walk(self, heading: float, speed: float) -> None:
        """Walk for a tick."""
        self.heading = heading
        self.now = speed * TICK * cos(heading), speed * TICK * sin(heading)
        self.x += self.now[0]
        self.y += self.now[1]
        self.gone += speed * TICK

    def circles(self) -> Iterator[tuple[float, float, float]]:
        """Yield the circles that a laser sees: the centre and radius of legs or wheels."""
        if self.radius > TORSO:
            yield from self._wheels()
            return
        for side in (-1, 1):
            swing = side * STRIDE * sin(2 * pi * STEPS * self.gone) if self.gone else 0.0
            yield (*self._at(swing, side * APART), LEG)

    def _wheels(self) -> Iterator[tuple[float, float, float]]:
        """Yield two large wheels, two castors, and the sitting person's feet."""
        for side in (-1, 1):
            for along in np.linspace(-0.3, 0.2, 11):
                yield (*self._at(float(along), side * 0.28), 0.02)
            yield (*self._at(0.28, side * 0.22), 0.03)
            yield (*self._at(0.33, side * 0.09), 0.05)

    def _at(self, along: float, aside: float) -> tuple[float, float]:
        c, s = cos(self.heading), sin(self.heading)
        return self.x + along * c - aside * s, self.y + along * s + aside * c

    def gap(self, pose: Pose, away: Away) -> float:
        """Return the distance between this torso and a robot, in m."""
        return away(pose, self.x, self.y) - self.radius


Away = Callable[[Pose, float, float], float]
"""Returns the distance in m of a point from the edge of a robot at a pose."""


def disc(pose: Pose, x: float, y: float) -> float:
    """Return the distance of a point from a round robot."""
    return hypot(x - pose.x, y - pose.y) - ROBOT


@dataclass(frozen=True)
class Touch:
    """One touch, as it began: who touched whom, and the robot's speed, in m/s."""

    kind: Kind
    speed: float


@dataclass
class Drive:
    """One drive from a start to a goal."""

    start: Pose
    goal: Pose
    people: list[Person]
    rng: Generator
    away: Away = disc
    longest: float = LONGEST
    pose: Pose = field(init=False)
    twist: Twist = STILL
    time: float = 0.0
    arrived: bool = False
    told: str = ""
    touches: list[Touch] = field(default_factory=list)
    nearest: float = inf
    """The smallest gap to a torso at any time, in m."""
    driven_to: float = inf
    """The smallest gap to a torso while the robot drove towards a person who stood, in m."""
    near: list[float] = field(default_factory=list)
    """Its speed while a person was within a metre ahead, in m/s."""
    silent: float = 0.0
    """The longest time that it stood without an explanation, in s."""
    ticks: list[float] = field(default_factory=list)
    """The navigator's processor time for each tick, in s."""
    _quiet: float = 0.0

    def __post_init__(self) -> None:
        self.pose = self.start

    def run(self, navigator: Navigator | None = None) -> Drive:
        """Drive until it has arrived, or until the drive's time is up."""
        navigator = navigator or Navigator(MAP, self.rng, self.start)
        wheels, sent = Wheels(self.rng), [STILL] * LATE
        navigator.go(self.goal)
        scan: Scan | None = None
        while self.time < self.longest and not self.arrived:
            if scan is None or self.rng.random() >= NO_SCAN:
                scan = self.look()
            told = navigator.tick(Odometry(wheels.pose, self.twist), scan, TICK)
            sent.append(told)
            self.twist = followed(self.twist, sent.pop(0))
            wheels.turn(self.twist, TICK)
            self.move()
            self.arrived = navigator.state == "arrived"
            if navigator.state == "blocked":
                self.told = "blocked"
            self._listen(navigator)
        return self

    def move(self) -> None:
        """Move the robot and everybody for a tick, and record who touches whom."""
        at = self.pose
        self.pose = driven(at, self.twist, TICK)
        for person in self.people:
            self._note(person)
            if person.now == (0.0, 0.0):
                gap = person.gap(self.pose, self.away)
                nearer = gap < person.gap(at, self.away)
                self.driven_to = min(self.driven_to, gap) if nearer else self.driven_to
            before = person.gap(self.pose, self.away)
            was, person.now = (person.x, person.y), (0.0, 0.0)
            if self.time < person.bumped:
                person.walk(atan2(person.y - self.pose.y, person.x - self.pose.x), BACK)
            else:
                person.step(person, self)
            if person.gap(self.pose, self.away) < min(0.0, before):  # they stop at the robot
                self._note(person)
                person.x, person.y = was
        self.time += TICK

    def look(self) -> Scan:
        """Return the laser's scan."""
        first, step = -ANGLE / 2, ANGLE / (BEAMS - 1)
        angles = self.pose.heading + first + step * np.arange(BEAMS, dtype=np.float64)
        legs = [leg for person in self.people for leg in person.circles()]
        circles = np.array(legs, dtype=np.float64).reshape(-1, 3)
        ranges = cast(self.pose.x, self.pose.y, angles, WALLS, circles)
        ranges += self.rng.normal(0, NOISE, BEAMS)
        ranges[self.rng.random(BEAMS) < NO_BEAM] = inf
        return Scan(first, step, np.maximum(ranges, 0.02), 30.0)

    def _note(self, person: Person) -> None:
        """Record the distance of a person, and each touch as it begins."""
        gap = person.gap(self.pose, self.away)
        self.nearest = min(self.nearest, gap)
        bearing = atan2(person.y - self.pose.y, person.x - self.pose.x)
        off = abs(wrap(bearing - self.pose.heading))
        if 0 < gap < 0.9 and off < pi / 4:
            self.near.append(self.twist.forward)
        if gap < 0 and not person.touches:
            drives = abs(self.twist.forward) > MOVES
            ahead = off < pi / 2 if self.twist.forward >= 0 else off > pi / 2
            kind: Kind = "stood" if not drives else "ahead" if ahead else "behind"
            self.touches.append(Touch(kind, abs(self.twist.forward)))
            person.bumped = self.time + BUMPED
        person.touches = gap < 0.02 if person.touches else gap < 0

    def _listen(self, navigator: Navigator) -> None:
        moves = abs(self.twist.forward) > MOVES or abs(self.twist.turn) > 0.05
        says = navigator.yields_to != "" or navigator.state in ("blocked", "spinning", "failed")
        self._quiet = 0.0 if moves or says else self._quiet + TICK
        self.silent = max(self.silent, self._quiet)

    def count(self, kind: Kind) -> bool:
        """Return whether anybody was touched this way."""
        return any(touch.kind == kind for touch in self.touches)


def followed(twist: Twist, told: Twist) -> Twist:
    """Return a base's speed one tick after a command."""
    brakes = abs(told.forward) < abs(twist.forward)
    most = (BRAKE if brakes else GAIN) * TICK
    return Twist(
        twist.forward + float(np.clip(told.forward - twist.forward, -most, most)),
        twist.turn + float(np.clip(told.turn - twist.turn, -TURNS * TICK, TURNS * TICK)),
    )
