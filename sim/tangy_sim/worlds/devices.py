"""The simulated robot's devices: their readings without faults, and with them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

from tangy_profiles.health import ERROR, OK, DeviceState, Fact, Health, Reading
from tangy_profiles.robot import Robot

AGE = 0.05  # s, of the data of a device without faults; no robot calls that stale

READINGS: Mapping[str, Mapping[str, Fact]] = MappingProxyType(
    {
        "link": {"frozen": 0.0, "pauses": "seldom", "lost": 0.0},
        "stop_button": {"latched": False},
        "laser": {"near_share": 0.04, "variety": 0.35},
        "base": {"still": 0.0, "slip": 0.02},
        "localisation": {"fit": 1.0, "spread": 0.08, "found": True},
        "navigator": {"path": "clear"},
        "camera": {"brightness": 0.45, "contrast": 0.22, "unchanged": 0.0},
        "requests": {},
        "voice": {},
        "screen": {},
        "arms": {"hardware_error": False},
        "battery": {"charge": 0.9, "charging": False},
    }
)
"""Measurements without faults; an estimate for a lit room with people moving in it."""

WELL: Health = tuple(
    Reading(device, AGE, OK, MappingProxyType(dict(facts))) for device, facts in READINGS.items()
)
"""The readings of all simulated devices, without faults."""


def well(robot: Robot | None) -> Health:
    """Return the readings of a robot's devices without faults; None: of all simulated devices.

    Of a device that nothing simulates, the reading says that it works, and holds no measurements.
    """
    if robot is None:
        return WELL
    return tuple(
        Reading(
            name,
            AGE,
            OK,
            MappingProxyType(
                {f: v for f, v in READINGS.get(name, {}).items() if f in device.facts}
            ),
        )
        for name, device in robot.devices.items()
    )


Symptom = Callable[[float], dict[str, tuple[float | None, DeviceState, dict[str, Fact]]]]
"""Seconds since a fault began -> device -> (age or None, state, changed facts)."""


def silent(*devices: str) -> Symptom:
    """Return the symptom of devices that send nothing."""
    return lambda seconds: {device: (seconds, OK, {}) for device in devices}


def dead(device: str) -> Symptom:
    """Return the symptom of a device whose process has ended."""
    return lambda seconds: {device: (seconds, ERROR, {})}


def otherwise(device: str, **facts: Fact) -> Symptom:
    """Return the symptom of a device with changed facts."""
    return lambda _: {device: (None, OK, facts)}


def lasting(device: str, fact: str) -> Symptom:
    """Return the symptom of a device with a measurement that grows with time."""
    return lambda seconds: {device: (None, OK, {fact: seconds})}


def readings(symptoms: list[tuple[Symptom, float]], healthy: Health = WELL) -> Health:
    """Return the readings of a robot with faults.

    Args:
        symptoms: the symptoms, and the s that each has lasted. Those of a device that the robot
            does not have are ignored.
        healthy: the readings of its devices without faults.
    """
    found: dict[str, Reading] = {reading.device: reading for reading in healthy}
    for symptom, seconds in symptoms:
        for device, (age, state, facts) in symptom(seconds).items():
            if device not in found:
                continue
            was = found[device]
            found[device] = Reading(
                device,
                was.age if age is None else max(age, was.age),
                state if state != OK else was.state,
                MappingProxyType({**was.facts, **facts}),
            )
    return tuple(found.values())
