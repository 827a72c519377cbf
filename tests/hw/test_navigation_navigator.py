"""The navigator: drives to goals, localises the robot, and reports its state."""

from __future__ import annotations

from itertools import pairwise
from math import pi

import numpy as np
import pytest

from tangy_hw.device_protocols import STILL, Odometry, Pose, Twist
from tangy_hw.navigation.limits import MotionLimits
from tangy_hw.navigation.navigator import Navigator
from tests.hw.navigated import FRONT, MAP, ROOM, DrivenRobot, at_seat
from tests.hw.raycast import driven, look, room_sides


class TestGoing:
    @pytest.mark.slow
    def test_the_robot_drives_to_every_seat_and_back_to_the_front(self) -> None:
        robot = DrivenRobot()
        for goal in (at_seat(0), at_seat(3), FRONT):
            robot.navigator.go(goal)
            assert robot.arrives()
            metres, radians = robot.off(goal)
            assert metres < 0.1 and radians < 0.08
        assert {path for _, path in robot.seen} == {"clear"}
        assert {state for state, _ in robot.seen} == {"driving", "arrived"}
        assert not robot.touched

    def test_an_undisturbed_drive_reports_good_facts(self) -> None:
        robot = DrivenRobot(seed=5)
        robot.navigator.go(at_seat(2))
        worst = {"fit": 1.0, "spread": 0.0, "slip": 0.0, "still": 0.0}

        def note() -> bool:
            facts = robot.navigator.facts()
            worst["fit"] = min(worst["fit"], float(facts["fit"]))
            for name in ("spread", "slip", "still"):
                worst[name] = max(worst[name], float(facts[name]))
            return robot.navigator.state == "arrived"

        assert robot.run(60, note)
        assert worst["fit"] > 0.9 and worst["spread"] < 0.4
        assert worst["slip"] < 0.2 and worst["still"] < 0.5

    @pytest.mark.slow
    def test_a_new_goal_replaces_the_old_one(self) -> None:
        robot = DrivenRobot()
        robot.navigator.go(at_seat(0))
        robot.run(4)
        robot.navigator.go(at_seat(3))
        assert robot.arrives() and robot.off(at_seat(3))[0] < 0.1

    def test_a_cancelled_drive_stops_the_robot(self) -> None:
        robot = DrivenRobot()
        robot.navigator.go(at_seat(0))
        robot.run(4)
        assert robot.twist != STILL
        robot.navigator.cancel()
        robot.run(0.2)
        assert robot.twist == STILL and robot.navigator.state == "idle"
        assert robot.navigator.goal is None

    @pytest.mark.slow
    def test_the_robot_stops_while_it_has_no_scan(self) -> None:
        robot = DrivenRobot()
        robot.navigator.go(at_seat(0))
        robot.run(4)
        robot.blind = True
        robot.run(0.2)
        assert robot.twist == STILL
        robot.blind = False
        assert robot.arrives()

    @pytest.mark.parametrize("goal", [Pose(5, 5.4, 0), Pose(-3, 1, 0)])
    def test_an_unreachable_goal_fails_at_once(self, goal: Pose) -> None:
        robot = DrivenRobot()
        robot.navigator.go(goal)
        robot.run(1)
        assert robot.navigator.state == "failed" and robot.navigator.why.startswith("The goal")
        assert robot.twist == STILL

    def test_the_readings_match_the_facts_of_the_profile(self) -> None:
        robot = DrivenRobot()
        robot.run(0.5)
        localisation, navigator = robot.navigator.readings(0.25)
        assert localisation.device == "localisation" and set(localisation.facts) == {
            "fit",
            "spread",
        }
        assert navigator.device == "navigator" and navigator.facts == {"path": "clear"}
        assert navigator.age == 0.25

    def test_the_table_top_is_an_obstacle_although_the_laser_misses_it(self) -> None:
        robot = DrivenRobot()
        robot.run(0.3)
        ahead = robot.navigator.unseen
        middle = ahead[np.abs(ahead[:, 1]) < 0.1]
        assert len(ahead) == 0 or len(middle)
        robot.navigator.go(Pose(5.0, 4.3, pi / 2))
        assert robot.arrives()
        edge = robot.navigator.unseen
        nearest = edge[np.abs(edge[:, 1]) < 0.1]
        assert nearest[:, 0].min() == pytest.approx(0.7, abs=0.1)
        robot.navigator.place(None)
        robot.run(0.1)
        assert len(robot.navigator.unseen) == 0


