"""The watchdogs: the state and age of the devices decide whether the robot may drive."""

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
"""The robot must not drive without these; listed here, so that no device is forgotten."""

OTHERS = [device for device in ROBOT.devices if device not in NEEDED]


def saying(**said: Reading) -> dict[str, Callable[[], Reading]]:
    well = {name: Reading(name) for name in ROBOT.devices} | said
    return {name: lambda reading=reading: reading for name, reading in well.items()}  # type: ignore[misc]


def hazard(reading: Reading) -> str:
    """Return why the robot must not drive if one device reports this; all others are healthy."""
    return Watchdogs(ROBOT, saying(**{reading.device: reading})).hazard()


def label(device: str) -> str:
    return ROBOT.devices[device].label


def test_every_device_of_the_profile_has_its_newest_reading() -> None:
    counts = {device: count(1) for device in ROBOT.devices}
    dogs = Watchdogs(
        ROBOT,
        {d: lambda d=d: Reading(d, age=next(counts[d])) for d in ROBOT.devices},  # type: ignore[misc]
    )
    for age in (1, 2):
        assert dogs.health() == tuple(Reading(device, age=age) for device in ROBOT.devices)


def test_a_missing_device_does_not_stop_the_robot() -> None:
    dogs = Watchdogs(ROBOT, {})
    assert dogs.health() == tuple(Reading(device) for device in ROBOT.devices)
    assert dogs.hazard() == ""


def test_a_healthy_robot_may_drive() -> None:
    assert Watchdogs(ROBOT, saying()).hazard() == ""


@pytest.mark.parametrize("device", NEEDED)
@pytest.mark.parametrize(
    ("state", "why"), [(ERROR, "has an error"), (STALE, "says nothing"), (WARN, "")]
)
def test_a_failing_device_stops_the_robot(device: str, state: DeviceState, why: str) -> None:
    assert hazard(Reading(device, state=state)) == (f"{label(device)} {why}" if why else "")


@pytest.mark.parametrize("device", NEEDED)
@pytest.mark.parametrize("state", [OK, WARN])
def test_stale_data_stops_the_robot(device: str, state: DeviceState) -> None:
    fresh = ROBOT.devices[device].stale_after
    assert hazard(Reading(device, age=fresh, state=state)) == ""
    assert hazard(Reading(device, age=fresh + 0.01, state=state)) == f"{label(device)} says nothing"


def test_the_state_of_a_device_is_reported_before_its_age() -> None:
    assert hazard(Reading("base", age=1e6, state=ERROR)) == f"{label('base')} has an error"


@pytest.mark.parametrize("device", OTHERS)
@pytest.mark.parametrize("state", [ERROR, STALE])
def test_a_robot_without_voice_or_camera_may_drive(device: str, state: DeviceState) -> None:
    assert hazard(Reading(device, age=1e6, state=state)) == ""


def test_a_pressed_emergency_stop_stops_the_robot() -> None:
    assert hazard(Reading("stop_button", facts={"latched": True})) == "emergency stop is pressed"
    assert hazard(Reading("stop_button", facts={"latched": False})) == ""


def test_a_covered_laser_stops_the_robot() -> None:
    covered = Reading("laser", facts={"near_share": DARK + 0.01})
    assert hazard(covered) == "laser scanner is covered"
    assert hazard(Reading("laser", facts={"near_share": DARK})) == ""


def test_a_laser_without_variety_stops_the_robot() -> None:
    blind = Reading("laser", facts={"near_share": 0.0, "variety": BLIND - 0.001})
    assert hazard(blind) == "laser scanner sees nothing new"
    assert hazard(Reading("laser", facts={"near_share": 0.0, "variety": 0})) != ""
    assert hazard(Reading("laser", facts={"near_share": 0.0, "variety": BLIND})) == ""
    assert hazard(Reading("laser", facts={"near_share": 0.0})) == ""  # the second is not over yet


def test_the_limits_match_the_diagnosis_of_a_covered_laser() -> None:
    rule = load_faults(ROBOT).rule("laser-occluded")
    assert {(one.key, one.test, one.value) for (one,) in rule.when} == {
        ("laser.near_share", "above", DARK),
        ("laser.variety", "below", BLIND),
    }


@pytest.mark.parametrize(("state", "why"), [(ERROR, "has an error"), (STALE, "says nothing")])
def test_a_device_can_be_set_to_failed_despite_its_reading(state: DeviceState, why: str) -> None:
    dogs = Watchdogs(ROBOT, saying())
    dogs.fail("navigator", state)
    assert dogs.hazard() == f"navigation {why}"
    said = {reading.device: reading.state for reading in dogs.health()}
    assert said == dict.fromkeys(ROBOT.devices, OK) | {"navigator": state}
    dogs.fail("navigator", OK)
    assert dogs.hazard() == "" and all(reading.state == OK for reading in dogs.health())


@pytest.mark.parametrize("age", [math.inf, math.nan])
def test_an_infinite_age_is_stale_for_every_device(age: float) -> None:
    assert hazard(Reading("base", age=age)) == f"{label('base')} says nothing"
    assert Watchdogs(ROBOT, {}).state(Reading("lift", age=age)) == STALE


def test_a_measurement_of_nan_is_an_error() -> None:
    broken = Reading("laser", facts={"near_share": math.nan})
    assert hazard(broken) == f"{label('laser')} has an error"


def test_the_age_of_an_unknown_device_is_ignored() -> None:
    assert Watchdogs(ROBOT, {}).state(Reading("lift", age=1e6, state=WARN)) == WARN
