"""The robot keeps its distance from people who stand beside it, and from those who appear there."""

from __future__ import annotations

from math import atan2, cos, hypot, pi, radians, sin

import numpy as np
import pytest

from tangy_hw.device_protocols import STILL, Twist
from tangy_hw.navigation.limits import MotionLimits
from tangy_hw.navigation.people_guard import FRESH, NearbyPeople, limit_near_people
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


@pytest.mark.parametrize("bearing", [30, 60, 75, 82, 86, 89])
@pytest.mark.parametrize("curvature", [0.0, 0.6, 1.5])
def test_the_robot_does_not_creep_up_to_a_person_who_stands(
    bearing: float, curvature: float
) -> None:
    limits = MotionLimits()
    person = body(0.23, radians(bearing))
    x, y = person.x, person.y
    smallest = 1.0
    for _ in range(60):
        off, far = atan2(y, x), hypot(x, y)
        seen = body(far - limits.radius - TORSO, off)
        told = limit_near_people(
            Twist(0.12, 0.12 * curvature), NearbyPeople([seen], NO_ENDS), limits
        )
        x -= told.forward * TICK
        turn = -told.turn * TICK
        x, y = x * cos(turn) - y * sin(turn), x * sin(turn) + y * cos(turn)
        smallest = min(smallest, hypot(x, y) - limits.radius - TORSO)
    assert smallest >= LEAST


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
    new = body(0.35, radians(150), age=FRESH / 2, pace=1.2)
    assert limit_near_people(away, NearbyPeople([new], NO_ENDS), limits) == STILL


def test_the_robot_stands_before_a_walker_who_comes_out_of_the_blind_sector() -> None:
    drive, curvature = meeting(162, 91)
    carry_out(drive, curvature, limits=LIMITS)
    assert "ahead" not in [touch.kind for touch in drive.touches]


@pytest.mark.slow
def test_the_robot_reaches_a_goal_beside_a_person_who_stands() -> None:
    (drive,) = drives("beside", 1, 411301, 8)
    assert drive.arrived and drive.driven_to >= LEAST