class TestFaults:
    def test_blocked_wheels_are_measured_in_seconds(self) -> None:
        robot = DrivenRobot()
        robot.navigator.go(at_seat(0))
        robot.run(4)
        robot.stuck = True
        robot.run(3)
        assert 2.5 < float(robot.navigator.facts()["still"]) <= 3.2
        assert robot.navigator.facts()["path"] == "clear"
        robot.stuck = False
        robot.run(0.5)
        assert robot.navigator.facts()["still"] == 0.0

    def test_slipping_wheels_are_measured_in_metres(self) -> None:
        robot = DrivenRobot()
        robot.navigator.go(at_seat(0))
        robot.run(4)
        robot.grip = 0.0
        assert robot.run(5, lambda: float(robot.navigator.facts()["slip"]) > 0.3)
        assert robot.navigator.facts()["path"] == "clear"

    @pytest.mark.slow
    @pytest.mark.parametrize("seed", [1, 2])
    def test_a_kidnapped_robot_spins_localises_and_reaches_its_goal(self, seed: int) -> None:
        robot = DrivenRobot(seed=seed)
        robot.navigator.go(at_seat(0))
        robot.run(5)
        robot.true = Pose(8.5, 2.0, -2.0)
        assert robot.run(20, lambda: robot.navigator.state == "spinning")
        facts = robot.navigator.facts()
        assert float(facts["fit"]) < 0.85 and float(facts["spread"]) > 0.5
        assert robot.arrives(120) and robot.off(at_seat(0))[0] < 0.15

    @pytest.mark.slow
    def test_a_lost_robot_gives_up_after_two_spins(self) -> None:
        robot = DrivenRobot(seed=1)
        robot.navigator.go(at_seat(0))
        robot.run(5)
        hall = np.array([(16, 7, 0, 9), (0, 9, 6, -6), (6, -6, 16, 7)], float)
        robot.elsewhere, robot.true = hall, Pose(5, 2.5, 0)
        assert robot.run(20, lambda: robot.navigator.state == "spinning")
        turned = []

        def given_up() -> bool:
            turned.append(robot.twist.turn * 0.1)
            return robot.navigator.state == "failed"

        assert robot.run(60, given_up)
        assert sum(turned) == pytest.approx(4 * pi, abs=0.2)
        assert robot.navigator.why == "It does not find its place."
        estimate = robot.navigator.estimate
        assert estimate is not None and not estimate.found
        robot.run(1)
        assert robot.twist == STILL and robot.navigator.state == "failed"

    @pytest.mark.slow
    def test_a_spin_turns_once_and_stops(self) -> None:
        robot = DrivenRobot()
        robot.navigator.spin()
        turned = []

        def done() -> bool:
            turned.append(robot.twist.turn * 0.1)
            return robot.navigator.state == "idle"

        assert robot.run(30, done)
        assert sum(turned) == pytest.approx(2 * pi, abs=0.2)


class TestLateBase:
    """A base whose odometry and commands lag by .2 s."""

    def test_the_robot_accelerates_at_the_limit(self) -> None:
        told = commands_to_a_late_base(seconds=4.0)
        limits = MotionLimits()
        first = next(at for at, speed in enumerate(told) if speed > 0)
        fast = next(at for at, speed in enumerate(told) if speed > 0.9 * limits.max_speed)
        assert fast - first <= 1.2 * 0.9 * limits.max_speed / limits.acceleration / 0.1
        assert max(b - a for a, b in pairwise(told)) <= limits.acceleration * 0.1 + 1e-9

    def test_commands_to_a_blocked_base_stay_slow(self) -> None:
        limits = MotionLimits()
        told = commands_to_a_late_base(seconds=4.0, moves=False)
        assert 0 < max(told) <= limits.acceleration * (limits.latency + 0.1) + 1e-9

    def test_a_base_that_was_told_to_stop_starts_from_where_it_has_slowed_to(self) -> None:
        limits = MotionLimits(full_braking=1.0, latency=0.3)
        for told, measured, reached in ((0.0, 0.35, 0.05), (0.2, 0.35, 0.2), (0.0, 0.1, 0.0)):
            twist = limits.reached(Twist(told, 0.0), Twist(measured, 0.0))
            assert twist == pytest.approx(Twist(reached, 0.0))

    @pytest.mark.parametrize("side", [-1, 1])
    def test_a_turn_grows_as_far_as_the_base_can_have_come_since_it_was_measured(
        self, side: int
    ) -> None:
        limits = MotionLimits(turn_acceleration=2.0, latency=0.1)
        for told, measured, reached in ((0.9, 0.3, 0.5), (0.4, 0.3, 0.4), (0.1, 0.3, 0.3)):
            twist = limits.reached(Twist(0.0, side * told), Twist(0.0, side * measured))
            assert twist == pytest.approx(Twist(0.0, reached))


def commands_to_a_late_base(seconds: float, *, moves: bool = True) -> list[float]:
    """Drive along the room's front; return the forward speeds sent to the base."""
    start = Pose(2.0, 1.2, 0.0)
    navigator = Navigator(MAP, np.random.default_rng(1), start)
    navigator.go(Pose(8.0, 1.2, 0.0))
    twists, pose, wheels = [STILL, STILL], start, Pose(0.0, 0.0, 0.0)
    told = []
    for _ in range(round(seconds * 10)):
        scan = look(room_sides(ROOM), pose, np.random.default_rng(2), beams=240)
        twist = navigator.tick(Odometry(wheels, twists[0]), scan, 0.1)
        told.append(twist.forward)
        twists = [*twists[1:], twist if moves else STILL]
        pose, wheels = driven(pose, twists[0], 0.1), driven(wheels, twists[0], 0.1)
    return told
