"""The watchdogs: what a robot's devices say, how old it is, and whether it may drive."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import count

import pytest

from tangy_hw.watchdogs import BLIND, DARK, Watchdogs
from tangy_profiles.fault_file import load_faults
from tangy_profiles.health import ERROR, OK, STALE, WARN, DeviceState, Reading
from tangy_profiles.robot import load_robot

ROBOT = load_robot()
NEEDED = ("link", "stop_button", "base", "laser", "localisation", "navigator")
"""Without these it must not drive; written down here, so that none is left out unnoticed."""

OTHERS = [device for device in ROBOT.devices if device not in NEEDED]


def saying(**said: Reading) -> dict[str, Callable[[], Reading]]:
    well = {name: Reading(name) for name in ROBOT.devices} | said
    return {name: lambda reading=reading: reading for name, reading in well.items()}  # type: ignore[misc]


def hazard(reading: Reading) -> str:
    """Say why the robot must not drive while one device says this, and all others are well."""
    return Watchdogs(ROBOT, saying(**{reading.device: reading})).hazard()


def label(device: str) -> str:
    return ROBOT.devices[device].label


def test_every_device_of_the_profile_has_a_reading_and_it_is_the_newest() -> None:
    counts = {device: count(1) for device in ROBOT.devices}
    dogs = Watchdogs(
        ROBOT,
        {d: lambda d=d: Reading(d, age=next(counts[d])) for d in ROBOT.devices},  # type: ignore[misc]
    )
    for age in (1, 2):
        assert dogs.health() == tuple(Reading(device, age=age) for device in ROBOT.devices)


def test_a_device_that_is_not_there_holds_nothing_up() -> None:
    dogs = Watchdogs(ROBOT, {})
    assert dogs.health() == tuple(Reading(device) for device in ROBOT.devices)
    assert dogs.hazard() == ""


def test_a_robot_that_is_well_may_drive() -> None:
    assert Watchdogs(ROBOT, saying()).hazard() == ""


@pytest.mark.parametrize("device", NEEDED)
@pytest.mark.parametrize(
    ("state", "why"), [(ERROR, "has an error"), (STALE, "says nothing"), (WARN, "")]
)
def test_it_must_not_drive_by_a_device_that_is_not_well(
    device: str, state: DeviceState, why: str
) -> None:
    assert hazard(Reading(device, state=state)) == (f"{label(device)} {why}" if why else "")


@pytest.mark.parametrize("device", NEEDED)
@pytest.mark.parametrize("state", [OK, WARN])
def test_it_must_not_drive_by_data_that_is_too_old(device: str, state: DeviceState) -> None:
    fresh = ROBOT.devices[device].stale_after
    assert hazard(Reading(device, age=fresh, state=state)) == ""
    assert hazard(Reading(device, age=fresh + 0.01, state=state)) == f"{label(device)} says nothing"


def test_what_a_device_says_of_itself_is_told_before_its_age() -> None:
    assert hazard(Reading("base", age=1e6, state=ERROR)) == f"{label('base')} has an error"


@pytest.mark.parametrize("device", OTHERS)
@pytest.mark.parametrize("state", [ERROR, STALE])
def test_it_may_drive_without_a_voice_or_a_camera(device: str, state: DeviceState) -> None:
    assert hazard(Reading(device, age=1e6, state=state)) == ""


def test_it_must_not_drive_with_the_stop_pressed() -> None:
    assert hazard(Reading("stop_button", facts={"latched": True})) == "emergency stop is pressed"
    assert hazard(Reading("stop_button", facts={"latched": False})) == ""


def test_it_must_not_drive_with_the_laser_covered() -> None:
    covered = Reading("laser", facts={"near_share": DARK + 0.01})
    assert hazard(covered) == "laser scanner is covered"
    assert hazard(Reading("laser", facts={"near_share": DARK})) == ""


def test_it_must_not_drive_while_the_laser_sees_nothing_or_the_same_again_and_again() -> None:
    blind = Reading("laser", facts={"near_share": 0.0, "variety": BLIND - 0.001})
    assert hazard(blind) == "laser scanner sees nothing new"
    assert hazard(Reading("laser", facts={"near_share": 0.0, "variety": 0})) != ""
    assert hazard(Reading("laser", facts={"near_share": 0.0, "variety": BLIND})) == ""
    assert hazard(Reading("laser", facts={"near_share": 0.0})) == ""  # a second is not over yet


def test_it_stands_by_the_limits_by_which_a_covered_laser_is_diagnosed() -> None:
    rule = load_faults(ROBOT).rule("laser-occluded")
    assert {(one.key, one.test, one.value) for (one,) in rule.when} == {
        ("laser.near_share", "above", DARK),
        ("laser.variety", "below", BLIND),
    }


@pytest.mark.parametrize(("state", "why"), [(ERROR, "has an error"), (STALE, "says nothing")])
def test_a_device_can_be_taken_for_broken_whatever_it_says(state: DeviceState, why: str) -> None:
    dogs = Watchdogs(ROBOT, saying())
    dogs.fail("navigator", state)
    assert dogs.hazard() == f"navigation {why}"
    said = {reading.device: reading.state for reading in dogs.health()}
    assert said == dict.fromkeys(ROBOT.devices, OK) | {"navigator": state}
    dogs.fail("navigator", OK)
    assert dogs.hazard() == "" and all(reading.state == OK for reading in dogs.health())


@pytest.mark.parametrize("age", [math.inf, math.nan])
def test_an_age_without_an_end_is_too_old_for_any_device(age: float) -> None:
    assert hazard(Reading("base", age=age)) == f"{label('base')} says nothing"
    assert Watchdogs(ROBOT, {}).state(Reading("lift", age=age)) == STALE


def test_a_measurement_that_is_no_number_is_an_error() -> None:
    broken = Reading("laser", facts={"near_share": math.nan})
    assert hazard(broken) == f"{label('laser')} has an error"


def test_of_a_device_that_no_profile_knows_the_age_says_nothing() -> None:
    assert Watchdogs(ROBOT, {}).state(Reading("lift", age=1e6, state=WARN)) == WARN
