"""Limits on late data of a robot: for a pause, for calling staff, and for a fault."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Final, Literal

from tangy_profiles.reading import Table

Pausing = Literal["seldom", "often", "too often"]
SELDOM: Final = "seldom"
OFTEN: Final = "often"
TOO_OFTEN: Final = "too often"
PAUSING: tuple[Pausing, ...] = (SELDOM, OFTEN, TOO_OFTEN)
"""How much time a robot loses to pauses for late data."""


@dataclass(frozen=True)
class Liveness:
    """Limits for a robot's reaction to late data: s, m/s, and shares of time.

    Data older than a device's `stale_after` makes the robot pause. It continues after
    `fresh_readings` new ones, at most at `slow_speed` for `slow_seconds`. Data older than
    `fault_after` is a fault. Staff are told if pauses took more than `warn_share` of the last
    `window_seconds`; more than `fault_share` is a fault.
    """

    fault_after: float = 1.5
    fresh_readings: float = 3
    slow_seconds: float = 2.0
    slow_speed: float = 0.15
    window_seconds: float = 60.0
    warn_share: float = 0.05
    fault_share: float = 0.5


RANGES = {
    "fault_after": (0.3, 10.0),
    "fresh_readings": (1, 20),
    "slow_seconds": (0.0, 30.0),
    "slow_speed": (0.02, 0.5),
    "window_seconds": (10.0, 600.0),
    "warn_share": (0.005, 1.0),
    "fault_share": (0.01, 1.0),
}
"""The range of each setting."""


def read_liveness(top: Table) -> Liveness:
    """Read the limits on late data from a robot's profile; missing ones get the defaults.

    Raises:
        ProfileError: a value is out of range.
    """
    table = top.table("liveness", optional=True)
    usual = Liveness()
    found = {
        one.name: table.number(one.name, *RANGES[one.name], default=getattr(usual, one.name))
        for one in fields(Liveness)
    }
    table.close()
    return Liveness(**found)
