"""A walker who has passed the robot turns round beside it, and comes back: whom it touches.

Run by hand: `python -m tests.bench.people_turning --seed 1 --meetings 400`. Such meetings are rare
in `people_drives`. The robot has tracker and limits, but no path, and knows where it is. No real
person or base took part.
"""

from __future__ import annotations

from collections.abc import Callable
from math import atan2, cos, pi, sin

import numpy as np
from numpy.random import Generator

from tangy_hw.navigation.poses import wrap
from tests.bench.people_passing import START, run_meetings
from tests.bench.people_simulation import Drive, Person

AHEAD, PACES, TURNS = (0.9, 1.6), (0.7, 1.4), (70.0, 110.0)  # m; m/s; degrees off the heading
CLEAR, AIMS = (0.4, 1.1), (0.0, 0.6)  # m between them as they turn round; m ahead of its middle
CURVATURE = 0.6  # 1/m of the robot's way, at most


def meeting(number: int, seed: int) -> tuple[Drive, float]:
    """Return a robot and a person who crosses before it, and the curvature of its way in 1/m."""
    rng = np.random.default_rng([seed, number])
    side = float(rng.choice([-1, 1]))
    far, heading = rng.uniform(*AHEAD), side * rng.uniform(0.5 * pi, 0.85 * pi)
    x, y = START.x + far, START.y - side * rng.uniform(0.0, 0.8)
    person = Person(x, y, heading, _crosses(rng, heading), rng.uniform(0, 1))
    drive = Drive(START, START, [person], np.random.default_rng([seed + 1, number]))
    return drive, rng.uniform(-CURVATURE, CURVATURE)


def _crosses(rng: Generator, heading: float) -> Callable[[Person, Drive], None]:
    pace, clear = rng.uniform(*PACES), rng.uniform(*CLEAR)
    passed, aim = np.radians(rng.uniform(*TURNS)), rng.uniform(*AIMS)
    back: float | None = None

    def step(person: Person, drive: Drive) -> None:
        nonlocal back
        pose = drive.pose
        off = abs(wrap(atan2(person.y - pose.y, person.x - pose.x) - pose.heading))
        if back is None and off > passed and person.gap(pose, drive.away) > clear:
            x, y = pose.x + aim * cos(pose.heading), pose.y + aim * sin(pose.heading)
            back = atan2(y - person.y, x - person.x)
        person.walk(heading if back is None else back, pace)

    return step


if __name__ == "__main__":
    run_meetings(meeting, __doc__)
