"""The speed limit by the scan that every driver shares: slower near objects, then a stop."""

from __future__ import annotations

from dataclasses import replace
from math import atan2, cos, hypot, inf, pi, radians, sin

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tangy_hw.device_protocols import STILL, Pose, Twist
from tangy_hw.navigation.clearance import (
    REACH,
    free_ahead,
    limit_by_clearance,
    room_ahead,
    speed_in,
)
from tangy_hw.navigation.limits import MotionLimits
from tangy_hw.navigation.people_guard import NearbyPeople, limit_near_people
from tangy_hw.navigation.people_tracker import Track
from tangy_hw.navigation.poses import Floats, relative_pose
from tests.hw.raycast import driven

LIMITS = MotionLimits()
TORSO = 0.15  # metres that a body may extend beyond a return
CLOSE = LIMITS.radius + TORSO
NOBODY = NearbyPeople((), np.zeros((0, 2)))


def at(*points: tuple[float, float]) -> Floats:
    return np.array(points, dtype=float).reshape(-1, 2)


def by_hand(twist: Twist, *points: tuple[float, float]) -> Twist:
    return limit_by_clearance(twist, at(*points), NearbyPeople((), at(*points)), LIMITS)


def person(x: float, y: float, vx: float = 0.0, vy: float = 0.0, age: float = 3.0) -> Track:
    stood = 2.0 if vx == vy == 0 else 0.0
    return Track(x, y, vx, vy, 0.22, age, stood, True, False, hypot(vx, vy))


def past(twist: Twist, *people: Track) -> Twist:
    return limit_near_people(twist, NearbyPeople(people, np.zeros((0, 2))), LIMITS)


class TestRoom:
    def test_the_room_ahead_ends_at_the_nearest_scan_point(self) -> None:
        assert room_ahead(at((2.0, 0.0)), 0.0, LIMITS) == pytest.approx(
            2.0 - LIMITS.radius - LIMITS.clearance, abs=0.03
        )
        assert room_ahead(at((-0.6, 0.1)), 0.0, LIMITS) == inf

    @pytest.mark.parametrize("side", [1.0, -1.0])
    def test_the_way_on_an_arc_ends_at_a_point_on_it_and_not_beside_it(self, side: float) -> None:
        on = at((1.0, side), (2.0, 0.0), (-1.0, side))  # a quarter of a circle of 1 m is pi/2 long
        assert free_ahead(on, side, 0.3) == pytest.approx(pi / 2 - 0.3)
        assert free_ahead(on[1:], side, 0.3) == free_ahead(on[:1], -side, 0.3) == inf

    @pytest.mark.parametrize("room", [0.05, 0.4, REACH])
    def test_the_robot_can_stop_within_the_room_from_the_speed_for_it(self, room: float) -> None:
        way = speed_in(room, LIMITS) ** 2 / (2 * LIMITS.planned_braking)
        assert way == pytest.approx(room) and speed_in(-room, LIMITS) == 0.0
        assert speed_in(room + REACH, LIMITS) == speed_in(REACH, LIMITS)

    @given(st.floats(0.05, 0.25), st.floats(-pi, pi), st.floats(-2, 2))
    def test_a_touched_object_stops_only_driving_towards_it(
        self, far: float, bearing: float, curvature: float
    ) -> None:
        point = far * np.cos(bearing), far * np.sin(bearing)
        speed = speed_in(room_ahead(at(point), curvature, LIMITS), LIMITS)
        if point[0] < 0:
            assert speed > 0
        elif abs(bearing) < 0.5:
            assert speed == 0


