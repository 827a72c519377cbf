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
"""How much time a robot loses because it stands for late data."""


@dataclass(frozen=True)
class Liveness:
    """Limits for a robot's reaction to late data: s, m/s, and shares of time.

    Data older than a device's `stale_after` makes the robot stand: a pause. It goes on by itself
    after `fresh_readings` new ones, no faster than `slow_speed` for `slow_seconds`. Data that is
    older than `fault_after` is a fault. Staff are told where more than `warn_share` of the last
    `window_seconds` was lost to pauses; more than `fault_share` is a fault.
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
"""From which to which value each setting may be."""


def read_liveness(top: Table) -> Liveness:
    """Read what a robot's file says about late data; what it leaves out is as is usual.

    Raises:
        ProfileError: a value that is out of its range.
    """
    table = top.table("liveness", optional=True)
    usual = Liveness()
    found = {
        one.name: table.number(one.name, *RANGES[one.name], default=getattr(usual, one.name))
        for one in fields(Liveness)
    }
    table.close()
    return Liveness(**found)
