"""Localisation: pose tracking, global localisation, and the kidnapped robot."""

from __future__ import annotations

from math import hypot, inf
from unittest.mock import patch

import numpy as np
import pytest

from tangy_hw.device_protocols import Pose, Scan, Twist
from tangy_hw.navigation.localisation import LOST, Estimate, Localisation
from tangy_hw.navigation.occupancy import map_of_room
from tangy_hw.navigation.particles import FEWEST, MOST, near
from tangy_hw.navigation.poses import wrap
from tangy_hw.navigation.recent_scans import FEWEST as FEWEST_SCANS
from tangy_hw.navigation.recent_scans import Comparison, RecentScans
from tangy_profiles.room import load_room
from tests.bench.lost_robots import in_room
from tests.hw.raycast import Wheels, driven, look, room_sides, sides, tour

ROOM = load_room()
MAP = map_of_room(ROOM)
SIDES = room_sides(ROOM)
START = Pose(5.0, 1.2, 0.0)
ROUND = tour([(5, 1.2), (8, 4.2), (5, 1.2), (2, 4.2), (5, 1.2)])


class Driven:
    """A robot that drives through the room and localises itself."""

    def __init__(self, seed: int, start: Pose | None = START, true: Pose = START) -> None:
        self.rng = np.random.default_rng(seed)
        self.true = true
        self.wheels = Wheels(self.rng)
        self.sides = SIDES
        self.localisation = Localisation(MAP, np.random.default_rng(seed + 1), start)

    def drive(self, twists: list[Twist]) -> list[tuple[float, Estimate]]:
        """Drive; return the error in metres and the estimate after each step."""
        found = []
        for twist in twists:
            self.true = driven(self.true, twist, 0.1)
            scan = look(self.sides, self.true, self.rng)
            estimate = self.localisation.update(self.wheels.turn(twist, 0.1), scan)
            off = hypot(estimate.pose.x - self.true.x, estimate.pose.y - self.true.y)
            found.append((off, estimate))
        return found

    def heading_off(self, estimate: Estimate) -> float:
        return abs(wrap(estimate.pose.heading - self.true.heading))


class TestFollowing:
    @pytest.mark.slow
    @pytest.mark.parametrize("seed", [1, 2])
    def test_a_driving_robot_is_localised_within_centimetres(self, seed: int) -> None:
        found = Driven(seed).drive(ROUND)
        off = [one for one, _ in found]
        assert np.median(off) < 0.02 and np.percentile(off, 95) < 0.05
        last = found[-1][1]
        assert last.spread < 0.15 and last.fit > 0.9 and not last.lost
        assert FEWEST <= last.count <= MOST
        assert np.linalg.eigvalsh(last.covariance).min() > -1e-9

    @pytest.mark.parametrize("seed", [1, 2])
    def test_a_robot_is_localised_with_scans_metres_apart(self, seed: int) -> None:
        robot = Driven(seed)
        off = []
        for number, twist in enumerate(ROUND):
            robot.true = driven(robot.true, twist, 0.1)
            counted = robot.wheels.turn(twist, 0.1)
            if number % 40 == 0:
                scan = look(robot.sides, robot.true, robot.rng)
                pose = robot.localisation.update(counted, scan).pose
                off.append(hypot(pose.x - robot.true.x, pose.y - robot.true.y))
        assert np.median(off) < 0.05 and max(off) < 0.3

    def test_the_same_seed_gives_the_same_poses(self) -> None:
        first, second = (Driven(4).drive(ROUND[:60])[-1][1] for _ in range(2))
        assert first.pose == second.pose and first.fit == second.fit

    def test_odometry_moves_the_pose_between_two_particle_updates(self) -> None:
        robot = Driven(5)
        robot.drive([Twist(0, 0)] * 3)
        before = robot.localisation.particles.copy()
        off, _ = robot.drive([Twist(0.3, 0)])[-1]
        assert (robot.localisation.particles == before).all()  # 3 cm are too little for an update
        assert off < 0.1

    def test_standing_people_do_not_lower_the_confidence(self) -> None:
        robot = Driven(6)
        robot.drive(ROUND[:30])
        robot.sides = np.vstack(
            (SIDES, sides((4, 3, 4.3, 3.3), (6.5, 2, 6.8, 2.3), (7, 3.6, 7.3, 3.9)))
        )
        found = robot.drive(ROUND[30:120])
        assert min(estimate.fit for _, estimate in found) > LOST
        assert max(off for off, _ in found) < 0.1

    def test_the_pose_follows_the_odometry_inside_a_ring_of_chairs(self) -> None:
        robot = Driven(7)
        robot.drive(ROUND[:30])
        x, y = robot.true.x, robot.true.y
        robot.sides = np.vstack((SIDES, sides((x - 1, y - 1, x + 1, y + 1))))
        found = robot.drive([Twist(0, 0.4)] * 100)
        assert max(off for off, _ in found) < 0.1
        assert not any(estimate.lost for _, estimate in found)

    def test_a_covered_scanner_leaves_the_pose_unchanged(self) -> None:
        robot = Driven(8)
        _, before = robot.drive(ROUND[:30])[-1]
        cloth = Scan(-2.3, 4.6 / 359, np.full(360, 0.05), 30.0)
        for _ in range(50):
            after = robot.localisation.update(robot.wheels.pose, cloth)
        assert after.pose == pytest.approx(before.pose, abs=0.02) and not after.lost


