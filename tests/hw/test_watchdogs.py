"""The watchdogs: what a robot's devices say, how old it is, and whether it may drive."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from tangy_hw.health import DRIVES_BY, Watchdogs
from tangy_profiles.health import ERROR, OK, STALE, WARN, Reading
from tangy_profiles.robot import load_robot

ROBOT = load_robot()


def saying(**said: Reading) -> dict[str, Callable[[], Reading]]:
    well = {name: Reading(name) for name in ROBOT.devices} | said
    return {name: lambda reading=reading: reading for name, reading in well.items()}  # type: ignore[misc]


def test_every_device_of_the_profile_has_a_reading() -> None:
    health = Watchdogs(ROBOT, saying()).health()
    assert [reading.device for reading in health] == list(ROBOT.devices)


def test_a_device_that_is_not_there_holds_nothing_up() -> None:
    dogs = Watchdogs(ROBOT, {})
    assert all(reading == Reading(reading.device) for reading in dogs.health())
    assert dogs.hazard() == ""


@pytest.mark.parametrize("device", DRIVES_BY)
@pytest.mark.parametrize("state", [ERROR, STALE])
def test_it_must_not_drive_by_a_device_that_is_not_well(device: str, state: str) -> None:
    dogs = Watchdogs(ROBOT, saying(**{device: Reading(device, state=state)}))
    assert dogs.hazard().startswith(ROBOT.devices[device].label)


@pytest.mark.parametrize("device", DRIVES_BY)
def test_it_must_not_drive_by_data_that_is_too_old(device: str) -> None:
    fresh = ROBOT.devices[device].stale_after
    assert Watchdogs(ROBOT, saying(**{device: Reading(device, age=fresh)})).hazard() == ""
    late = Watchdogs(ROBOT, saying(**{device: Reading(device, age=fresh + 0.01)}))
    assert late.hazard() == f"{ROBOT.devices[device].label} says nothing"


@pytest.mark.parametrize("device", [d for d in ROBOT.devices if d not in DRIVES_BY])
def test_it_may_drive_without_a_voice_or_a_camera(device: str) -> None:
    assert Watchdogs(ROBOT, saying(**{device: Reading(device, state=ERROR)})).hazard() == ""


def test_it_must_not_drive_with_the_stop_pressed_or_the_laser_covered() -> None:
    pressed = Reading("stop_button", facts={"latched": True})
    assert Watchdogs(ROBOT, saying(stop_button=pressed)).hazard() == "emergency stop is pressed"
    covered = Reading("laser", facts={"near_share": 0.7})
    assert Watchdogs(ROBOT, saying(laser=covered)).hazard() == "laser scanner is covered"


def test_a_warning_is_no_hazard() -> None:
    assert Watchdogs(ROBOT, saying(base=Reading("base", state=WARN))).hazard() == ""


def test_a_device_can_be_taken_for_broken() -> None:
    dogs = Watchdogs(ROBOT, saying())
    dogs.fail("navigator")
    assert dogs.hazard() == "navigation has an error"
    dogs.fail("navigator", OK)
    assert dogs.hazard() == ""
