"""The look at the scanner that all who drive share: slower before what is near, then standing."""

from __future__ import annotations

from math import atan2, cos, hypot, inf, pi, sin

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tangy_hw.device_protocols import STILL, Pose, Twist
from tangy_hw.navigation.clearance import REACH, Seen, guarded, room_ahead, speed_in
from tangy_hw.navigation.limits import MotionLimits
from tangy_hw.navigation.poses import between
from tests.hw.raycast import driven

LIMITS = MotionLimits()
CLOSE = (
    LIMITS.radius + LIMITS.torso
)  # metres from the robot's middle to legs whose torso it touches


def seen(*points: tuple[float, float], bodies: bool = True) -> Seen:
    return Seen(np.array(points, dtype=float).reshape(-1, 2), np.full(len(points), bodies))


class TestRoom:
    def test_room_before_somebody_ends_at_the_torso_and_before_a_wall_at_the_wall(self) -> None:
        body = room_ahead(seen((2.0, 0.0)), 0.0, LIMITS)
        wall = room_ahead(seen((2.0, 0.0), bodies=False), 0.0, LIMITS)
        assert wall.free - body.free == pytest.approx(LIMITS.torso)
        assert body.free == pytest.approx(2.0 - CLOSE - LIMITS.gap, abs=0.03)
        assert wall.body == inf

    @pytest.mark.parametrize("bearing", [0.0, 0.7, -0.7])
    def test_within_a_metre_before_somebody_it_drives_slowly(self, bearing: float) -> None:
        for far, careful in ((0.99 + CLOSE, True), (1.2 + CLOSE, False)):
            room = room_ahead(seen((far * cos(bearing), far * sin(bearing))), 0.0, LIMITS)
            assert (speed_in(room, LIMITS) <= LIMITS.careful) is careful

    def test_somebody_behind_is_not_before_it(self) -> None:
        room = room_ahead(seen((-0.6, 0.1)), 0.0, LIMITS)
        assert speed_in(room, LIMITS) > LIMITS.speed

    @given(st.floats(0.05, 0.5), st.floats(-pi, pi), st.floats(-2, 2))
    def test_what_it_touches_already_holds_it_only_where_driving_brings_it_nearer(
        self, far: float, bearing: float, curvature: float
    ) -> None:
        point = far * cos(bearing), far * sin(bearing)
        speed = speed_in(room_ahead(seen(point), curvature, LIMITS), LIMITS)
        if point[0] < 0:
            assert speed > 0
        elif abs(bearing) < 0.5:
            assert speed == 0


class TestGuarded:
    def test_with_nothing_around_it_drives_as_it_is_told(self) -> None:
        assert guarded(Twist(0.3, -0.2), seen(), LIMITS) == Twist(0.3, -0.2)

    def test_it_drives_slowly_before_what_is_near_and_stands_before_what_is_close(self) -> None:
        speeds = [guarded(Twist(0.5, 0.0), seen((x, 0.0)), LIMITS).forward
                  for x in (2.5, 1.3, 0.8, 0.5)]  # fmt: skip
        assert speeds == [0.5, LIMITS.careful, LIMITS.careful, 0.0]

    def test_it_keeps_to_the_arc_when_it_is_slower(self) -> None:
        twist = guarded(Twist(0.5, 0.5), seen((1.2, 0.3)), LIMITS)
        assert 0 < twist.forward < 0.5 and twist.turn == pytest.approx(twist.forward)

    def test_from_what_is_close_it_can_be_turned_away_and_driven_back(self) -> None:
        around = seen((0.35, 0.0), (0.3, 0.2))
        assert guarded(Twist(0.3, 0.0), around, LIMITS) == STILL
        assert guarded(Twist(-0.3, 0.0), around, LIMITS).forward == -LIMITS.unseen
        turned = guarded(Twist(0.0, 1.0), around, LIMITS)
        assert turned == Twist(0.0, LIMITS.turn_close)
        assert guarded(Twist(0.3, 1.0), around, LIMITS) == turned

    def test_where_it_does_not_see_it_drives_slowly_and_up_to_nothing_that_it_sees(self) -> None:
        assert guarded(Twist(-0.5, 0.0), seen(), LIMITS) == Twist(-LIMITS.unseen, 0.0)
        assert guarded(Twist(-0.5, 0.0), seen((-0.45, 0.2)), LIMITS) == STILL

    @given(
        st.floats(-2, 2),
        st.floats(-2, 2),
        st.lists(st.tuples(st.floats(-2, 2), st.floats(-2, 2)), min_size=1, max_size=6),
    )
    def test_however_it_is_driven_it_touches_nobody_who_stands(
        self, forward: float, turn: float, at: list[tuple[float, float]]
    ) -> None:
        """Commands come a tenth of a second late, and the base brakes at 1 m/s2."""
        legs = [(x, y) for x, y in at if hypot(x, y) > CLOSE + 0.02]
        pose, twist, late = Pose(0.0, 0.0, 0.0), STILL, STILL
        for _ in range(60):
            there = [between(pose, Pose(x, y, 0.0))[:2] for x, y in legs]
            points = [p for p in there if hypot(*p) < REACH]
            told = guarded(Twist(forward, turn), seen(*points), LIMITS)
            change = float(np.clip(late.forward - twist.forward, -0.1, 0.1))
            twist, late = Twist(twist.forward + change, late.turn), told
            pose = driven(pose, twist, 0.1)
            for x, y in legs:
                assert hypot(x - pose.x, y - pose.y) > LIMITS.radius + LIMITS.torso - 0.03, atan2(
                    y - pose.y, x - pose.x
                )
