"""Two people pass each other beside a robot, and the tracker takes them for one."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

from tangy_hw.device_protocols import STILL, Pose, Twist
from tangy_hw.navigation.limits import MotionLimits
from tangy_hw.navigation.localisation import Estimate
from tangy_hw.navigation.poses import IDENTITY
from tangy_hw.navigation.surroundings import Surroundings
from tests.bench.people_simulation import MAP, TICK, Drive, Person, followed

SECONDS, CURVATURE = 2.5, 1.3  # 1/m, to the left
STARTS = Pose(5.0, 2.5, 0.0)


def walker(x: float, y: float, heading: float, speed: float, gone: float) -> Person:
    return Person(x, y, heading, lambda one, _: one.walk(heading, speed), gone)


def drives_past_two(seed: int) -> Drive:
    """Drive an arc as fast as allowed; two people pass each other at its left, behind the robot."""
    people = [walker(4.14, 3.42, 3.92, 0.31, 0.53), walker(2.91, 3.17, -0.03, 1.18, 0.04)]
    drive = Drive(STARTS, STARTS, people, np.random.default_rng(seed))
    limits = MotionLimits()
    around, told, late = Surroundings(MAP, IDENTITY, limits), STILL, STILL
    while drive.time < SECONDS:
        here = Estimate(drive.pose, np.zeros((3, 3)), 0.0, 1.0, 300)
        around.see(here, drive.pose, drive.look(), TICK)
        reached = limits.reached(told, drive.twist).forward + limits.acceleration * TICK
        forward = min(limits.max_speed, reached)
        told = around.limited(Twist(forward, CURVATURE * forward))
        drive.twist, late = followed(drive.twist, late), told
        drive.move()
    return drive


@pytest.mark.parametrize("seed", [0, 1, 2, 3])
def test_the_robot_stands_before_a_walker_who_comes_out_behind_another(seed: int) -> None:
    drive = drives_past_two(seed)
    assert abs(drive.pose.heading) < pi / 2  # the walker is ahead of it, or beside it
    assert [touch.kind for touch in drive.touches] == ["stood"]
