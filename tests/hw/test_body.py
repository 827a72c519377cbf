"""A body in a robot's file: strictly checked, and driven with its true size."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from math import hypot, inf, pi, radians
from pathlib import Path

import numpy as np
import pytest

from tangy_hw.device_protocols import STILL, Odometry, Pose, Twist
from tangy_hw.navigation.limits import MotionLimits, laser_of, reach_of
from tangy_hw.navigation.navigator import Navigator
from tangy_hw.navigation.people_guard import NearbyPeople, limit_near_people, outside
from tangy_hw.navigation.people_tracker import Track
from tangy_hw.navigation.poses import Floats, compose, transform_points
from tangy_profiles.body import MEASURED, BodyProfile
from tangy_profiles.errors import ProfileError
from tangy_profiles.robot import Robot, load_robot
from tests.hw.navigated import FRONT, MAP, ROOM, TABLE
from tests.hw.raycast import Wheels, driven, look, room_sides

WIDE = """
[body]
corners = [0.4, 0.3, -0.4, 0.3, -0.4, -0.3, 0.4, -0.3]
turn = 0.8
braking = 0.9
laser = { x = 0.25, y = 0, height = 0.2, yaw = 10 }
cameras.camera = { x = 0.1, height = 1.3 }
arms = 0.7
"""


def described(folder: Path, body: str) -> Robot:
    path = folder / "mine.toml"
    path.write_text(load_robot().file.read_text(encoding="utf-8") + body, encoding="utf-8")
    return load_robot(str(path))


class TestFile:
    def test_a_file_without_a_body_gets_the_default_body(self) -> None:
        assert load_robot().body == BodyProfile()
        assert MotionLimits.of(load_robot()) == MotionLimits(max_speed=load_robot().speed)

    def test_values_that_the_file_leaves_out_are_named(self, tmp_path: Path) -> None:
        assert load_robot().body.assumed == MEASURED
        given = described(tmp_path, "[body]\nbraking = 0.8\nlaser = { x = 0.1 }\n").body
        assert given.assumed == ("radius", "turn", "acceleration")
        corners = "corners = [0.4, 0.3, -0.4, 0.3, -0.4, -0.3, 0.4, -0.3]"
        given = described(tmp_path, f"[body]\n{corners}\nturn = 1\n").body
        assert given.assumed == ("acceleration", "braking", "laser")
        for shipped in ("turtlebot4", "pepper"):
            assert load_robot(shipped).body.assumed == ()
        assert laser_of(load_robot()) == Pose(0.0, 0.0, 0.0)
        assert reach_of(load_robot()) == inf

    def test_a_body_is_read(self, tmp_path: Path) -> None:
        robot = described(tmp_path, WIDE)
        limits = MotionLimits.of(robot)
        assert limits.radius == pytest.approx(0.5) and len(limits.corners) == 4
        assert (limits.max_turn, limits.full_braking) == (0.8, 0.9) and limits.planned_braking < 0.9
        assert laser_of(robot) == pytest.approx((0.25, 0.0, radians(10)))
        assert robot.body.cameras["camera"].height == 1.3 and robot.body.arms == 0.7

    @pytest.mark.parametrize(
        ("body", "names"),
        [
            ("radius = 9", "body.radius"),
            ("raduis = 0.3", "'radius'"),
            ("corners = [0.4, 0.3, -0.4]", "body.corners"),
            ("corners = [1, 1, 2, 1, 2, 2, 1, 2]", "0, 0"),
            ("corners = [1, 1, -1, -1, 1, -1, -1, 1]", "dent"),
            ("corners = [0.4, 0.3, -0.4, 0.3, 0, -0.3]\nradius = 0.3", "radius"),
            ('braking = "hard"', "body.braking"),
            ("laser = { x = 0, z = 1 }", "body.laser.z"),
            ("laser = { yaw = 400 }", "body.laser.yaw"),
            ("laser = { range = 0.3 }", "body.laser.range = 0.3"),
            ("cameras.eye = { x = 0 }", "body.cameras.eye"),
        ],
    )
    def test_an_invalid_body_is_refused_with_the_name_of_its_key(
        self, tmp_path: Path, body: str, names: str
    ) -> None:
        with pytest.raises(ProfileError) as error:
            described(tmp_path, f"[body]\n{body}\n")
        assert names in str(error.value) and "mine.toml" in str(error.value)


CORNERS = ((0.4, 0.3), (-0.4, 0.3), (-0.4, -0.3), (0.4, -0.3))
LARGE = replace(MotionLimits(), radius=0.5, corners=CORNERS)


def person(x: float, y: float) -> NearbyPeople:
    return NearbyPeople((Track(x, y, 0, 0, 0.22, 3.0, 2.0, True, False),), np.zeros((0, 2)))


class TestGuard:
    def test_how_far_something_is_counts_from_the_edge(self) -> None:
        points = np.array([[1.0, 0.0], [0.0, 0.5], [0.7, 0.7], [0.0, 0.0]])
        expected = [0.6, 0.2, hypot(0.3, 0.4), -0.3]
        assert outside(points, np.array(CORNERS)) == pytest.approx(expected)

    def test_a_longer_body_stops_further_from_a_person(self) -> None:
        round_, large = (limit_near_people(Twist(0.4, 0.0), person(0.78, 0.0), one).forward
                         for one in (MotionLimits(), LARGE))  # fmt: skip
        assert round_ > 0.0 and large == 0.0

    def test_a_turn_keeps_the_corners_of_the_body_off_people(self) -> None:
        assert limit_near_people(Twist(0.0, 0.8), person(0.35, 0.65), LARGE) == STILL
        assert limit_near_people(Twist(0.0, 0.8), person(1.5, 0.0), LARGE) == Twist(0.0, 0.8)


def edge(pose: Pose) -> Floats:
    """Return points round the robot's edge, 5 cm apart at most, at its pose."""
    ends = np.array([*CORNERS, CORNERS[0]])
    sides = [a + np.linspace(0, 1, 17)[:, None] * (b - a)
             for a, b in pairwise(ends)]  # fmt: skip
    return transform_points(np.vstack(sides), pose)


