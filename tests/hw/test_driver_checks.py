"""A robot does not drive by data that make no sense, and its odometry may begin anew."""

from __future__ import annotations

import asyncio
import math
from dataclasses import replace

import numpy as np
import pytest

from tangy_hw.device_protocols import DeviceError, Odometry, Pose, Stamped, Twist
from tangy_hw.robot_process.driver_checks import CheckedData, safe_reading, start_device
from tangy_profiles.health import ERROR, OK, Reading
from tests.hw.live_bodies import ToldBody, ToldDevice


def at(x: float, y: float, heading: float, stamp: float) -> Stamped[Odometry]:
    return Stamped(Odometry(Pose(x, y, heading), Twist(0.3, 0.0)), stamp, int(stamp * 10))


def test_bad_data_are_an_error_until_they_make_sense_again(
    caplog: pytest.LogCaptureFixture,
) -> None:
    parts = ToldBody()
    data = CheckedData(parts.body())
    good, moved = data.scan, data.odometry
    assert data.report(parts.laser).state == data.report(parts.base).state == OK
    scan = parts.laser.scan.value
    parts.laser.scan = Stamped(replace(scan, ranges=np.full(31, math.nan)), 1.0, 2)
    parts.base.odometry = at(math.nan, 0.0, 0.0, 1.0)
    assert (data.scan, data.odometry) == (good, moved)  # the last ones that made sense
    assert data.report(parts.laser).state == data.report(parts.base).state == ERROR
    assert "laser: 31 of 31 ranges are NaN" in caplog.text
    parts.laser.scan = Stamped(scan, 2.0, 3)
    parts.base.odometry = at(2.0, 1.0, 0.0, 2.0)
    assert data.scan is parts.laser.scan and data.odometry is parts.base.odometry
    assert data.report(parts.laser).state == data.report(parts.base).state == OK


@pytest.mark.parametrize(
    "gap", [0.05, 8.0], ids=["at once, from far away", "after a time without the base"]
)
def test_the_pose_goes_on_if_the_base_is_switched_on_again(gap: float) -> None:
    parts = ToldBody()
    data = CheckedData(parts.body())
    for number in range(10):
        parts.base.odometry = at(3.0 + 0.1 * number, 2.0, math.pi / 2, number / 10)
        assert data.odometry is parts.base.odometry  # a drive is no jump
    again = 0.9 + gap
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
    data = CheckedData(parts.body())
    parts.base.odometry = at(3.0, 2.0, 0.0, 1.0)
    assert data.odometry is parts.base.odometry
    parts.base.odometry = at(3.6, 2.0, 0.2, 4.0)
    assert data.odometry is parts.base.odometry


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
    with pytest.raises(DeviceError, match=r"^It is off"):
        await start_device(Bad(DeviceError("It is off.")))


def test_a_reading_that_raises_is_an_error_of_the_device() -> None:
    assert safe_reading(Bad()).state == ERROR
