"""The newest of what a topic brought, and how old it is."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any, Generic, TypeVar

from tangy_hw.device_protocols import Stamped
from tangy_hw.rate_estimator import RateEstimator
from tangy_profiles.health import OK, STALE, DeviceState, Fact, Reading

Value = TypeVar("Value")
NOTHING: Mapping[str, Fact] = MappingProxyType({})
LOOK_SECONDS = 0.1  # of the machine's time, after which a clock that is not its own is looked at


class Newest(Generic[Value]):
    """A value with its number and the time at which it arrived."""

    def __init__(self, clock: Callable[[], float]) -> None:
        """Begin without one; its age counts from now."""
        self.stamped: Stamped[Value] | None = None
        """The newest value; None: there was none yet."""
        self._clock = clock
        self._arrivals = RateEstimator()
        self._since = clock()

    def take(self, value: Value) -> None:
        """Take a new one."""
        number = 1 if self.stamped is None else self.stamped.seq + 1
        self.stamped = Stamped(value, self._clock(), number)
        self._arrivals.count(self.stamped.stamp)

    def restart(self) -> None:
        """Forget what came, so that only new data counts."""
        self.stamped, self._since = None, self._clock()
        self._arrivals.restart()

    @property
    def age(self) -> float:
        """How long ago it came, in s; before there was any, since when it is waited for."""
        since = self._since if self.stamped is None else self.stamped.stamp
        return max(self._clock() - since, 0.0)

    @property
    def rate(self) -> float | None:
        """How often a second one comes; None: that cannot be told yet."""
        return self._arrivals.rate(self._clock())

    def reading(
        self, device: str, state: DeviceState = OK, facts: Mapping[str, Fact] = NOTHING
    ) -> Reading:
        """Return the reading for the diagnosis: stale before the first message, else `state`."""
        said: DeviceState = STALE if self.stamped is None else state
        return Reading(device, self.age, said, facts, self.rate)


async def awaited(
    future: asyncio.Future[Any],
    until: float,
    clock: Callable[[], float],
    goes_on: Callable[[], bool] = lambda: True,
) -> bool:
    """Wait for something until a time of a clock; say whether it was there by then.

    Args:
        future: the future to wait for.
        until: the latest time on the clock, in s.
        clock: gives the time, in s.
        goes_on: whether there is still a reason to wait.
    """
    while not future.done() and goes_on() and (left := until - clock()) > 0:
        await asyncio.wait({future}, timeout=min(left, LOOK_SECONDS))
    return future.done()
