"""A walker who has passed the robot turns back beside it."""

from __future__ import annotations

from math import radians

import numpy as np
import pytest

from tests.bench.people_passing import START, carry_out
from tests.bench.people_simulation import TICK, Drive, Person

PACE, AWAY, BACK = 1.27, radians(-143), radians(50)  # m/s; headings of the walker
SECONDS, TURNS, RESTS = 3.0, 1.6, 1.7  # until the end; until the walker stops; and comes back


def walks(person: Person, drive: Drive) -> None:
    if drive.time < TURNS - TICK / 2:
        person.walk(AWAY, PACE)
    elif drive.time > RESTS - TICK / 2:
        person.walk(BACK, PACE)


@pytest.mark.parametrize("seed", [0, 1, 2, 3])
def test_the_robot_stands_before_a_walker_who_turns_back_beside_it(seed: int) -> None:
    person = Person(START.x + 1.11, START.y - 0.08, AWAY, walks, 0.3)
    drive = Drive(START, START, [person], np.random.default_rng(seed))
    carry_out(drive, seconds=SECONDS)
    assert [touch.kind for touch in drive.touches] == ["stood"]
