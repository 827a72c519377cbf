"""Readings of a robot's devices, with the newest data only.

A world provides them (`World.health`); the fault rules interpret them.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, Final, Literal, NamedTuple

if TYPE_CHECKING:
    from tangy_profiles.robot import DeviceProfile

DeviceState = Literal["OK", "WARN", "ERROR", "STALE"]
OK: Final = "OK"
WARN: Final = "WARN"
ERROR: Final = "ERROR"
STALE: Final = "STALE"
STATES: tuple[DeviceState, ...] = (OK, WARN, STALE, ERROR)
"""The states of a device from best to worst.

Stale is not an error: nothing was received, so nothing is known, as in ROS diagnostics.
"""

NEVER: Final = 3600.0
"""The age of the data of a device that has sent none, in s; no data count as older."""

Fact = float | bool | str
"""A device's measurement: a number, a boolean, or a word."""


class Reading(NamedTuple):
    """The health of one device.

    `age` is the age of its newest data in s, `state` its self-reported state, and `facts` are its
    measurements (listed in the robot's profile). `rate` is its data rate per second; None if it is
    not measured yet.
    """

    device: str
    age: float = 0.0
    state: DeviceState = OK
    facts: Mapping[str, Fact] = MappingProxyType({})
    rate: float | None = None


Health = tuple[Reading, ...]
"""The readings of all devices of a robot."""


def state_of(device: DeviceProfile | None, reading: Reading) -> DeviceState:
    """Return the state of a device: the reported one, or STALE if its data is too old.

    A measurement of NaN is an error. An infinite or NaN age is stale for any device; other ages are
    never stale for an unknown device (None).
    """
    if reading.state == ERROR or any(fact != fact for fact in reading.facts.values()):
        return ERROR
    oldest = math.inf if device is None else device.stale_after
    return reading.state if math.isfinite(reading.age) and reading.age <= oldest else STALE


def lasting_state(device: DeviceProfile | None, reading: Reading) -> DeviceState:
    """Return the state of a device as `state_of` does, but tolerate late data for a while.

    Stale data that is not lost yet is a pause, and the earlier state stays. A device with fresh
    data that itself reports STALE is believed.
    """
    state = state_of(device, reading)
    if device is None or state != STALE:
        return state
    if not device.stale_after < reading.age <= device.lost_after:
        return STALE
    return OK if reading.state == STALE else reading.state


def device_state(told: object) -> DeviceState | None:
    """Return a state read from another process or a file; None if it is not valid."""
    return next((one for one in STATES if one == told), None)
