"""Readings of a robot's devices: one each, newest data only.

A world hands these out (`World.health`); what they mean is the business of the fault rules.
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
"""The states of a device from best to worst. Stale is not an error: nothing was heard, so nothing
is known; as ROS's diagnostics have it."""

Fact = float | bool | str
"""A device's measurement of itself: a number, yes or no, or a word."""


class Reading(NamedTuple):
    """The health of one device.

    `age` is how long ago, in s, its newest data came; `state` is what the device says of itself;
    `facts` are what it measures (which ones there are, the robot's profile says). `rate` is how
    often a second data comes; None if nobody counts, or not for long enough.
    """

    device: str
    age: float = 0.0
    state: DeviceState = OK
    facts: Mapping[str, Fact] = MappingProxyType({})
    rate: float | None = None


Health = tuple[Reading, ...]
"""The readings of all devices of a robot."""


def state_of(device: DeviceProfile | None, reading: Reading) -> DeviceState:
    """Return the state of a device: what it says of itself, or STALE if its data is too old.

    A measurement that is no number is an error. An age that is none, or has no end, is too old
    for any device; of one that no profile knows (None) every other age is young enough.
    """
    if reading.state == ERROR or any(fact != fact for fact in reading.facts.values()):
        return ERROR
    oldest = math.inf if device is None else device.stale_after
    return reading.state if math.isfinite(reading.age) and reading.age <= oldest else STALE


def lasting_state(device: DeviceProfile | None, reading: Reading) -> DeviceState:
    """Return the state of a device as `state_of` does, but let late data be late for a while.

    Data that is too old and not lost yet is a pause: the device counts as it was. A device whose
    data is young and that says itself that it has none is believed.
    """
    state = state_of(device, reading)
    if device is None or state != STALE:
        return state
    if not device.stale_after < reading.age <= device.lost_after:
        return STALE
    return OK if reading.state == STALE else reading.state


def device_state(told: object) -> DeviceState | None:
    """Return the state that another process or a file tells; None: there is no such state."""
    return next((one for one in STATES if one == told), None)
