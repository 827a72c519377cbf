"""The devices that a robot can have, and those that a robot lacks."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace
from functools import cache
from types import MappingProxyType

from tangy_profiles.robot import LINK, DeviceProfile, Robot, load_robot, shipped_robots

NEEDED = (LINK, "base", "laser", "localisation", "navigator")
"""Devices that every robot has: it must be reachable, drive, and know where it is."""

CARDS = "cards"
STOP_BUTTON = "stop_button"
TOLD_MISSING = (STOP_BUTTON, "camera", "requests", "voice", "screen", "arms")
"""Devices whose absence is reported to staff, in this order."""


@cache
def known_devices() -> Mapping[str, DeviceProfile]:
    """Return the devices of all built-in robots by name, each with the union of its facts."""
    found: dict[str, DeviceProfile] = {}
    for name in shipped_robots():
        for device in load_robot(name).devices.values():
            known = found.get(device.name, device)
            facts = MappingProxyType({**device.facts, **known.facts})
            found[device.name] = replace(known, facts=facts)
    return MappingProxyType(found)


def possible_devices(robot: Robot) -> Mapping[str, DeviceProfile]:
    """Return the devices that fault rules may name: the robot's own, and all known ones.

    Facts that the robot's own device lacks are taken from the known device.
    """
    known = known_devices()
    own = {
        name: replace(
            device,
            facts=MappingProxyType(
                {**(known[name].facts if name in known else {}), **device.facts}
            ),
        )
        for name, device in robot.devices.items()
    }
    return {**known, **own}


def driven(robot: Robot, also: Collection[str] = ()) -> Robot:
    """Return a robot without the listed devices that have no driver.

    Args:
        robot: the robot.
        also: devices that have a driver although the file does not name it.

    Returns:
        The robot; its `undriven` are the devices that were left out.
    """
    there = {*NEEDED, *robot.drivers, *also}
    kept = {
        name: device for name, device in robot.devices.items() if name in there or device.source
    }
    left_out = [device for name, device in robot.devices.items() if name not in kept]
    return replace(robot, devices=MappingProxyType(kept), undriven=(*robot.undriven, *left_out))


def can_be_left_out(robot: Robot, device: str) -> bool:
    """Return whether a robot can be switched on without one of its devices.

    Not without its stop button: people would press it in vain.
    """
    return device in robot.devices and device not in (*NEEDED, STOP_BUTTON)


def left_out(robot: Robot, device: str) -> Robot:
    """Return a robot without one of its devices, which is added to its `undriven`."""
    if device not in robot.devices:
        return robot
    devices, drivers = dict(robot.devices), dict(robot.drivers)
    profile = devices.pop(device)
    drivers.pop(device, None)
    return replace(
        robot,
        devices=MappingProxyType(devices),
        drivers=MappingProxyType(drivers),
        undriven=(*robot.undriven, profile),
    )


def missing_devices(robot: Robot) -> tuple[str, ...]:
    """Return the names of the devices that a robot lacks and that staff are told about."""
    known = tuple(name for name in TOLD_MISSING if name not in robot.devices)
    return (*known, *(one.name for one in robot.undriven if one.name not in TOLD_MISSING))


def reads_cards(robot: Robot) -> bool:
    """Return whether a robot has a camera that reads cards."""
    return any(device.looks_at == CARDS for device in robot.devices.values())
