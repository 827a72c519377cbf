"""The simulated robot's devices: their readings without faults, and with them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

from tangy_profiles.health import ERROR, OK, DeviceState, Fact, Health, Reading

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
    }
)
"""Measurements without faults; an estimate for a lit room with people moving in it."""

WELL: Health = tuple(
    Reading(device, 0.05, OK, MappingProxyType(dict(facts))) for device, facts in READINGS.items()
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


def readings(symptoms: list[tuple[Symptom, float]]) -> Health:
    """Return the readings of all devices, with symptoms and the s that they have lasted."""
    found: dict[str, Reading] = {reading.device: reading for reading in WELL}
    for symptom, seconds in symptoms:
        for device, (age, state, facts) in symptom(seconds).items():
            was = found[device]
            found[device] = Reading(
                device,
                was.age if age is None else max(age, was.age),
                state if state != OK else was.state,
                MappingProxyType({**was.facts, **facts}),
            )
    return tuple(found.values())
