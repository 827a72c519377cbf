"""The robot keeps its distance from people who stand beside it, and from those who appear there."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import atan2, cos, hypot, inf, pi, radians, sin

import numpy as np
import pytest

from tangy_hw.device_protocols import STILL, Twist
from tangy_hw.navigation.limits import MotionLimits
from tangy_hw.navigation.people_guard import NearbyPeople, limit_near_people
from tangy_hw.navigation.people_tracker import Track
from tests.bench.people_arriving import LIMITS, meeting
from tests.bench.people_drives import drives
from tests.bench.people_passing import carry_out

TORSO, TICK, LEAST = 0.22, 0.1, 0.2  # m, s, m: the last between robot and torso
NO_ENDS = np.zeros((0, 2))


def body(gap: float, bearing: float, *, age: float = 5.0, pace: float = 0.0) -> Track:
    far = gap + MotionLimits().radius + TORSO
    x, y = far * cos(bearing), far * sin(bearing)
    stood = 0.0 if pace else age
    return Track(x, y, 0.0, 0.0, TORSO, age, stood, person=True, hidden=False, pace=pace)


def closest(
    seen: Callable[[float, float], NearbyPeople], gap: float, off: float, arc: float
) -> float:
    """Tell the robot to drive 6 s past a point `gap` m off its edge; return how near it comes.

    `seen` returns what it sees there, given the gap and the bearing (rad) at the time.
    """
    limits = MotionLimits()
    far = gap + limits.radius
    x, y = far * cos(off), far * sin(off)
    smallest = inf
    for _ in range(60):
        told = limit_near_people(
            Twist(0.12, 0.12 * arc), seen(hypot(x, y) - limits.radius, atan2(y, x)), limits
        )
        x -= told.forward * TICK
        turn = -told.turn * TICK
        x, y = x * cos(turn) - y * sin(turn), x * sin(turn) + y * cos(turn)
        smallest = min(smallest, hypot(x, y) - limits.radius)
    return smallest


@pytest.mark.parametrize("errs", [0.0, 0.02])
@pytest.mark.parametrize("bearing", [30, 60, 75, 82, 86, 89])
@pytest.mark.parametrize("curvature", [0.0, 0.6, 1.5])
def test_the_robot_does_not_creep_up_to_a_person_who_stands(
    bearing: float, curvature: float, errs: float
) -> None:
    def seen(gap: float, off: float) -> NearbyPeople:
        return NearbyPeople([body(gap - TORSO + errs, off)], NO_ENDS)

    assert closest(seen, 0.25 + TORSO, radians(bearing), curvature) - TORSO >= LEAST


@pytest.mark.parametrize("bearing", [30, 60])
def test_the_robot_comes_as_near_as_the_error_of_a_track_allows(bearing: float) -> None:
    def seen(gap: float, off: float) -> NearbyPeople:
        return NearbyPeople([body(gap - TORSO, off)], NO_ENDS)

    left = closest(seen, 0.25 + TORSO, radians(bearing), 0.0) - TORSO
    assert 0.22 <= left < 0.225


@pytest.mark.parametrize("bearing", [30, 60])
def test_the_robot_does_not_creep_up_to_a_return_without_a_track(bearing: float) -> None:
    def seen(gap: float, off: float) -> NearbyPeople:
        far = gap + MotionLimits().radius
        return NearbyPeople([], np.array([(far * cos(off), far * sin(off))]))

    left = closest(seen, 0.23, radians(bearing), 0.0)
    assert LEAST <= left < LEAST + 0.005


@pytest.mark.parametrize("half", [0.2, 0.3])
def test_the_robot_comes_nearer_to_what_may_be_one_leg_or_a_chair(half: float) -> None:
    """Such a track tells less exactly where the body ends, often too near."""

    def seen(gap: float, off: float) -> NearbyPeople:
        return NearbyPeople([replace(body(gap - TORSO, off), half=half)], NO_ENDS)

    assert closest(seen, 0.21 + half, radians(30), 0.0) - half < 0.205


def test_the_robot_may_pass_a_person_who_stands_farther_away_on_the_same_way() -> None:
    limits = MotionLimits()
    around = NearbyPeople([body(0.3, pi / 2 - 0.02)], NO_ENDS)
    assert limit_near_people(Twist(0.25, 0.0), around, limits).forward > 0.1


def test_the_robot_drives_away_from_a_walker_behind_it_but_not_from_one_who_has_just_appeared() -> (
    None
):
    limits = MotionLimits()
    away = Twist(0.2, 0.0)
    known = body(0.35, radians(150), pace=1.2)
    assert limit_near_people(away, NearbyPeople([known], NO_ENDS), limits) == away
    for age, told in ((0.05, STILL), (0.45, STILL), (0.55, away)):  # s
        new = body(0.35, radians(150), age=age, pace=1.2)
        assert limit_near_people(away, NearbyPeople([new], NO_ENDS), limits) == told


def test_the_robot_stands_before_a_walker_who_comes_out_of_the_blind_sector() -> None:
    drive, curvature = meeting(162, 91)
    carry_out(drive, curvature, limits=LIMITS)
    assert "ahead" not in [touch.kind for touch in drive.touches]


@pytest.mark.slow
def test_the_robot_reaches_a_goal_beside_a_person_who_stands() -> None:
    (drive,) = drives("beside", 1, 411301, 8)
    assert drive.arrived and drive.driven_to >= LEAST
