"""The navigator: drives round obstacles, and waits while no path is free."""

from __future__ import annotations

from dataclasses import replace
from math import pi

import numpy as np
import pytest

from tangy_hw.device_protocols import STILL, Pose, Scan, Twist
from tangy_hw.navigation.limits import MotionLimits
from tangy_hw.navigation.localisation import Estimate
from tangy_hw.navigation.obstacles import Obstacles
from tangy_hw.navigation.occupancy import seat_feet, table_legs, with_feet
from tangy_hw.navigation.poses import IDENTITY
from tangy_hw.navigation.surroundings import Surroundings
from tests.bench.people_drives import MAP, ROOM, drives
from tests.bench.people_simulation import TICK, Drive, Person
from tests.hw.navigated import CHAIR, ROW, DrivenRobot, at_seat
from tests.hw.raycast import look, room_sides

HERE = Pose(5.0, 2.5, 0.0)
LEGS = [(x / 10, 2.7, x / 10 + 0.15, 2.85) for x in range(0, 100, 3)]


class TestObstacles:
    @pytest.mark.slow
    def test_the_robot_drives_round_a_chair_in_its_path(self) -> None:
        robot = DrivenRobot()
        robot.navigator.go(at_seat(3))
        robot.run(3)
        robot.boxes.append(CHAIR)
        assert robot.arrives() and robot.off(at_seat(3))[0] < 0.1
        assert ("replanned", "replanned") in robot.seen
        assert robot.seen[-1] == ("arrived", "clear")
        assert not robot.touched

    @pytest.mark.slow
    def test_the_robot_waits_for_a_blocked_path_to_clear(self) -> None:
        robot = DrivenRobot()
        robot.navigator.go(at_seat(3))
        robot.run(2)
        robot.boxes.append(ROW)
        assert robot.run(30, lambda: robot.navigator.state == "blocked")
        assert robot.navigator.facts()["path"] == "none" and robot.navigator.why
        robot.run(3)
        assert robot.twist == STILL
        robot.boxes.clear()
        assert robot.arrives() and not robot.touched

    @pytest.mark.slow
    def test_obstacles_that_seem_to_walk_still_block_the_path(
        self, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        robot, goal = DrivenRobot(), at_seat(3)
        robot.navigator.go(goal)
        robot.run(2)
        robot.boxes += LEGS
        assert robot.run(30, lambda: robot.navigator.state == "blocked")
        with monkeypatch.context() as jumping:
            jumping.setattr("tangy_hw.navigation.surroundings.WALKS", -1.0)
            assert not robot.navigator.finds_way(goal)
        robot.boxes.clear()
        assert robot.run(5, lambda: robot.navigator.finds_way(goal))

    @pytest.mark.slow
    @pytest.mark.parametrize("seed", [228, 231, 244])
    def test_a_robot_gives_up_soon_before_a_row_of_legs(self, seed: int) -> None:
        """With these seeds it drove up and down before the row for a minute."""
        robot = DrivenRobot(seed=seed)
        robot.navigator.go(at_seat(3))
        robot.run(2)
        robot.boxes += LEGS
        assert robot.run(18, lambda: robot.navigator.state == "blocked") and not robot.touched

    def test_what_stays_at_its_place_does_not_go_with_a_walker(
        self, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setattr("tangy_hw.navigation.surroundings.WALKS", -1.0)  # all seem to walk
        around = Surroundings(MAP, IDENTITY, MotionLimits())
        here = Estimate(Pose(6.4, 1.2, pi / 2), np.zeros((3, 3)), 0.1, 1.0, 300)
        scan, seen = look(room_sides(ROOM, CHAIR), here.pose), []
        for _ in range(12):
            around.see(here, here.pose, scan, 0.4)
            seen.append(len(around.standing))
        assert seen[:8] == [0] * 8 and seen[-1] == len(around.points) > 0

    def test_who_is_seen_for_the_first_time_may_walk(self) -> None:
        """A track is confirmed by the third scan: the robot slows down at the first."""
        person = Person(HERE.x + 1.2, HERE.y, pi)
        drive = Drive(HERE, HERE, [person], np.random.default_rng(1))
        around, speeds = Surroundings(MAP, IDENTITY, MotionLimits()), []
        for _ in range(12):
            around.see(Estimate(HERE, np.zeros((3, 3)), 0.0, 1.0, 300), HERE, drive.look(), TICK)
            speeds.append(around.limited(Twist(0.5, 0.0)).forward)
        assert max(speeds[:2]) <= 0.2 < speeds[2] < speeds[-1] == 0.5

    def test_what_was_gone_in_the_meantime_is_seen_anew(self) -> None:
        obstacles, here = Obstacles(MAP), Pose(6.4, 1.2, pi / 2)
        chair, empty = (look(room_sides(ROOM, *boxes), here) for boxes in ([CHAIR], []))
        for scan in [chair] * 10 + [empty] * 10 + [chair] * 4:
            obstacles.see(here, scan, 0.5)
        assert obstacles.seconds.max() == pytest.approx(1.5, abs=0.01)

    @pytest.mark.slow
    def test_a_robot_enclosed_by_chairs_reports_no_path(self) -> None:
        robot = DrivenRobot()
        robot.navigator.go(at_seat(0))
        robot.run(4)
        x, y = robot.true.x, robot.true.y
        robot.boxes += [(x - 1, y + side, x + 1, y + side + 0.1) for side in (-1, 0.9)]
        robot.boxes += [(x + side, y - 1, x + side + 0.1, y + 1) for side in (-1, 0.9)]
        assert robot.run(15, lambda: robot.navigator.facts()["path"] == "none")
        assert not any(state == "spinning" for state, _ in robot.seen)
        robot.boxes.clear()
        assert robot.arrives() and not robot.touched

    @pytest.mark.slow
    def test_a_passing_person_causes_no_detour(self) -> None:
        robot = DrivenRobot()
        robot.navigator.go(at_seat(0))
        robot.run(4)
        ahead = Pose(robot.true.x + 0.8 * np.cos(robot.true.heading),
                     robot.true.y + 0.8 * np.sin(robot.true.heading), 0)  # fmt: skip
        robot.boxes.append((ahead.x - 0.1, ahead.y - 0.1, ahead.x + 0.1, ahead.y + 0.1))
        robot.run(0.7)
        robot.boxes.clear()
        assert robot.arrives()
        assert {path for _, path in robot.seen} == {"clear"} and not robot.touched

    def test_seen_obstacles_are_shown_until_they_are_gone(self) -> None:
        robot = DrivenRobot(CHAIR)
        robot.run(1)
        points = robot.navigator.obstacles
        assert len(points) > 3
        assert np.abs(points - (6.4, 2.7)).max() < 0.4
        robot.boxes.clear()
        robot.run(3)
        assert len(robot.navigator.obstacles) == 0

    def test_beams_that_end_at_the_range_clear_obstacles_and_are_none(self) -> None:
        obstacles, here = Obstacles(MAP), Pose(5.0, 1.2, pi / 2)
        near, gone = (
            Scan(-wide, 0.01, np.full(round(200 * wide), far), 3.0)
            for wide, far in ((0.5, 1.2), (0.6, 3.0))
        )
        assert obstacles.unmapped(here, near).all()
        for _ in range(10):
            obstacles.see(here, near, 0.1)
        assert len(obstacles.points)
        assert not obstacles.unmapped(here, gone).any()
        for _ in range(30):
            obstacles.see(here, gone, 0.1)
        assert not len(obstacles.points)

    def test_mapped_points_are_separated_from_unmapped_ones(self) -> None:
        obstacles = Obstacles(MAP)
        points = np.array([(0.0, 3.0), (1.3, 5.1), (5.0, 3.0), (0.5, 3.0), (-40.0, 3.0)])
        assert obstacles.among(points).tolist() == [False, False, True, True, True]

    def test_a_person_close_to_a_wall_or_a_table_leg_is_unmapped(self) -> None:
        leg = table_legs(ROOM)[0]
        at_the_wall = [(3.0, off) for off in (0.0, 0.05, 0.17, 0.2)]
        at_the_table = [(leg.x + off, leg.y) for off in (0.0, 0.05, 0.17, 0.2)]
        for points in (at_the_wall, at_the_table):
            assert Obstacles(MAP).among(np.array(points)).tolist() == [False, False, True, True]

    def test_moved_feet_under_the_table_stay_mapped(self) -> None:
        foot = seat_feet(ROOM, ROOM.seats[0])[0]
        moved = np.array([(foot.x - 0.06, foot.y + 0.12), (foot.x, foot.y - 0.15)])
        assert Obstacles(MAP).among(moved).tolist() == [False, False]
        recorded = replace(MAP, feet=np.zeros_like(MAP.feet))
        assert Obstacles(recorded).among(moved).tolist() == [False, True]  # a chair leg, nothing
        assert Obstacles(with_feet(recorded, ROOM)).among(moved).tolist() == [False, False]


class TestPeople:
    """Drives among people in a simulated room; `tests.bench.people_drives` makes more of them."""

    @pytest.mark.slow
    @pytest.mark.parametrize("scene", ["standing", "gap", "beside", "steps in"])
    def test_no_drive_touches_a_standing_person(self, scene: str) -> None:
        for drive in drives(scene, 2, seed=7):
            assert drive.arrived and drive.silent < 1.0
            # before a goal beside a person it may wait, rather than creep up to them, and says so
            assert drive.told in ("", "blocked" if scene == "beside" else "")
            assert drive.nearest > 0.2 or scene == "steps in"  # there the person comes nearer
            assert drive.nearest > 0.05 and not drive.touches

    @pytest.mark.slow
    def test_the_robot_drives_slowly_before_a_person_who_stepped_in(self) -> None:
        (drive,) = drives("steps in", 1, seed=11)
        assert drive.near and np.median(drive.near) <= 0.15

    @pytest.mark.slow
    def test_the_robot_explains_a_slow_approach_to_a_goal_beside_a_person(self) -> None:
        goal, person = Pose(5.0, 2.0, 0.0), Person(5.66, 2.0, 1.0)
        drive = Drive(Pose(4.8, 2.0, 0.0), goal, [person], np.random.default_rng(3)).run()
        assert drive.arrived and not drive.touches
        assert drive.silent < 1.0

    @pytest.mark.slow
    def test_a_drive_without_people_is_not_slowed_down(self) -> None:
        """It takes no longer than before the robot kept away from people."""
        for drive, seconds in zip(drives("alone", 2, seed=7), (16.3, 15.0), strict=True):
            assert drive.arrived and drive.time <= seconds


def test_beams_without_a_measurement_neither_show_nor_clear_an_obstacle() -> None:
    obstacles, scan = Obstacles(MAP), look(room_sides(ROOM, (5.8, 2.4, 6.0, 2.6)), HERE)
    for _ in range(3):
        obstacles.see(HERE, scan, TICK)
    before = len(obstacles.points)
    assert before
    for _ in range(20):
        obstacles.see(HERE, replace(scan, ranges=np.full_like(scan.ranges, np.inf)), TICK)
    assert len(obstacles.points) == before