class TestFinding:
    @pytest.mark.slow
    @pytest.mark.parametrize("seed", [10, 11])
    def test_a_turn_localises_a_robot_without_a_start_pose(self, seed: int) -> None:
        robot = Driven(seed, start=None, true=Pose(3.0, 2.0, 0.4))
        off, estimate = robot.drive([Twist(0, 0.5)] * 126)[-1]
        assert off < 0.15 and robot.heading_off(estimate) < 0.1
        assert estimate.settled and estimate.spread < 0.3

    @pytest.mark.parametrize(("apart", "fewest", "most"), [(3, 13, 40), (40, 4, 8)])
    def test_a_place_is_believed_after_many_scans_or_after_a_few_that_lie_metres_apart(
        self, apart: int, fewest: int, most: int
    ) -> None:
        robot = Driven(2, start=None)
        scans, settled = 0, False
        for number, twist in enumerate(ROUND):
            robot.true = driven(robot.true, twist, 0.1)
            counted = robot.wheels.turn(twist, 0.1)
            if number % apart == 0 and not settled:
                scan = look(robot.sides, robot.true, robot.rng)
                settled = robot.localisation.update(counted, scan).settled
                scans += 1
        assert settled and fewest <= scans <= most

    @pytest.mark.slow
    def test_scans_a_metre_apart_do_not_lead_to_a_wrong_place(self) -> None:
        found = in_room(MAP, 2.5, tries=20, seed=11)
        assert found.wrong == found.never == found.wrong_looks == 0
        assert np.median(found.metres) < 8.0

    @pytest.mark.slow
    @pytest.mark.parametrize("seed", [20, 21])
    def test_a_kidnapped_robot_reports_it_and_localises_again(self, seed: int) -> None:
        robot = Driven(seed)
        robot.drive(ROUND[:60])
        robot.true = Pose(1.5, 2.5, 2.0)
        found = robot.drive([Twist(0, 0.5)] * 250)
        assert any(estimate.lost for _, estimate in found[:60])
        off, estimate = found[-1]
        assert off < 0.15 and robot.heading_off(estimate) < 0.1
        assert estimate.settled and not estimate.lost

    @pytest.mark.slow
    @pytest.mark.parametrize("seed", [25, 26])
    def test_a_turn_missing_from_the_odometry_is_corrected(self, seed: int) -> None:
        robot = Driven(seed)
        robot.drive(ROUND[:60])
        robot.true = robot.true._replace(heading=wrap(robot.true.heading + 1.4))
        found = robot.drive([Twist(0, 0.5)] * 126)
        assert not any(estimate.found and off > 0.5 for off, estimate in found)
        off, estimate = found[-1]
        assert off < 0.15 and robot.heading_off(estimate) < 0.1 and estimate.found

    def test_a_wrong_pose_is_noticed_while_the_robot_stands(self) -> None:
        robot = Driven(23)
        robot.drive(ROUND[:60])
        robot.true = Pose(1.5, 2.5, 2.0)
        found = robot.drive([Twist(0, 0)] * 60)
        assert any(estimate.lost for _, estimate in found)

    @pytest.mark.parametrize(("over_rival", "moves"), [(-1.0, True), (0.3, False)])
    def test_particles_move_only_to_a_place_that_is_better_supported(
        self, over_rival: float, moves: bool
    ) -> None:
        robot, there = Driven(3, start=None), Pose(1.0, 5.0, 2.0)
        result = Comparison(-1.0, there, over_rival)
        with patch.object(RecentScans, "compare", return_value=result) as compare:
            while not compare.called:
                robot.drive([Twist(0.5, 0.0)])
        assert (near(robot.localisation.particles, there).mean() > 0.3) == moves

    def test_if_the_robot_hardly_moves_the_scans_of_one_place_may_do(self) -> None:
        robot, asked = Driven(3, start=None), []

        def compare(*_: object, fewest: int) -> Comparison:
            asked.append(fewest)
            return Comparison(-inf if fewest > 1 else 1.0)

        with patch.object(RecentScans, "compare", side_effect=compare):
            found = robot.drive([Twist(1.2, 0.0), Twist(-1.2, 0.0)] * 15)
        assert asked == [FEWEST_SCANS] * 3 + [1]
        assert found[-1][1].settled

    def test_staff_can_set_the_pose(self) -> None:
        robot = Driven(24, start=Pose(1, 1, 0))
        robot.localisation.place(START)
        off, _ = robot.drive(ROUND[:30])[-1]
        assert off < 0.05