class TestPeople:
    def test_a_command_is_unchanged_without_people(self) -> None:
        assert limit_near_people(Twist(0.5, 0.1), NOBODY, LIMITS) == Twist(0.5, 0.1)

    def test_the_robot_slows_down_and_stops_before_a_standing_person(self) -> None:
        speeds = [past(Twist(0.5, 0.0), person(x, 0.0)).forward for x in (2.5, 1.1, 0.9, 0.6)]
        assert speeds[0] == 0.5 and speeds == sorted(speeds, reverse=True)
        assert 0 < speeds[2] < 0.5 and speeds[3] == 0.0

    def test_the_robot_stops_for_approaching_people_and_follows_leaving_ones(self) -> None:
        assert past(Twist(0.5, 0.0), person(1.4, 0.0, -1.2)).forward <= 0.15
        assert past(Twist(0.5, 0.0), person(1.0, 0.0, -1.2)) == STILL
        assert past(Twist(0.5, 0.0), person(2.0, 0.0, 0.8)).forward == 0.5

    def test_the_robot_follows_a_person_close_ahead_slowly(self) -> None:
        away = past(Twist(0.5, 0.0), person(1.2, 0.0, 0.8)).forward
        assert 0 < away < past(Twist(0.5, 0.0), person(1.2, 0.0)).forward

    def test_the_robot_follows_a_recently_faster_walker_more_slowly(self) -> None:
        slow = person(1.2, 0.0, 0.4)
        paces = (0.4, 0.6, 0.8, 1.4)
        speeds = [past(Twist(0.5, 0.0), replace(slow, pace=pace)).forward for pace in paces]
        assert speeds == sorted(speeds, reverse=True) and speeds[0] > speeds[-1] > 0

    def test_a_walker_may_come_so_much_faster_than_it_walked(self) -> None:
        away = person(1.2, 0.0, 0.3)
        told = replace(LIMITS, approach_turned=0.3 + LIMITS.turned_faster, turned_faster=inf)
        near = NearbyPeople((away,), np.zeros((0, 2)))
        limited = [limit_near_people(Twist(0.5, 0.0), near, one) for one in (LIMITS, told)]
        assert limited[0] == limited[1]
        assert 0 < limited[0].forward < past(Twist(0.5, 0.0), replace(away, pace=0.0)).forward
        assert LIMITS.turned_faster >= 0.6  # with less, robots touched people who turned

    def test_the_robot_does_not_set_off_beside_a_walker_who_turns_round(self) -> None:
        turns = replace(person(0.24, -0.71, -0.17, -0.13), pace=1.18)  # slow, at the turn itself
        assert past(Twist(0.05, 0.0), turns) == STILL
        assert past(Twist(0.05, 0.0), replace(turns, pace=0.0)) != STILL

    def test_the_robot_stops_for_a_person_crossing_its_path(self) -> None:
        assert past(Twist(0.5, 0.0), person(0.6, 0.45, 0.0, -1.2)) == STILL

    def test_the_robot_drives_away_slowly_from_a_walker_who_would_reach_it(self) -> None:
        behind = person(-1.2, 0.2, 1.2)
        away = past(Twist(0.5, 0.2), behind)
        assert 0 < away.forward <= LIMITS.people_speed
        assert past(away, behind) == away
        assert past(Twist(0.5, 0.2), person(-1.2, 0.2, 0.3)) == Twist(0.5, 0.2)

    def test_the_robot_does_not_outrun_a_walker_who_comes_from_the_side(self) -> None:
        side = person(-0.1, 0.95, 0.2, -1.2)
        assert past(Twist(0.5, 0.0), side) == STILL
        assert past(Twist(0.25, 0.3), side) == STILL
        assert past(Twist(0.5, 0.0), replace(side, y=1.8, vy=1.2)) == Twist(0.5, 0.0)

    def test_the_robot_can_stop_before_a_walker_beside_it_who_turns_round(self) -> None:
        """It leaves room for them at any bearing up to 110 degrees, also where it drives away."""
        for bearing in (80.0, 95.0, 105.0):
            c, s = cos(radians(bearing)), sin(radians(bearing))
            for far in (0.95, 1.1, 1.25, 1.4):  # going away
                away = person(far * c, far * s, 1.2 * c, 1.2 * s)
                fast = past(Twist(0.5, 0.0), away).forward
                stops = LIMITS.latency + fast / LIMITS.full_braking
                meets = (far - LIMITS.radius - away.half) / LIMITS.approach_turned
                assert fast == 0.0 or stops < meets, (bearing, far)
        assert past(Twist(0.5, 0.0), person(0.0, 0.9, 0.0, 1.2)) == STILL
        assert past(Twist(0.5, 0.0), person(0.0, 1.6, 0.0, 1.2)).forward == 0.5

    def test_the_robot_drives_away_slowly_from_a_walker_who_may_turn_behind_it(self) -> None:
        behind = person(-0.8, 0.2, -1.2)
        assert 0 < past(Twist(0.5, 0.0), behind).forward <= LIMITS.people_speed
        assert past(Twist(0.5, 0.0), replace(behind, x=-1.7)).forward == 0.5

    def test_from_a_walker_who_stays_behind_it_the_robot_drives_on_slowly(self) -> None:
        slow = Twist(0.25, 0.0)
        assert past(slow, person(-0.3, 0.5, 0.0, -0.6)) == slow
        assert past(slow, person(0.3, 0.5, 0.0, -0.6)) == STILL
        assert past(Twist(0.25, 0.3), person(-0.7, 0.5, 0.8, -0.6)) == Twist(0.25, 0.3)
        back = Twist(-0.25, 0.0)
        assert past(back, person(0.3, 0.5, -0.6, -1.2)) == back
        assert past(back, person(-0.3, 0.5, 0.0, -0.6)) == STILL

    def test_the_robot_gives_up_speed_before_a_walker_gets_beside_it(self) -> None:
        assert past(Twist(0.5, 0.0), person(-0.7, 0.7, 1.2)).forward == pytest.approx(0.15)
        turns = past(Twist(0.25, 1.0), person(-0.7, 0.9, 1.2, -0.6))  # it turns towards them
        assert turns.forward == pytest.approx(0.1)

    def test_a_robot_with_corners_may_turn_away_from_a_walker_on_the_spot(self) -> None:
        corners = ((0.3, 0.25), (-0.3, 0.25), (-0.3, -0.25), (0.3, -0.25))
        limits = replace(LIMITS, corners=corners)
        spin = Twist(0.0, 0.5)
        around = NearbyPeople((person(-0.5, 0.6, 0.0, -0.3),), np.zeros((0, 2)))
        assert limit_near_people(spin, around, limits) == spin

    def test_the_robot_slows_down_while_a_walker_is_hidden_behind_it(self) -> None:
        behind = replace(person(-1.2, 0.2, 0.8), hidden=True)
        assert past(Twist(0.5, 0.2), behind) == Twist(
            LIMITS.people_speed, 0.2 * LIMITS.people_speed / 0.5
        )
        seen = past(Twist(0.5, 0.2), replace(behind, hidden=False))
        assert LIMITS.people_speed < seen.forward < 0.5  # it stops before they turn round and come
        assert past(Twist(0.5, 0.2), replace(behind, pace=0.0)) == Twist(0.5, 0.2)

    @pytest.mark.parametrize("forward", [-0.1, 0.05, 0.0])
    def test_a_walker_hidden_behind_the_robot_makes_no_slow_command_faster(
        self, forward: float
    ) -> None:
        behind = replace(person(-2.5, 0.2, 0.3), hidden=True)
        assert past(Twist(forward, 0.2), behind) == Twist(forward, 0.2)

    @pytest.mark.parametrize(("x", "y"), [(2.8, 0.2), (-3.1, 0.2)])
    def test_a_hidden_walker_ahead_or_far_away_does_not_slow_the_robot_down(
        self, x: float, y: float
    ) -> None:
        assert past(Twist(0.5, 0.2), replace(person(x, y, 0.4), hidden=True)) == Twist(0.5, 0.2)

    def test_a_round_robot_turns_on_the_spot_beside_a_walker(self) -> None:
        beside = person(0.0, 0.45, 0.0, -0.5)
        assert past(Twist(0.01, 1.0), beside) == Twist(0.01, 1.0)

    def test_the_robot_slows_down_more_for_a_new_track(self) -> None:
        known, new = (past(Twist(0.5, 0.0), person(1.2, 0.3, age=a)).forward for a in (3.0, 0.3))
        assert new < known

    def test_a_slower_command_keeps_its_arc(self) -> None:
        twist = past(Twist(0.5, 0.5), person(0.95, 0.3))
        assert 0 < twist.forward < 0.5 and twist.turn == pytest.approx(twist.forward)

    def test_the_robot_may_drive_away_from_a_close_person_and_turn(self) -> None:
        assert past(Twist(0.4, 0.0), person(-0.5, 0.1)).forward == 0.4
        assert past(Twist(-0.4, 0.0), person(0.5, 0.1)).forward == -0.4
        assert past(Twist(0.0, 1.0), person(0.5, 0.1)) == Twist(0.0, 1.0)

    @pytest.mark.slow
    @given(st.floats(0.3, 2.5), st.floats(-pi, pi), st.floats(-1.4, 1.4), st.floats(-1.4, 1.4))
    def test_a_drive_never_touches_a_person_with_constant_velocity(
        self, far: float, bearing: float, vx: float, vy: float
    ) -> None:
        """Commands come a tenth of a second late, and the base brakes at 1 m/s2."""
        x, y = far * np.cos(bearing), far * np.sin(bearing)
        pose, twist, late = Pose(0.0, 0.0, 0.0), STILL, STILL
        for _ in range(40):
            there = relative_pose(pose, Pose(x, y, 0.0))
            told = past(Twist(0.5, 0.0), person(there.x, there.y, vx, vy))
            change = float(np.clip(late.forward - twist.forward, -0.1, 0.08))
            twist, late = Twist(twist.forward + change, 0.0), told
            was = hypot(x - pose.x, y - pose.y)
            pose = driven(pose, twist, 0.1)
            x, y = x + vx * 0.1, y + vy * 0.1
            apart = hypot(x - pose.x, y - pose.y)
            ahead = there.x > 0  # driving on takes it away from people behind, who may run into it
            if ahead and twist.forward > 0.02 and apart < was and was > 0.47:
                assert apart > 0.47, (twist, there)


