"""Clock of a stepped bench: it advances when the robot requests the next step.

So nothing is late however busy the machine is, and a simulated hour takes only as long as computing
it. The bench answers a step after sending everything that was due in it.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tangy_hw.drivers.rosbridge import Rosbridge

SERVICE = "/bench/advance"
CONNECT_SECONDS = 10.0
ARRIVE_SECONDS = 1.0
"""Real time for messages on other connections to arrive."""


class SteppedClock:
    """A `Clock` driven by a bench."""

    def __init__(self) -> None:
        """Start at 0; call `follow` before time should pass."""
        self._now = 0.0
        self._link: Rosbridge | None = None
        self._counts: dict[str, Callable[[], int]] = {}
        self._sent: dict[str, int] = {}

    def follow(self, link: Rosbridge, counts: Mapping[str, Callable[[], int]]) -> None:
        """Follow the time of the bench at the other end of a link.

        Args:
            link: the link to the bench.
            counts: for each connection, returns how many of the messages that the bench counts have
                arrived.
        """
        self._link, self._counts = link, dict(counts)

    def now(self) -> float:
        """Return the bench's time in s."""
        return self._now

    async def sleep(self, seconds: float) -> None:
        """Advance the bench by a time in s, and wait for the resulting messages."""
        if self._link is None or not await self._link.wait_connected(CONNECT_SECONDS):
            await asyncio.sleep(seconds)
            return
        self._now += seconds  # messages of this step belong to its end
        had = {wire: count() for wire, count in self._counts.items()}
        told = await self._link.call(SERVICE, {"seconds": seconds})
        self._now = max(self._now, float(told["time"]))
        loop = asyncio.get_running_loop()
        until = loop.time() + ARRIVE_SECONDS
        for wire, sent in told.get("sent", {}).items():
            new = sent - self._sent.get(wire, sent)
            self._sent[wire] = sent
            count = self._counts.get(wire)
            wanted = had.get(wire, 0) + new
            while count is not None and count() < wanted and loop.time() < until:  # noqa: ASYNC110
                await asyncio.sleep(0.0005)
