"""The bench's floor, laser and wheels obey geometry and physics."""

from __future__ import annotations

from math import cos, hypot, inf, pi, radians, sin

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tangy_sim.device_simulator.drive import EXACT, RADIUS, SILENCE, Odometer, SimulatedWheels
from tangy_sim.device_simulator.floor import Floor, FloorPose
from tangy_sim.device_simulator.joints import FASTEST, Joints
from tangy_sim.device_simulator.lidar import Lidar, cast
from tests.sim.bench_game import ROBOT, ROOM

EMPTY = np.zeros((0, 3))
AHEAD = FloorPose(ROOM.front.x, ROOM.front.y, pi / 2)
angles = st.floats(-pi, pi)


def floor(seed: int = 1) -> Floor:
    return Floor(ROOM, 4, np.random.default_rng(seed))


def wheels(odometer: Odometer = EXACT, pose: FloorPose = AHEAD, seed: int = 2) -> SimulatedWheels:
    return SimulatedWheels(floor(), pose, np.random.default_rng(seed), odometer)


class TestRays:
    @settings(max_examples=30)
    @given(st.floats(0.1, 9.9), st.floats(0.1, 7.9), angles)
    def test_a_ray_in_an_empty_room_ends_at_the_wall(
        self, x: float, y: float, angle: float
    ) -> None:
        (far,) = cast(x, y, np.array([angle]), floor().walls, EMPTY)
        across = (
            ((10 - x) / cos(angle) if cos(angle) > 0 else -x / cos(angle)) if cos(angle) else inf
        )
        along = ((8 - y) / sin(angle) if sin(angle) > 0 else -y / sin(angle)) if sin(angle) else inf
        assert far == pytest.approx(min(across, along), abs=1e-9)

    @settings(max_examples=30)
    @given(angles, st.floats(0.5, 4), st.floats(0.02, 0.3), st.floats(-1.2, 1.2))
    def test_a_ray_hits_a_circle_only_on_its_line(
        self, way: float, far: float, radius: float, aside: float
    ) -> None:
        # `aside` is the distance of the ray from its middle, in its radii.
        x, y = (
            far * cos(way) - aside * radius * sin(way),
            far * sin(way) + aside * radius * cos(way),
        )
        (met,) = cast(0, 0, np.array([way]), np.zeros((0, 4)), np.array([[x, y, radius]]))
        if abs(aside) < 0.999:
            assert met == pytest.approx(far - radius * (1 - aside**2) ** 0.5, abs=1e-9)
        elif abs(aside) > 1.001:
            assert met == inf

    def test_the_laser_sees_legs_but_no_table_top(self) -> None:
        seen = Lidar(noise=0.0).scan(FloorPose(4.6, 4.0, pi / 2), floor(), np.random.default_rng(1))
        ahead = seen[150:211]  # 45 degrees to each side
        assert 1.5 < ahead.min() < 2.6  # people's legs, beyond the edge 1 m away
        assert (ahead > 2.6).any()  # and the wall between them

    def test_each_scan_has_its_own_noise_of_a_centimetre(self) -> None:
        lidar, random, room = Lidar(), np.random.default_rng(3), floor()
        scans = np.array([lidar.scan(AHEAD, room, random) for _ in range(50)])
        assert np.median(scans.std(0)) == pytest.approx(0.01, rel=0.2)

    def test_people_move_their_legs_now_and_then(self) -> None:
        room = floor()
        before = room.circles.copy()
        room.step(0.0)
        assert np.array_equal(room.circles, before)
        for _ in range(100):
            room.step(0.1)
        moved = np.hypot(*(room.circles - before)[:, :2].T)
        assert 0 < (moved > 0).sum() <= 8 and moved.max() < 0.3

    def test_most_beams_end_at_a_cloth_over_the_laser(self) -> None:
        seen = Lidar().covered(AHEAD, floor(), np.random.default_rng(4))
        assert (seen < 0.15).mean() > 0.6