class TestByHand:
    def test_a_command_by_hand_is_unchanged_in_free_space(self) -> None:
        assert by_hand(Twist(0.3, -0.2)) == Twist(0.3, -0.2)

    def test_a_drive_by_hand_slows_down_near_objects_and_stops_close_to_them(self) -> None:
        speeds = [by_hand(Twist(0.5, 0.0), (x, 0.0)).forward for x in (2.5, 1.0, 0.8, 0.5)]
        assert speeds[0] == 0.5 and speeds[3] == 0.0
        assert speeds == sorted(speeds, reverse=True) and speeds[2] < 0.3

    def test_staff_can_turn_and_back_away_from_a_close_object(self) -> None:
        around = (0.35, 0.0), (0.3, 0.2)
        assert by_hand(Twist(0.3, 0.0), *around) == STILL
        assert by_hand(Twist(-0.3, 0.0), *around).forward == -LIMITS.unseen_speed
        turned = by_hand(Twist(0.0, 1.0), *around)
        assert turned == Twist(0.0, LIMITS.close_turn)
        assert by_hand(Twist(0.3, 1.0), *around) == turned
        assert by_hand(Twist(0.0, 1.0), (2.0, 0.0)) == Twist(0.0, 1.0)

    def test_a_drive_backwards_is_slow_and_stops_at_seen_objects(self) -> None:
        assert by_hand(Twist(-0.5, 0.0)) == Twist(-LIMITS.unseen_speed, 0.0)
        assert by_hand(Twist(-0.5, 0.0), (-0.45, 0.2)) == STILL

    @pytest.mark.slow
    @given(
        st.floats(-2, 2),
        st.floats(-2, 2),
        st.lists(st.tuples(st.floats(-2, 2), st.floats(-2, 2)), min_size=1, max_size=6),
    )
    def test_no_command_by_hand_touches_a_standing_person(
        self, forward: float, turn: float, points: list[tuple[float, float]]
    ) -> None:
        """Commands come a tenth of a second late, and the base brakes at 1 m/s2."""
        legs = [(x, y) for x, y in points if hypot(x, y) > CLOSE + 0.02]
        pose, twist, late = Pose(0.0, 0.0, 0.0), STILL, STILL
        for _ in range(60):
            there = [relative_pose(pose, Pose(x, y, 0.0))[:2] for x, y in legs]
            told = by_hand(Twist(forward, turn), *(p for p in there if hypot(*p) < REACH))
            change = float(np.clip(late.forward - twist.forward, -0.1, 0.1))
            twist, late = Twist(twist.forward + change, late.turn), told
            pose = driven(pose, twist, 0.1)
            for x, y in legs:
                assert hypot(x - pose.x, y - pose.y) > CLOSE - 0.03, atan2(y - pose.y, x - pose.x)
