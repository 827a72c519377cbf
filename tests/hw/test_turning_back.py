"""A walker who has passed the robot turns back beside it."""

from __future__ import annotations

from math import radians

import numpy as np
import pytest

from tangy_hw.device_protocols import STILL, Pose, Twist
from tangy_hw.navigation.limits import MotionLimits
from tangy_hw.navigation.localisation import Estimate
from tangy_hw.navigation.poses import IDENTITY
from tangy_hw.navigation.surroundings import Surroundings
from tests.bench.people_simulation import MAP, TICK, Drive, Person, followed

STARTS = Pose(5.0, 2.5, 0.0)
PACE, AWAY, BACK = 1.27, radians(-143), radians(50)  # m/s; headings of the walker
SECONDS, TURNS, RESTS = 3.0, 1.6, 1.7  # until the end; until the walker stops; and comes back


def walks(person: Person, drive: Drive) -> None:
    if drive.time < TURNS - TICK / 2:
        person.walk(AWAY, PACE)
    elif drive.time > RESTS - TICK / 2:
        person.walk(BACK, PACE)


def drives_past(seed: int) -> Drive:
    """Drive straight on as fast as allowed; a walker crosses, and turns back at its side."""
    person = Person(STARTS.x + 1.11, STARTS.y - 0.08, AWAY, walks, 0.3)
    drive = Drive(STARTS, STARTS, [person], np.random.default_rng(seed))
    limits = MotionLimits()
    around, told, late = Surroundings(MAP, IDENTITY, limits), STILL, STILL
    while drive.time < SECONDS and not drive.touches:
        here = Estimate(drive.pose, np.zeros((3, 3)), 0.0, 1.0, 300)
        around.see(here, drive.pose, drive.look(), TICK)
        reached = limits.reached(told, drive.twist).forward + limits.acceleration * TICK
        told = around.limited(Twist(min(limits.max_speed, reached), 0.0))
        drive.twist, late = followed(drive.twist, late), told
        drive.move()
    return drive


@pytest.mark.parametrize("seed", [0, 1, 2, 3])
def test_the_robot_stands_before_a_walker_who_turns_back_beside_it(seed: int) -> None:
    drive = drives_past(seed)
    assert [touch.kind for touch in drive.touches] == ["stood"]
