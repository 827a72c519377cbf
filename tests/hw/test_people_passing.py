"""Two people pass each other beside a robot, and the tracker takes them for one."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

from tests.bench.people_passing import START, carry_out
from tests.bench.people_simulation import Drive, Person

SECONDS, CURVATURE = 2.5, 1.3  # 1/m, to the left


def walker(x: float, y: float, heading: float, speed: float, gone: float) -> Person:
    return Person(x, y, heading, lambda one, _: one.walk(heading, speed), gone)


@pytest.mark.parametrize("seed", [0, 1, 2, 3])
def test_the_robot_stands_before_a_walker_who_comes_out_behind_another(seed: int) -> None:
    people = [walker(4.14, 3.42, 3.92, 0.31, 0.53), walker(2.91, 3.17, -0.03, 1.18, 0.04)]
    drive = Drive(START, START, people, np.random.default_rng(seed))
    carry_out(drive, CURVATURE, SECONDS)
    assert abs(drive.pose.heading) < pi / 2  # the walker is ahead of it, or beside it
    assert [touch.kind for touch in drive.touches] == ["stood"]
