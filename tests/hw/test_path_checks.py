"""When a path needs replanning because a person was seen after it was planned."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

from tangy_hw.device_protocols import Pose
from tangy_hw.navigation.obstacles import Obstacles
from tangy_hw.navigation.path_checks import comes_too_near, leaves
from tangy_hw.navigation.planning import KEEP, RADIUS, plan
from tangy_hw.navigation.poses import Floats
from tests.bench.people_simulation import MAP, ROBOT, TICK, TORSO, Drive, Person

START, GOAL = Pose(1.5, 2.5, 0.0), Pose(7.5, 2.5, 0.0)
HEADINGS = [0.0, pi / 4, pi / 2]


def straight() -> Floats:
    path = plan(MAP, START[:2], GOAL[:2])
    assert path is not None
    return path.points


def replans(gap: float, heading: float, seed: int) -> bool:
    """Return whether a straight path is replanned past a torso at this distance."""
    person = Person(4.0, 2.5 + ROBOT + gap + TORSO, heading)
    drive = Drive(START, GOAL, [person], np.random.default_rng(seed))
    obstacles = Obstacles(MAP)
    for x in np.arange(START.x, 2.6, 0.05):
        drive.pose = Pose(float(x), START.y, 0.0)
        obstacles.see(drive.pose, drive.look(), TICK)
    path = straight()
    left = path[path[:, 0] > drive.pose.x]
    return comes_too_near(left, obstacles.points, drive.pose, GOAL, RADIUS, KEEP)


@pytest.mark.parametrize("heading", HEADINGS)
@pytest.mark.parametrize("gap", [0.1, 0.15, 0.19])
def test_a_path_within_20_cm_of_a_torso_is_replanned(gap: float, heading: float) -> None:
    assert replans(gap, heading, seed=3)


@pytest.mark.parametrize("heading", HEADINGS)
def test_a_path_with_more_room_is_kept(heading: float) -> None:
    assert not replans(0.4, heading, seed=3)


def test_a_path_is_another_one_if_it_leaves_the_first() -> None:
    path = straight()
    assert not leaves(path, path + np.array([0.0, 0.1]))
    assert leaves(path + np.array([0.0, 0.4]), path)
