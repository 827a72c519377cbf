"""Scenes of people who stand, walk, wander and step in, in a simulated room."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import atan2, cos, hypot, pi, sin

import numpy as np
from numpy.random import Generator

from tangy_hw.device_protocols import Pose
from tests.bench.people_simulation import CHAIR, ROOM, TICK, TORSO, Drive, Person

Step = Callable[[Person, Drive], None]


def way(rng: Generator) -> tuple[Pose, Pose]:
    """Draw a start and a goal on the open floor, some metres apart."""
    while True:
        x, gx = rng.uniform(1, 9, 2)
        y, gy = rng.uniform(0.8, 4.0, 2)
        if hypot(gx - x, gy - y) > 4:
            return Pose(x, y, rng.uniform(-pi, pi)), Pose(gx, gy, pi / 2)


def along(start: Pose, goal: Pose, share: float, aside: float = 0.0) -> tuple[float, float]:
    """Return the point this far along the straight line to a goal, and this many m to its left."""
    dx, dy = goal.x - start.x, goal.y - start.y
    far = hypot(dx, dy)
    return start.x + share * dx - aside * dy / far, start.y + share * dy + aside * dx / far


def inside(x: float, y: float, margin: float = 0.5) -> bool:
    """Return whether a person can stand there."""
    return margin < x < ROOM.width - margin and margin < y < ROOM.table[1] - margin


def standing(rng: Generator) -> Drive:
    """Three people stand near the straight line."""
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
    """A person stands .7 to .9 m beside the goal."""
    while True:
        start, goal = way(rng)
        angle, far = rng.uniform(-pi, pi), rng.uniform(0.7, 0.9)
        x, y = goal.x + far * cos(angle), goal.y + far * sin(angle)
        if inside(x, y) and hypot(x - start.x, y - start.y) > 1.5:
            return Drive(start, goal, [Person(x, y, rng.uniform(-pi, pi))], rng)


def at_the_wall(rng: Generator) -> Drive:
    """A person leans against the wall that the robot drives along, ankles .08 to .2 m off it."""
    start = Pose(1.0, rng.uniform(0.45, 0.6), 0.0)
    goal = Pose(rng.uniform(6.0, 8.0), rng.uniform(0.45, 0.6), 0.0)
    person = Person(rng.uniform(3.0, 4.5), rng.uniform(0.14, 0.26), 0.0)
    return Drive(start, goal, [person], rng)


def steps_in(rng: Generator) -> Drive:
    """A person steps from the side into the path of the moving robot, and stands there."""
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
            if (
                far > 0.06 and person.gap(drive.pose, drive.away) > 0.15
            ):  # nobody walks into an object there
                person.walk(atan2(ay - person.y, ax - person.x), min(speed, far / TICK))

        return Drive(start, goal, [Person(x, y, rng.uniform(-pi, pi), step)], rng)


def walking(rng: Generator, *, yields: bool = False, slow: bool = False) -> Drive:
    """Two walk to and fro across the path and look at nothing; or stop before the robot."""
    start, goal = way(rng)
    people: list[Person] = []
    for _ in range(2):
        share, speed = rng.uniform(0.2, 0.8), rng.uniform(0.3, 0.9 if slow else 1.4)
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
            if yields and there.gap(drive.pose, drive.away) < min(
                0.4, person.gap(drive.pose, drive.away)
            ):
                return
            person.walk(heading, speed)

        at = rng.uniform(0, 1)
        person = Person(a[0] + at * (b[0] - a[0]), a[1] + at * (b[1] - a[1]), 0.0, step)
        if hypot(person.x - start.x, person.y - start.y) < 1.3:
            person.x, person.y = b if hypot(b[0] - start.x, b[1] - start.y) > 1.5 else a
        people.append(person)
    return Drive(start, goal, people, rng)


def yielding(rng: Generator) -> Drive:
    """Two walk to and fro across the path, and stop before the robot."""
    return walking(rng, yields=True)


def wandering(rng: Generator) -> Drive:
    """Two turn, stop and go as they like, and look at nothing."""
    start, goal = way(rng)
    people: list[Person] = []
    while len(people) < 2:
        x, y = along(start, goal, rng.uniform(0.2, 0.8), rng.uniform(-1.2, 1.2))
        if inside(x, y) and hypot(x - start.x, y - start.y) > 1.5:
            people.append(Person(x, y, rng.uniform(-pi, pi), _wanders(rng)))
    return Drive(start, goal, people, rng)


def _wanders(rng: Generator) -> Step:
    until, speed, heading = 0.0, 0.0, 0.0

    def step(person: Person, drive: Drive) -> None:
        nonlocal until, speed, heading
        x, y = person.x + 0.6 * cos(heading), person.y + 0.6 * sin(heading)
        if drive.time >= until or (speed and not inside(x, y)):
            until = drive.time + rng.uniform(0.8, 3.0)
            speed = 0.0 if rng.random() < 0.4 else rng.uniform(0.3, 1.2)
            heading = rng.uniform(-pi, pi)
        if speed and inside(person.x + speed * TICK * cos(heading),
                            person.y + speed * TICK * sin(heading)):  # fmt: skip
            person.walk(heading, speed)

    return step


def group(rng: Generator) -> Drive:
    """Four stand together and talk, on the path."""
    while True:
        start, goal = way(rng)
        x, y = along(start, goal, rng.uniform(0.4, 0.6), rng.uniform(-0.3, 0.3))
        if not inside(x, y, 1.0) or min(hypot(x - p.x, y - p.y) for p in (start, goal)) < 1.5:
            continue
        round_ = rng.uniform(0, pi / 2) + pi / 2 * np.arange(4)
        people = [
            Person(x + 0.5 * cos(angle), y + 0.5 * sin(angle), float(angle) + pi)
            for angle in round_
        ]
        return Drive(start, goal, people, rng)


def wheelchair(rng: Generator) -> Drive:
    """A person in a wheelchair goes to and fro across the path, and looks at nothing."""
    drive = walking(rng, slow=True)
    drive.people = drive.people[:1]
    drive.people[0].radius = CHAIR
    return drive


def overtaken(rng: Generator) -> Drive:
    """A person comes from straight behind, faster than the robot drives."""
    while True:
        start, goal = way(rng)
        start = start._replace(heading=atan2(goal.y - start.y, goal.x - start.x))
        x, y = along(start, goal, -0.2)
        if not inside(x, y) or hypot(x - start.x, y - start.y) < 0.9:
            continue
        speed = rng.uniform(0.7, 1.2)
        end = along(start, goal, 1.0)

        def step(person: Person, drive: Drive, speed: float = speed,
                 end: tuple[float, float] = end) -> None:  # fmt: skip
            far = hypot(end[0] - person.x, end[1] - person.y)
            if far > 0.3 and drive.time > 2.0:
                person.walk(atan2(end[1] - person.y, end[0] - person.x), speed)

        return Drive(start, goal, [Person(x, y, start.heading, step)], rng)


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
    "wandering": wandering,
    "group": group,
    "wheelchair": wheelchair,
    "overtaken": overtaken,
    "wall": at_the_wall,
}
