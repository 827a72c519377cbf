"""The count-down to the next call: it goes on where staff held it."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as some

from tangy_hw.robot_client.count_down import CountDown

SECONDS = some.floats(0.0, 100.0)


class Clock:
    """A clock that only the test advances."""

    def __init__(self) -> None:
        self.now = 0.0

    def __call__(self) -> float:
        return self.now


@given(SECONDS, SECONDS, SECONDS, SECONDS)
def test_a_hold_costs_no_time(whole: float, before: float, held: float, after: float) -> None:
    clock = Clock()
    counted = CountDown(clock)
    counted.begin(whole)
    clock.now += before
    left = counted.seconds
    counted.hold(held=True)
    clock.now += held
    assert counted.seconds == pytest.approx(left)
    counted.hold(held=False)
    clock.now += after
    assert counted.seconds == pytest.approx(max(0.0, whole - before - after), abs=1e-9)


@given(SECONDS, SECONDS, SECONDS)
def test_a_count_down_that_begins_while_held_is_whole(
    whole: float, held_before: float, held_after: float
) -> None:
    clock = Clock()
    counted = CountDown(clock)
    counted.hold(held=True)
    clock.now += held_before
    counted.begin(whole)
    clock.now += held_after
    counted.hold(held=False)
    assert counted.seconds == pytest.approx(whole)
    counted.lengthen(-whole)
    assert counted.seconds == pytest.approx(0.0)


def test_holding_again_and_letting_go_again_change_nothing() -> None:
    clock = Clock()
    counted = CountDown(clock)
    counted.begin(10.0)
    counted.hold(held=False)
    clock.now = 2.0
    assert counted.seconds == 8.0
    counted.hold(held=True)
    clock.now = 3.0
    counted.hold(held=True)
    clock.now = 4.0
    counted.hold(held=False)
    counted.hold(held=False)
    assert counted.seconds == 8.0
    clock.now = 5.0
    assert counted.seconds == 7.0
