"""The newest value from a topic, and its age."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any, Generic, TypeVar

from tangy_hw.device_protocols import Stamped
from tangy_hw.drivers.source_clock import SourceClock
from tangy_hw.rate_estimator import RateEstimator
from tangy_profiles.health import OK, STALE, DeviceState, Fact, Reading

Value = TypeVar("Value")
NOTHING: Mapping[str, Fact] = MappingProxyType({})
LOOK_SECONDS = 0.1  # of real time, after which a simulated clock is checked


class LatestValue(Generic[Value]):
    """A value with its number and time of arrival."""

    def __init__(self, clock: Callable[[], float]) -> None:
        """Start without a value; the age counts from now."""
        self.stamped: Stamped[Value] | None = None
        """The newest value; None before the first."""
        self._clock = clock
        self._arrivals = RateEstimator()
        self._source = SourceClock()
        self._since = clock()

    def take(self, value: Value, stamp: float | None = None) -> None:
        """Store a new value; `stamp` is its time on the clock of its source, in s, if known."""
        number = 1 if self.stamped is None else self.stamped.seq + 1
        arrived = self._clock()
        measured = None if stamp is None else self._source.measured(stamp, arrived)
        self.stamped = Stamped(value, arrived, number, measured)
        self._arrivals.count(arrived)

    def restart(self) -> None:
        """Forget the value, so that only new data counts."""
        self.stamped, self._since = None, self._clock()
        self._arrivals.restart()

    @property
    def age(self) -> float:
        """Age of the value in s; before the first, the waiting time."""
        since = self._since if self.stamped is None else self.stamped.stamp
        return max(self._clock() - since, 0.0)

    @property
    def rate(self) -> float | None:
        """Rate of values per second; None: unknown yet."""
        return self._arrivals.rate(self._clock())

    def reading(
        self, device: str, state: DeviceState = OK, facts: Mapping[str, Fact] = NOTHING
    ) -> Reading:
        """Return the reading for the diagnosis: stale before the first value, otherwise `state`."""
        said: DeviceState = STALE if self.stamped is None else state
        return Reading(device, self.age, said, facts, self.rate)


async def awaited(
    future: asyncio.Future[Any],
    until: float,
    clock: Callable[[], float],
    goes_on: Callable[[], bool] = lambda: True,
) -> bool:
    """Wait for a future until a time of a clock; return whether it is done.

    Args:
        future: the future.
        until: latest time on the clock, in s.
        clock: returns the time in s.
        goes_on: returns whether to go on waiting.
    """
    while not future.done() and goes_on() and (left := until - clock()) > 0:
        await asyncio.wait({future}, timeout=min(left, LOOK_SECONDS))
    return future.done()
