"""The look at the scanner that all who drive share: slower before what is near, then standing."""

from __future__ import annotations

from dataclasses import replace
from math import atan2, hypot, inf, pi

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tangy_hw.device_protocols import STILL, Pose, Twist
from tangy_hw.navigation.clearance import REACH, limit_by_clearance, room_ahead, speed_in
from tangy_hw.navigation.limits import MotionLimits
from tangy_hw.navigation.people_guard import NearbyPeople, limit_near_people
from tangy_hw.navigation.people_tracker import Track
from tangy_hw.navigation.poses import Floats, relative_pose
from tests.hw.raycast import driven

LIMITS = MotionLimits()
TORSO = 0.15  # metres that a body may reach out beyond a return
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
    def test_room_ends_at_what_is_seen(self) -> None:
        assert room_ahead(at((2.0, 0.0)), 0.0, LIMITS) == pytest.approx(
            2.0 - LIMITS.radius - LIMITS.clearance, abs=0.03
        )
        assert room_ahead(at((-0.6, 0.1)), 0.0, LIMITS) == inf

    @given(st.floats(0.05, 0.25), st.floats(-pi, pi), st.floats(-2, 2))
    def test_what_it_touches_already_holds_it_only_where_driving_brings_it_nearer(
        self, far: float, bearing: float, curvature: float
    ) -> None:
        point = far * np.cos(bearing), far * np.sin(bearing)
        speed = speed_in(room_ahead(at(point), curvature, LIMITS), LIMITS)
        if point[0] < 0:
            assert speed > 0
        elif abs(bearing) < 0.5:
            assert speed == 0


class TestPeople:
    def test_with_nobody_around_it_drives_as_it_is_told(self) -> None:
        assert limit_near_people(Twist(0.5, 0.1), NOBODY, LIMITS) == Twist(0.5, 0.1)

    def test_it_slows_down_before_somebody_who_stands_and_stops_short_of_them(self) -> None:
        speeds = [past(Twist(0.5, 0.0), person(x, 0.0)).forward for x in (2.5, 1.1, 0.9, 0.6)]
        assert speeds[0] == 0.5 and speeds == sorted(speeds, reverse=True)
        assert 0 < speeds[2] < 0.5 and speeds[3] == 0.0

    def test_it_stands_before_who_comes_and_drives_behind_who_goes(self) -> None:
        assert past(Twist(0.5, 0.0), person(1.4, 0.0, -1.2)).forward <= 0.15
        assert past(Twist(0.5, 0.0), person(1.0, 0.0, -1.2)) == STILL
        assert past(Twist(0.5, 0.0), person(2.0, 0.0, 0.8)).forward == 0.5

    def test_who_walks_away_close_by_may_turn_back_and_is_followed_slowly(self) -> None:
        away = past(Twist(0.5, 0.0), person(1.2, 0.0, 0.8)).forward
        assert 0 < away < past(Twist(0.5, 0.0), person(1.2, 0.0)).forward

    def test_who_walked_faster_lately_is_followed_more_slowly(self) -> None:
        slow = person(1.2, 0.0, 0.4)
        paces = (0.4, 0.6, 0.8, 1.4)
        speeds = [past(Twist(0.5, 0.0), replace(slow, pace=pace)).forward for pace in paces]
        assert speeds == sorted(speeds, reverse=True) and speeds[0] > speeds[-1] > 0

    def test_it_stands_for_who_crosses_its_way(self) -> None:
        assert past(Twist(0.5, 0.0), person(0.6, 0.45, 0.0, -1.2)) == STILL

    def test_it_is_slower_while_somebody_who_walked_is_out_of_sight_behind_it(self) -> None:
        behind = replace(person(-1.2, 0.2, 0.8), hidden=True)
        assert past(Twist(0.5, 0.2), behind) == Twist(
            LIMITS.people_speed, 0.2 * LIMITS.people_speed / 0.5
        )
        assert past(Twist(0.5, 0.2), replace(behind, hidden=False)) == Twist(0.5, 0.2)
        assert past(Twist(0.5, 0.2), replace(behind, pace=0.0)) == Twist(0.5, 0.2)

    def test_who_has_just_appeared_is_kept_further_off(self) -> None:
        known, new = (past(Twist(0.5, 0.0), person(1.2, 0.3, age=a)).forward for a in (3.0, 0.3))
        assert new < known

    def test_it_keeps_to_the_arc_when_it_is_slower(self) -> None:
        twist = past(Twist(0.5, 0.5), person(0.95, 0.3))
        assert 0 < twist.forward < 0.5 and twist.turn == pytest.approx(twist.forward)

    def test_from_who_stands_close_it_may_drive_away_and_turn(self) -> None:
        assert past(Twist(0.4, 0.0), person(-0.5, 0.1)).forward == 0.4
        assert past(Twist(-0.4, 0.0), person(0.5, 0.1)).forward == -0.4
        assert past(Twist(0.0, 1.0), person(0.5, 0.1)) == Twist(0.0, 1.0)

    @pytest.mark.slow
    @given(st.floats(0.3, 2.5), st.floats(-pi, pi), st.floats(-1.4, 1.4), st.floats(-1.4, 1.4))
    def test_driving_it_never_touches_who_goes_on_as_they_do(
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
            ahead = there.x > 0  # driving on takes it away from those behind, who may run into it
            if ahead and twist.forward > 0.02 and apart < was and was > 0.47:
                assert apart > 0.47, (twist, there)


class TestByHand:
    def test_with_nothing_around_it_drives_as_it_is_told(self) -> None:
        assert by_hand(Twist(0.3, -0.2)) == Twist(0.3, -0.2)

    def test_it_drives_slowly_before_what_is_near_and_stands_before_what_is_close(self) -> None:
        speeds = [by_hand(Twist(0.5, 0.0), (x, 0.0)).forward for x in (2.5, 1.0, 0.8, 0.5)]
        assert speeds[0] == 0.5 and speeds[3] == 0.0
        assert speeds == sorted(speeds, reverse=True) and speeds[2] < 0.3

    def test_from_what_is_close_it_can_be_turned_away_and_driven_back(self) -> None:
        around = (0.35, 0.0), (0.3, 0.2)
        assert by_hand(Twist(0.3, 0.0), *around) == STILL
        assert by_hand(Twist(-0.3, 0.0), *around).forward == -LIMITS.unseen_speed
        turned = by_hand(Twist(0.0, 1.0), *around)
        assert turned == Twist(0.0, LIMITS.close_turn)
        assert by_hand(Twist(0.3, 1.0), *around) == turned

    def test_where_it_does_not_see_it_drives_slowly_and_up_to_nothing_that_it_sees(self) -> None:
        assert by_hand(Twist(-0.5, 0.0)) == Twist(-LIMITS.unseen_speed, 0.0)
        assert by_hand(Twist(-0.5, 0.0), (-0.45, 0.2)) == STILL

    @pytest.mark.slow
    @given(
        st.floats(-2, 2),
        st.floats(-2, 2),
        st.lists(st.tuples(st.floats(-2, 2), st.floats(-2, 2)), min_size=1, max_size=6),
    )
    def test_however_it_is_driven_it_touches_nobody_who_stands(
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
