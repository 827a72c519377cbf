"""Two people who pass each other beside a robot that drives an arc: whom it touches.

Run by hand: `python -m tests.bench.people_passing --seed 77 --first 200 --meetings 400`. One of the
two comes to where the robot will be. Such meetings are rare in `people_drives`. The robot has
tracker and limits, but no path, and knows where it is. No real person or base took part.
"""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Callable
from math import cos, pi, sin

import numpy as np

from tangy_hw.device_protocols import STILL, Pose, Twist
from tangy_hw.navigation.limits import MotionLimits
from tangy_hw.navigation.localisation import Estimate
from tangy_hw.navigation.poses import IDENTITY
from tangy_hw.navigation.surroundings import Surroundings
from tests.bench.people_simulation import MAP, TICK, Drive, Person, followed
from tests.hw.raycast import driven

START, SECONDS = Pose(5.0, 2.5, 0.0), 3.6
FREE, MEETS = 0.4, 0.47  # m: between the robot and people at first; between the middles at the end


def meeting(number: int, seed: int) -> tuple[Drive, float] | None:
    """Return a robot with two people who will pass each other beside it, and its curvature in 1/m.

    None if somebody would stand too near at first.
    """
    rng = np.random.default_rng([seed, number])
    curvature = float(rng.uniform(0, 1.8) * rng.choice([-1, 1]))
    pose, speed = START, float(rng.choice([0.0, 0.5]))
    way = [pose]
    for _ in range(40):
        speed = min(0.5, speed + 0.05)
        pose = driven(pose, Twist(speed, curvature * speed), TICK)
        way.append(pose)
    met = int(rng.uniform(20, 30))
    there, after = way[met], TICK * met
    pace = rng.uniform(0.7, 1.4)
    bearing = there.heading + np.sign(curvature) * rng.uniform(1.2, 2.4)
    heading = bearing + pi + rng.uniform(-0.5, 0.5)
    x = there.x + MEETS * cos(bearing) - pace * after * cos(heading)
    y = there.y + MEETS * sin(bearing) - pace * after * sin(heading)
    passes = after - rng.uniform(0.4, 1.3)
    other, away = rng.uniform(0.3, 1.4), heading + pi + rng.uniform(-1, 1)
    ox = x + pace * passes * cos(heading) + rng.normal(0, 0.2) - other * passes * cos(away)
    oy = y + pace * passes * sin(heading) + rng.normal(0, 0.2) - other * passes * sin(away)
    people = [_walker(ox, oy, away, other), _walker(x, y, heading, pace)]
    for one in people:
        one.gone = rng.uniform(0, 1)
    drive = Drive(START, START, people, np.random.default_rng([seed + 1, number]))
    near = min(one.gap(START, drive.away) for one in people)
    return (drive, curvature) if near >= FREE else None


def _walker(x: float, y: float, heading: float, speed: float) -> Person:
    return Person(x, y, heading, lambda one, _: one.walk(heading, speed))


def carry_out(
    drive: Drive,
    curvature: float = 0.0,
    seconds: float = SECONDS,
    limits: MotionLimits | None = None,
) -> None:
    """Drive for some s, as fast as the limits allow; `drive.touches` tells who was touched.

    `curvature` is that of the robot's way in 1/m, to the left.
    """
    limits = limits or MotionLimits()
    around, told, late = Surroundings(MAP, IDENTITY, limits), STILL, STILL
    for _ in range(round(seconds / TICK)):
        here = Estimate(drive.pose, 1e-4 * np.eye(3), 0.02, 1.0, 300)
        around.see(here, drive.pose, drive.look(), TICK)
        reached = limits.reached(told, drive.twist).forward
        forward = min(limits.max_speed, max(0.0, reached) + limits.acceleration * TICK)
        told = around.limited(Twist(forward, curvature * forward))
        drive.twist, late = followed(drive.twist, late), told
        drive.move()


def run_meetings(
    meet: Callable[[int, int], tuple[Drive, float] | None],
    about: str | None,
    limits: MotionLimits | None = None,
) -> None:
    """Carry out the meetings of the command line, and print whom the robot touched.

    Args:
        meet: returns the drive and its curvature in 1/m for a number and a seed, None for none.
        about: the help of the command line.
        limits: those of the robot; None: the usual ones.
    """
    parser = argparse.ArgumentParser(description=about)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--meetings", type=int, default=400)
    options = parser.parse_args()
    firsts: Counter[str] = Counter()
    for number in range(options.first, options.first + options.meetings):
        if (met := meet(number, options.seed)) is None:
            continue
        drive, curvature = met
        carry_out(drive, curvature, limits=limits)
        firsts[drive.touches[0].kind if drive.touches else "none"] += 1
        for touch in drive.touches:
            if touch.kind == "ahead":
                print(f"meeting {number}: touched ahead at {touch.speed:.2f} m/s", flush=True)
    print(f"{firsts.total()} meetings, by the first touch: {dict(firsts)}")


if __name__ == "__main__":
    run_meetings(meeting, __doc__)
