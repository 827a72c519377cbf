"""How a robot drives among people in a simulated room: whom it touches, whether it arrives, when.

Run by hand: `python -m tests.bench.people_drives [SCENE ...] --drives 30`. People are discs on two
legs of which the laser sees the legs alone; the robot is a disc of .25 m with a scanner of 270
degrees at 10 Hz (2 cm of noise, 3 % of beams and 1 % of scans lost) whose commands come .1 s late.
A touch counts as the robot's while it drives and the person is before it; somebody may as well walk
into a robot that stands. No real person or base took part.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from math import atan2, cos, hypot, inf, pi, sin
from statistics import median

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
ROBOT, TORSO, LEG, APART = 0.25, 0.22, 0.06, 0.1  # m; the last: of a leg from the middle
STRIDE, STEPS = 0.2, 1.0  # m that a leg swings to either side; swings a second
GAIN, BRAKE, TURNS = 0.8, 1.0, 3.0  # m/s^2, m/s^2, rad/s^2 of the base
MOVES = 0.02  # m/s from which on the robot drives
LONGEST = 120.0  # s
ROOM = load_room()
MAP = map_of_room(ROOM)
WALLS = room_sides(ROOM)


@dataclass
class Person:
    """Somebody on two legs; `step` moves them, knowing where the robot is."""

    x: float
    y: float
    heading: float
    step: Callable[[Person, Drive], None] = lambda person, drive: None
    gone: float = 0.0

    def walk(self, heading: float, speed: float) -> None:
        """Walk for a tick."""
        self.heading = heading
        self.x += speed * TICK * cos(heading)
        self.y += speed * TICK * sin(heading)
        self.gone += speed * TICK

    def legs(self) -> Iterator[tuple[float, float, float]]:
        """Yield where the legs are, and their radius."""
        for side in (-1, 1):
            swing = side * STRIDE * sin(2 * pi * STEPS * self.gone) if self.gone else 0.0
            yield (
                self.x + swing * cos(self.heading) - side * APART * sin(self.heading),
                self.y + swing * sin(self.heading) + side * APART * cos(self.heading),
                LEG,
            )

    def gap(self, pose: Pose) -> float:
        """Return how many metres are between this torso and a robot."""
        return hypot(self.x - pose.x, self.y - pose.y) - TORSO - ROBOT


@dataclass
class Drive:
    """One drive from a start to a goal."""

    start: Pose
    goal: Pose
    people: list[Person]
    rng: Generator
    pose: Pose = field(init=False)
    twist: Twist = STILL
    time: float = 0.0
    arrived: bool = False
    told: str = ""
    ahead: bool = False
    behind: bool = False
    stood: bool = False
    nearest: float = inf
    near: list[float] = field(default_factory=list)
    """How fast it drove while somebody was within a metre before it, in m/s."""

    def __post_init__(self) -> None:
        self.pose = self.start

    def run(self, navigator: Navigator | None = None) -> Drive:
        """Drive until it has arrived, or for as long as a drive may take."""
        navigator = navigator or Navigator(MAP, self.rng, self.start)
        wheels, sent = Wheels(self.rng), [STILL] * LATE
        navigator.go(self.goal)
        scan: Scan | None = None
        while self.time < LONGEST and not self.arrived:
            if scan is None or self.rng.random() >= NO_SCAN:
                scan = self.look()
            told = navigator.tick(Odometry(wheels.pose, self.twist), scan, TICK)
            sent.append(told)
            self.twist = followed(self.twist, sent.pop(0))
            wheels.turn(self.twist, TICK)
            self.pose = driven(self.pose, self.twist, TICK)
            for person in self.people:
                person.step(person, self)
            self.time += TICK
            self.note()
            self.arrived = navigator.state == "arrived"
            if navigator.state == "blocked":
                self.told = "blocked"
        return self

    def look(self) -> Scan:
        """Return what the laser sees."""
        first, step = -ANGLE / 2, ANGLE / (BEAMS - 1)
        angles = self.pose.heading + first + step * np.arange(BEAMS, dtype=np.float64)
        legs = [leg for person in self.people for leg in person.legs()]
        circles = np.array(legs, dtype=np.float64).reshape(-1, 3)
        ranges = cast(self.pose.x, self.pose.y, angles, WALLS, circles)
        ranges += self.rng.normal(0, NOISE, BEAMS)
        ranges[self.rng.random(BEAMS) < NO_BEAM] = inf
        return Scan(first, step, np.maximum(ranges, 0.02), 30.0)

    def note(self) -> None:
        """Take note of who is touched, and by whom."""
        for person in self.people:
            gap = person.gap(self.pose)
            self.nearest = min(self.nearest, gap)
            bearing = atan2(person.y - self.pose.y, person.x - self.pose.x)
            off = abs(wrap(bearing - self.pose.heading))
            ahead = off < pi / 2
            if 0 < gap < 0.9 and off < pi / 4:  # a scan and a command late
                self.near.append(self.twist.forward)
            if gap < 0:
                drives = abs(self.twist.forward) > MOVES
                self.ahead |= drives and ahead
                self.behind |= drives and not ahead
                self.stood |= not drives


def followed(twist: Twist, told: Twist) -> Twist:
    """Return how fast a base drives a tick after it was told how."""
    brakes = abs(told.forward) < abs(twist.forward)
    most = (BRAKE if brakes else GAIN) * TICK
    return Twist(
        twist.forward + float(np.clip(told.forward - twist.forward, -most, most)),
        twist.turn + float(np.clip(told.turn - twist.turn, -TURNS * TICK, TURNS * TICK)),
    )


# ------------------------------------------------------------------------------------ scenes


def way(rng: Generator) -> tuple[Pose, Pose]:
    """Draw a start and a goal on the open floor, some metres apart."""
    while True:
        x, gx = rng.uniform(1, 9, 2)
        y, gy = rng.uniform(0.8, 4.0, 2)
        if hypot(gx - x, gy - y) > 4:
            return Pose(x, y, rng.uniform(-pi, pi)), Pose(gx, gy, pi / 2)


def along(start: Pose, goal: Pose, share: float, aside: float = 0.0) -> tuple[float, float]:
    """Return a point so far along the straight line to a goal, and so many metres to the left."""
    dx, dy = goal.x - start.x, goal.y - start.y
    far = hypot(dx, dy)
    return start.x + share * dx - aside * dy / far, start.y + share * dy + aside * dx / far


def inside(x: float, y: float, margin: float = 0.5) -> bool:
    """Say whether somebody can stand there."""
    return margin < x < ROOM.width - margin and margin < y < ROOM.table[1] - margin


def standing(rng: Generator) -> Drive:
    """Three people stand about, near the straight line."""
    start, goal = way(rng)
    people: list[Person] = []
    while len(people) < 3:
        x, y = along(start, goal, rng.uniform(0.15, 0.85), rng.uniform(-0.8, 0.8))
        apart = [hypot(x - px, y - py) for px, py in
                 ((start.x, start.y), (goal.x, goal.y), *((p.x, p.y) for p in people))]  # fmt: skip
        if inside(x, y) and min(apart) > 0.9:
            people.append(Person(x, y, rng.uniform(-pi, pi)))
    return Drive(start, goal, people, rng)


def gap(rng: Generator) -> Drive:
    """Two stand beside the line with a gap of .7 to 1 m between them."""
    while True:
        start, goal = way(rng)
        half = rng.uniform(0.7, 1.0) / 2 + TORSO
        sides = [along(start, goal, 0.5, side * half) for side in (-1, 1)]
        if all(inside(x, y) for x, y in sides):
            people = [Person(x, y, rng.uniform(-pi, pi)) for x, y in sides]
            return Drive(start, goal, people, rng)


def beside(rng: Generator) -> Drive:
    """Somebody stands .7 to .9 m beside the goal."""
    while True:
        start, goal = way(rng)
        angle, far = rng.uniform(-pi, pi), rng.uniform(0.7, 0.9)
        x, y = goal.x + far * cos(angle), goal.y + far * sin(angle)
        if inside(x, y) and hypot(x - start.x, y - start.y) > 1.5:
            return Drive(start, goal, [Person(x, y, rng.uniform(-pi, pi))], rng)


def at_the_wall(rng: Generator) -> Drive:
    """Somebody leans against the wall that the robot drives along, ankles .08 to .2 m off it."""
    start = Pose(1.0, rng.uniform(0.45, 0.6), 0.0)
    goal = Pose(rng.uniform(6.0, 8.0), rng.uniform(0.45, 0.6), 0.0)
    person = Person(rng.uniform(3.0, 4.5), rng.uniform(0.14, 0.26), 0.0)
    return Drive(start, goal, [person], rng)


def steps_in(rng: Generator) -> Drive:
    """Somebody steps from aside into the way of a robot that drives, and stands there."""
    while True:
        start, goal = way(rng)
        share, side = rng.uniform(0.35, 0.75), float(rng.choice([-1, 1]))
        x, y = along(start, goal, share, side * rng.uniform(0.9, 1.3))
        ax, ay = along(start, goal, share, rng.uniform(-0.2, 0.2))
        if not inside(x, y) or hypot(x - start.x, y - start.y) < 1.5:
            continue
        if hypot(ax - goal.x, ay - goal.y) < 1.0:
            continue
        speed, from_ = rng.uniform(0.6, 1.4), rng.uniform(0.7, 1.8)

        def step(person: Person, drive: Drive, ax: float = ax, ay: float = ay,
                 speed: float = speed, from_: float = from_) -> None:  # fmt: skip
            far = hypot(ax - person.x, ay - person.y)
            if not person.gone and hypot(drive.pose.x - ax, drive.pose.y - ay) > from_:
                return
            if far > 0.06 and person.gap(drive.pose) > 0.15:  # nobody walks into what stands there
                person.walk(atan2(ay - person.y, ax - person.x), min(speed, far / TICK))

        return Drive(start, goal, [Person(x, y, rng.uniform(-pi, pi), step)], rng)


def walking(rng: Generator, *, yields: bool = False) -> Drive:
    """Two walk to and fro across the way and look at nothing; or stop before the robot."""
    start, goal = way(rng)
    people: list[Person] = []
    for _ in range(2):
        share, speed = rng.uniform(0.2, 0.8), rng.uniform(0.3, 1.4)
        x, _ = along(start, goal, share)
        a = (float(np.clip(x + rng.uniform(-1, 1), 0.5, 9.5)), 0.6)
        b = (float(np.clip(x + rng.uniform(-1, 1), 0.5, 9.5)), 4.4)
        ends = [a, b]

        def step(person: Person, drive: Drive, ends: list[tuple[float, float]] = ends,
                 speed: float = speed) -> None:  # fmt: skip
            tx, ty = ends[0]
            if hypot(tx - person.x, ty - person.y) < 0.2:
                ends.reverse()
                return
            heading = atan2(ty - person.y, tx - person.x)
            there = replace(
                person, x=person.x + 0.5 * cos(heading), y=person.y + 0.5 * sin(heading)
            )
            if yields and there.gap(drive.pose) < min(0.4, person.gap(drive.pose)):
                return
            person.walk(heading, speed)

        at = rng.uniform(0, 1)
        person = Person(a[0] + at * (b[0] - a[0]), a[1] + at * (b[1] - a[1]), 0.0, step)
        if person.gap(start) < 0.8:
            person.x, person.y = b if hypot(b[0] - start.x, b[1] - start.y) > 1.5 else a
        people.append(person)
    return Drive(start, goal, people, rng)


def yielding(rng: Generator) -> Drive:
    """Two walk to and fro across the way, and stop before the robot."""
    return walking(rng, yields=True)


def alone(rng: Generator) -> Drive:
    """Nobody is there."""
    return Drive(*way(rng), [], rng)


SCENES: dict[str, Callable[[Generator], Drive]] = {
    "alone": alone,
    "standing": standing,
    "gap": gap,
    "beside": beside,
    "steps in": steps_in,
    "yielding": yielding,
    "walking": walking,
    "wall": at_the_wall,
}


def drives(scene: str, count: int, seed: int = 0) -> list[Drive]:
    """Drive so many times through a scene."""
    number = list(SCENES).index(scene)
    return [SCENES[scene](np.random.default_rng([seed, number, one])).run() for one in range(count)]


def row(scene: str, found: Sequence[Drive]) -> str:
    """Sum up a scene in a line."""
    arrived = [drive.time for drive in found if drive.arrived]
    told = sum(drive.told == "blocked" and not drive.arrived for drive in found)
    near = min((drive.nearest for drive in found), default=inf)
    fast = [speed for drive in found for speed in drive.near] or [0.0]
    return (
        f"{scene:<10} touched while driving: ahead {sum(d.ahead for d in found):2}, "
        f"behind {sum(d.behind for d in found):2}; while it stood {sum(d.stood for d in found):2}; "
        f"nearest {near:5.2f} m; arrived {len(arrived):2} of {len(found)} "
        f"({told} told as blocked) in {median(arrived) if arrived else inf:4.1f} s; "
        f"within 1 m {np.mean(fast):.2f} m/s, p95 {np.percentile(fast, 95):.2f}"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("scenes", nargs="*", help=f"of {', '.join(SCENES)}; default: all")
    parser.add_argument("--drives", type=int, default=30)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    for scene in options.scenes or SCENES:
        print(row(scene, drives(scene, options.drives, options.seed)), flush=True)


if __name__ == "__main__":
    main()
