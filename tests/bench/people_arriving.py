"""A walker comes out of the scanner's blind sector beside the robot: whom it touches.

Run by hand: `python -m tests.bench.people_arriving --seed 1 --meetings 400`. The walker has never
been in view, and walks to where the robot will be. Such meetings are rare in `people_drives`. The
robot has tracker and limits, but no path, and knows where it is. No real person or base took part.
"""

from __future__ import annotations

from functools import partial
from math import atan2, cos, pi, radians, sin

import numpy as np

from tangy_hw.device_protocols import Twist
from tangy_hw.navigation.limits import MotionLimits
from tangy_hw.navigation.poses import wrap
from tests.bench.people_passing import START, run_meetings
from tests.bench.people_simulation import TICK, Drive, Person
from tests.hw.raycast import driven

PACES, BEARINGS = (0.7, 1.4), (50.0, 110.0)  # m/s; degrees off its heading as they meet
TICKS = (8, 24)  # until they meet, if the robot drives on
BLIND = radians(140.0)  # off the heading: both legs are out of view
TOUCH, FREE = 0.47, 0.2  # m: between the middles as they meet, and between them at first
CURVATURE = 1.6  # 1/m of the robot's way, at most
SPEED = 0.25  # m/s: the robot drives no faster while it knows of people beside it
LIMITS = MotionLimits(max_speed=SPEED)


def meeting(number: int, seed: int) -> tuple[Drive, float]:
    """Return a robot and a person who comes from behind, and the curvature of its way in 1/m."""
    rng = np.random.default_rng([seed, number])
    while True:
        curvature, side = rng.uniform(-CURVATURE, CURVATURE), float(rng.choice([-1, 1]))
        ticks = int(rng.integers(*TICKS))
        there = START
        for _ in range(ticks):
            there = driven(there, Twist(SPEED, curvature * SPEED), TICK)
        bearing = there.heading + side * radians(rng.uniform(*BEARINGS))
        heading, pace = rng.uniform(-pi, pi), rng.uniform(*PACES)
        x = there.x + TOUCH * cos(bearing) - pace * ticks * TICK * cos(heading)
        y = there.y + TOUCH * sin(bearing) - pace * ticks * TICK * sin(heading)
        person = Person(x, y, heading, partial(_walks, heading, pace), rng.uniform(0, 1))
        drive = Drive(START, START, [person], np.random.default_rng([seed + 1, number]))
        off = abs(wrap(atan2(y - START.y, x - START.x) - START.heading))
        if person.gap(START, drive.away) > FREE and off > BLIND:
            return drive, curvature


def _walks(heading: float, pace: float, person: Person, _: Drive) -> None:
    person.walk(heading, pace)


if __name__ == "__main__":
    run_meetings(meeting, __doc__, LIMITS)