class TestWheels:
    @settings(max_examples=30)
    @given(st.lists(st.tuples(st.floats(-1, 1), st.floats(-2, 2)), min_size=1, max_size=8))
    def test_noiseless_odometry_equals_the_true_pose(
        self, commands: list[tuple[float, float]]
    ) -> None:
        one = wheels()
        now = 0.0
        for forward, turn in commands:
            one.drive(forward, turn, now)
            for _ in range(6):
                now += 0.05
                one.step(now, 0.05)
        start, seen = AHEAD, one.odometry
        x = start.x + seen.x * cos(start.heading) - seen.y * sin(start.heading)
        y = start.y + seen.x * sin(start.heading) + seen.y * cos(start.heading)
        assert (one.pose.x, one.pose.y) == pytest.approx((x, y), abs=1e-9)
        off = one.pose.heading - start.heading - seen.heading
        assert abs((off + pi) % (2 * pi) - pi) < 1e-9

    @given(st.floats(0.05, 0.5), st.floats(-1, 1))
    def test_the_base_stops_half_a_second_after_the_last_command(
        self, forward: float, turn: float
    ) -> None:
        one = wheels()
        one.drive(forward, turn, 0.0)
        now = 0.0
        while now < SILENCE - 1e-9:
            now += 0.05
            one.step(now, 0.05)
        assert one.forward > 0
        for _ in range(10):  # it reaches .5 m/s after .31 s
            now += 0.05
            one.step(now, 0.05)
        there = one.pose
        one.step(now + 1, 1.0)
        assert one.forward == one.turn == 0.0 and one.pose == there

    def test_the_base_keeps_its_limits_of_speed_and_acceleration(self) -> None:
        one = wheels()
        one.drive(5.0, 9.0, 0.0)
        speeds = []
        for tick in range(1, 9):
            one.step(tick * 0.05, 0.05)
            speeds.append((one.forward, one.turn))
        assert speeds[0] == pytest.approx((0.04, 0.2))
        one.drive(5.0, 9.0, 0.4)
        for tick in range(9, 60):
            one.drive(5.0, 9.0, tick * 0.05)
            one.step(tick * 0.05, 0.05)
        assert (one.forward, one.turn) == pytest.approx((1.0, 2.0))

    @pytest.mark.slow
    @settings(max_examples=30)
    @given(angles, st.integers(0, 99))
    def test_the_base_never_enters_walls_the_table_or_legs(self, heading: float, seed: int) -> None:
        one = wheels(Odometer(), AHEAD._replace(heading=heading), seed)
        for tick in range(1, 200):
            one.drive(1.0, 0.0, tick * 0.05)
            one.step(tick * 0.05, 0.05)
            assert one.floor.clear(one.pose.x, one.pose.y, RADIUS - 1e-9)
        assert one.forward == 0.0 and one.bumped
        for tick in range(200, 240):  # and out again backwards
            one.drive(-0.3, 0.0, tick * 0.05)
            one.step(tick * 0.05, 0.05)
        assert one.forward < 0

    def test_stuck_wheels_count_nothing_and_slipping_wheels_count_motion(self) -> None:
        stuck, slips = wheels(), wheels()
        for tick in range(1, 41):
            for one in (stuck, slips):
                one.drive(0.5, 0.0, tick * 0.05)
            stuck.step(tick * 0.05, 0.05, stuck=True)
            slips.step(tick * 0.05, 0.05, grip=0.0)
        assert stuck.pose == AHEAD and stuck.odometry == FloorPose(0, 0, 0)
        assert slips.pose == AHEAD and slips.odometry.x > 0.6

    def test_odometry_errors_are_small_and_vary_by_seed(self) -> None:
        wrong = []
        for seed in range(12):
            one = wheels(Odometer(), FloorPose(1.0, 2.5, 0.0), seed)
            for tick in range(1, 161):
                one.drive(0.5, 0.0, tick * 0.05)
                one.step(tick * 0.05, 0.05)
            wrong.append(hypot(one.odometry.x - (one.pose.x - 1.0), one.odometry.y))
        assert len(set(wrong)) == 12 and 0.002 < float(np.median(wrong)) < 0.2


class TestJoints:
    @given(st.floats(-35, 30), st.floats(0.0, 3.0))
    def test_a_joint_reaches_its_goal_in_the_given_or_minimum_time(
        self, degrees: float, seconds: float
    ) -> None:
        joints = Joints(ROBOT)
        joints.move(["head/neck nod", "no such joint"], [radians(degrees), 1.0], seconds)
        takes = max(seconds, abs(radians(degrees)) / FASTEST)
        joints.step(takes * 0.5)
        assert abs(joints.angle("head/neck nod")) <= abs(degrees) * 0.5 + 1e-6
        joints.step(takes * 0.5 + 1e-3)
        assert joints.angle("head/neck nod") == pytest.approx(degrees)

    def test_joints_stop_at_their_limits_and_broken_limbs_stay(self) -> None:
        joints = Joints(ROBOT)
        joints.move(["head/neck nod", "left_arm/elbow"], [-3.0, 1.0], 0.5)
        joints.step(5.0, broken=("left_arm",))
        assert joints.angle("head/neck nod") == pytest.approx(-35)
        assert joints.angle("left_arm/elbow") == 0
