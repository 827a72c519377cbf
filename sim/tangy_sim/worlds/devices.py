"""The simulated robot's devices: what they report when they are well, and with a fault."""

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
"""What the devices measure when all is well; a guess at a lit room with people moving in it."""

WELL: Health = tuple(
    Reading(device, 0.05, OK, MappingProxyType(dict(facts))) for device, facts in READINGS.items()
)

Symptom = Callable[[float], dict[str, tuple[float | None, DeviceState, dict[str, Fact]]]]
"""Seconds since a fault set in -> device -> (age or None, state, facts that are otherwise)."""


def silent(*devices: str) -> Symptom:
    """Devices from which nothing comes any more."""
    return lambda seconds: {device: (seconds, OK, {}) for device in devices}


def dead(device: str) -> Symptom:
    """A device whose process has ended."""
    return lambda seconds: {device: (seconds, ERROR, {})}


def otherwise(device: str, **facts: Fact) -> Symptom:
    """A device that reports, but something else than when it is well."""
    return lambda _: {device: (None, OK, facts)}


def lasting(device: str, fact: str) -> Symptom:
    """A device of which one measurement grows with the time."""
    return lambda seconds: {device: (None, OK, {fact: seconds})}


def readings(symptoms: list[tuple[Symptom, float]]) -> Health:
    """Return what all devices report, with symptoms of faults and the s that they have lasted."""
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