@pytest.mark.slow
@pytest.mark.parametrize("goal", [Pose(8.2, 1.2, pi / 2), Pose(1.6, 3.2, pi / 2)])
def test_a_robot_with_corners_and_its_scanner_aside_touches_no_wall(goal: Pose) -> None:
    laser, rng = Pose(0.25, 0.0, radians(10)), np.random.default_rng(3)
    navigator = Navigator(MAP, np.random.default_rng(4), FRONT, limits=LARGE, laser=laser)
    true, twist, wheels, walls = FRONT, STILL, Wheels(rng), room_sides(ROOM)
    navigator.go(goal)
    left, near, right, far = TABLE
    for _ in range(900):
        scan = look(walls, compose(true, laser), rng)
        twist = navigator.tick(Odometry(wheels.pose, twist), scan, 0.1)
        wheels.turn(twist, 0.1)
        true = driven(true, twist, 0.1)
        x, y = edge(true).T
        assert x.min() > 0 and x.max() < ROOM.width and y.min() > 0 and y.max() < ROOM.depth
        assert not ((x > left) & (x < right) & (y > near) & (y < far)).any()
        if navigator.state == "arrived":
            break
    assert navigator.state == "arrived"
    assert hypot(true.x - goal.x, true.y - goal.y) < 0.15


@pytest.mark.slow
@pytest.mark.parametrize("heading", [0.0, pi / 2])
def test_a_robot_with_corners_turns_only_where_they_have_room(heading: float) -> None:
    rng, walls, place = np.random.default_rng(5), room_sides(ROOM), Pose(2.0, 0.42, heading)
    navigator = Navigator(MAP, np.random.default_rng(6), place, limits=LARGE)
    true, twist, wheels, waits = place, STILL, Wheels(rng), set()
    navigator.spin()
    for _ in range(60):
        scan = look(walls, true, rng)
        twist = navigator.tick(Odometry(wheels.pose, twist), scan, 0.1)
        wheels.turn(twist, 0.1)
        true = driven(true, twist, 0.1)
        waits.add(navigator.yields_to)
        assert edge(true)[:, 1].min() > 0.0
    assert navigator.state == "spinning" and "object" in waits


@pytest.mark.slow
def test_a_robot_with_corners_turns_where_there_is_room() -> None:
    rng, walls, place = np.random.default_rng(5), room_sides(ROOM), Pose(5.0, 2.0, 0.0)
    navigator = Navigator(MAP, np.random.default_rng(6), place, limits=LARGE)
    twist, wheels = STILL, Wheels(rng)
    true = place
    navigator.spin()
    for _ in range(160):
        twist = navigator.tick(Odometry(wheels.pose, twist), look(walls, true, rng), 0.1)
        wheels.turn(twist, 0.1)
        true = driven(true, twist, 0.1)
    assert navigator.state == "idle" and navigator.yields_to == ""
