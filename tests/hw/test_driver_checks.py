"""A robot does not drive by data that make no sense, and its odometry may begin anew."""

from __future__ import annotations

import asyncio
import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from tangy_hw.device_protocols import DeviceError, Odometry, Pose, Scan, Stamped, Twist
from tangy_hw.navigation.poses import endpoints
from tangy_hw.robot_process.driver_checks import (
    CheckedData,
    restart_device,
    safe_reading,
    start_device,
)
from tangy_profiles.health import ERROR, OK, STALE, Reading
from tests.hw.live_bodies import ToldBody, ToldDevice


class Checked:
    """The checked data of a body, at a time that the test sets."""

    def __init__(self, reach: float = math.inf) -> None:
        self.now = 1.0
        self.parts = ToldBody()
        self.laser, self.base = self.parts.laser, self.parts.base
        self.laser.scan = replace(self.laser.sent, stamp=1.0)
        self.base.odometry = at(2.0, 1.0, 0.0, 1.0)
        self.data = CheckedData(self.parts.body(), lambda: self.now, reach)

    def states(self) -> tuple[str, str]:
        return self.data.report(self.laser).state, self.data.report(self.base).state


def at(x: float, y: float, heading: float, stamp: float) -> Stamped[Odometry]:
    return Stamped(Odometry(Pose(x, y, heading), Twist(0.3, 0.0)), stamp, int(stamp * 10))


def test_bad_data_are_an_error_until_they_make_sense_again(
    caplog: pytest.LogCaptureFixture,
) -> None:
    checked = Checked()
    parts, data = checked.parts, checked.data
    good, moved = data.scan, data.odometry
    assert data.report(parts.laser).state == data.report(parts.base).state == OK
    scan = parts.laser.scan.value
    parts.laser.scan = Stamped(replace(scan, ranges=np.full(31, math.nan)), 1.0, 2)
    parts.base.odometry = at(math.nan, 0.0, 0.0, 1.0)
    assert (data.scan, data.odometry) == (good, moved)  # the last ones that made sense
    assert data.report(parts.laser).state == data.report(parts.base).state == ERROR
    assert "laser: none of its 31 distances can be used: all are NaN." in caplog.text
    checked.now = 2.0
    parts.laser.scan = Stamped(scan, 2.0, 3)
    parts.base.odometry = at(2.0, 1.0, 0.0, 2.0)
    assert data.scan is parts.laser.scan and data.odometry is parts.base.odometry
    assert data.report(parts.laser).state == data.report(parts.base).state == OK


def test_the_device_with_bad_data_is_named_once(caplog: pytest.LogCaptureFixture) -> None:
    one = Checked()
    good = one.base.odometry
    for number in range(3):
        one.base.odometry = at(math.nan, 0.0, 0.0, 1.0 + number)
        assert one.states() == (OK, ERROR)
    assert [record.getMessage() for record in caplog.records] == [
        "base: its odometry has a NaN or an infinite number."
    ]
    one.base.odometry, one.laser.scan = good, replace(one.laser.sent, stamp=math.nan)
    assert one.states() == (ERROR, OK)


@pytest.mark.parametrize(
    "gap", [0.05, 8.0], ids=["at once, from far away", "after a time without the base"]
)
def test_the_pose_goes_on_if_the_base_is_switched_on_again(gap: float) -> None:
    parts = ToldBody()
    data = CheckedData(parts.body(), lambda: 10.0)
    for number in range(10):
        parts.base.odometry = at(3.0 + 0.1 * number, 2.0, math.pi / 2, 1 + number / 10)
        assert data.odometry is parts.base.odometry  # a drive is no jump
    again = 1.9 + gap
    parts.base.odometry = at(0.0, 0.0, 0.0, again)
    there = data.odometry
    assert there is not None
    assert tuple(there.value.pose) == pytest.approx((3.9, 2.0, math.pi / 2))
    parts.base.odometry = at(0.5, 0.0, 0.0, again + 1.0)  # half a metre ahead
    there = data.odometry
    assert there is not None
    assert tuple(there.value.pose) == pytest.approx((3.9, 2.5, math.pi / 2))
    assert there.value.twist == Twist(0.3, 0.0)


def test_a_base_that_was_only_silent_for_a_while_keeps_its_odometry() -> None:
    parts = ToldBody()
    data = CheckedData(parts.body(), lambda: 10.0)
    parts.base.odometry = at(3.0, 2.0, 0.0, 1.0)
    assert data.odometry is parts.base.odometry
    parts.base.odometry = at(3.6, 2.0, 0.2, 4.0)
    assert data.odometry is parts.base.odometry


@pytest.mark.parametrize(
    ("before", "after", "passed", "anew"),
    [
        ((0.0, 0.0, 2.0), (0.0, 0.0, 0.0), 0.05, True),
        ((3.0, 2.0, 1.0), (0.0, 0.0, 1.0), 8.0, True),
        ((-0.3, 0.0, 0.0), (0.0, 0.0, 0.0), 0.8, False),
        ((0.0, 0.0, 3.1), (0.0, 0.0, -3.1), 0.05, False),
        ((3.0, 2.0, 1.0), (9.0, 2.0, 1.0), 0.05, True),
        ((0.4, 0.0, 0.0), (0.0, 0.0, 0.0), 8.0, True),
        ((0.1, 0.0, 0.8), (0.0, 0.0, 0.0), 8.0, True),
        ((0.2, 0.0, 0.0), (0.0, 0.0, 0.0), 8.0, False),
        ((0.3, 0.0, 1.0), (0.0, 0.0, 1.0), 8.0, False),
    ],
    ids=[
        *("only turned", "a compass", "it drove across", "half a turn", "elsewhere at once"),
        *("close to the origin", "turned at the origin", "at the origin", "it drove to the origin"),
    ],
)
def test_a_new_beginning_is_told_from_a_drive(
    before: tuple[float, float, float],
    after: tuple[float, float, float],
    passed: float,
    anew: bool,
) -> None:
    one = Checked()
    one.now = 1.0 + passed
    one.base.odometry = at(*before, 1.0)
    assert one.data.odometry is one.base.odometry
    one.base.odometry = at(*after, 1.0 + passed)
    there = one.data.odometry
    assert there is not None
    assert tuple(there.value.pose) == pytest.approx(before if anew else after)


def test_odometry_that_comes_in_a_burst_is_no_new_beginning() -> None:
    one = Checked()
    one.base.odometry = replace(at(1.0, 0.0, 0.0, 1.0), measured=0.2)
    assert one.data.odometry is one.base.odometry
    one.base.odometry = replace(at(1.0, 0.0, 0.8, 1.0), measured=0.9)
    assert one.data.odometry is one.base.odometry


@pytest.mark.parametrize("off", [-1.7e9, -60.0, 700.0])
def test_the_stamps_must_be_of_the_robots_clock(
    off: float, caplog: pytest.LogCaptureFixture
) -> None:
    one = Checked()
    one.now = 1000.0
    one.laser.scan = replace(one.laser.sent, stamp=1000.0 - off)
    one.base.odometry = at(2.0, 1.0, 0.0, 1000.0 - off)
    assert (one.data.scan, one.data.odometry) == (None, None)
    assert one.states() == (ERROR, ERROR)
    assert "laser: the stamps of its data are not of wiring.clock.now()." in caplog.text
    one.laser.scan = replace(one.laser.sent, stamp=1000.0)
    one.base.odometry = at(2.0, 1.0, 0.0, 1000.0)
    assert one.states() == (OK, OK)


def test_data_are_as_old_as_their_stamp_whatever_the_driver_says() -> None:
    one = Checked()
    assert one.data.report(one.laser).age == one.data.report(one.base).age == 0.0
    one.now = 31.0
    assert one.data.report(one.laser).age == one.data.report(one.base).age == 30.0
    one.laser.age = 40.0
    assert one.data.report(one.laser).age == 40.0
    one.laser.age = one.parts.arms.age = -60.0
    assert one.states() == (ERROR, OK)
    assert one.data.report(one.parts.arms).state == ERROR


def test_a_device_that_has_sent_nothing_does_not_work() -> None:
    one = Checked()
    nothing: Any = None
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(type(one.laser), "scan", nothing)
        patched.setattr(type(one.base), "odometry", nothing)
        assert one.states() == (STALE, STALE)
        one.laser.state = ERROR
        assert one.states() == (ERROR, STALE)
    one.laser.state = OK
    assert one.states() == (OK, OK)


def test_a_property_that_raises_is_an_error_of_the_device(
    caplog: pytest.LogCaptureFixture,
) -> None:
    def fails(_: object) -> None:
        raise IndexError("no scan yet")

    one = Checked()
    good, moved = one.data.scan, one.data.odometry
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(type(one.laser), "scan", property(fails))
        patched.setattr(type(one.base), "odometry", property(fails))
        assert (one.data.scan, one.data.odometry) == (good, moved)
        assert one.states() == (ERROR, ERROR)
    assert "laser: its driver fails: IndexError: no scan yet." in caplog.text
    assert one.states() == (OK, OK)


class Bad(ToldDevice):
    def __init__(self, error: Exception | None = None) -> None:
        super().__init__("radio", [])
        self._error = error

    async def start(self) -> None:
        if self._error is not None:
            raise self._error
        await asyncio.Event().wait()

    def reading(self) -> Reading:
        raise KeyError("age")


async def test_a_driver_that_cannot_start_is_named() -> None:
    with pytest.raises(DeviceError, match="radio: its driver fails: ValueError: no port"):
        await start_device(Bad(ValueError("no port.")))
    with pytest.raises(DeviceError, match="radio: its driver has not started within"):
        await start_device(Bad(), 0.01)
    with pytest.raises(DeviceError, match="radio: its driver has not started within"):
        await restart_device(Bad(), 0.01)
    with pytest.raises(DeviceError, match="radio: its driver fails: TimeoutError: no answer"):
        await start_device(Bad(TimeoutError("no answer")))
    with pytest.raises(DeviceError, match=r"^It is off"):
        await start_device(Bad(DeviceError("It is off.")))


def test_a_reading_that_raises_is_an_error_of_the_device() -> None:
    assert safe_reading(Bad()).state == ERROR


@pytest.mark.parametrize(("reach", "farthest"), [(3.0, 3.0), (math.inf, 12.0), (40.0, 12.0)])
def test_returns_beyond_the_range_of_the_scanner_meet_nothing(
    reach: float, farthest: float
) -> None:
    one = Checked(reach)
    ranges = np.array([0.5, 2.9, 3.1, 8.0, 13.0, math.inf, *[1.0] * 10])
    one.laser.scan = Stamped(Scan(0.0, 0.1, ranges, 12.0), 1.0, 7, 0.9)
    scan = one.data.scan
    assert scan is not None and (scan.stamp, scan.seq, scan.measured) == (1.0, 7, 0.9)
    assert scan.value.farthest == farthest
    assert (
        scan.value.ranges.tolist()
        == np.where(np.isfinite(ranges), np.minimum(ranges, farthest), ranges).tolist()
    )
    assert len(endpoints(scan.value)) == int((ranges < farthest).sum())
    assert one.data.scan is scan  # not computed again
    assert one.data.report(one.laser).state == OK
