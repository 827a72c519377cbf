"""The time of a stepped bench: it advances when the robot asks for the next step.

So nothing is late however busy the machine is, and an hour is over when all of it has been
computed. The bench answers a step when all that was due in it has been sent.
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
"""Of real time, for what was sent on other wires than the answer to arrive."""


class SteppedClock:
    """A `Clock` that a bench keeps."""

    def __init__(self) -> None:
        """Begin at 0; `follow` a bench before time is to pass."""
        self._now = 0.0
        self._link: Rosbridge | None = None
        self._counts: dict[str, Callable[[], int]] = {}
        self._sent: dict[str, int] = {}

    def follow(self, link: Rosbridge, counts: Mapping[str, Callable[[], int]]) -> None:
        """Keep the time of the bench at the other end of a link.

        Args:
            link: the bench.
            counts: by wire, how many of what the bench counts there has arrived.
        """
        self._link, self._counts = link, dict(counts)

    def now(self) -> float:
        """Return the bench's time in s."""
        return self._now

    async def sleep(self, seconds: float) -> None:
        """Let so many s of the bench's time pass, and wait for what they bring."""
        if self._link is None or not await self._link.wait_connected(CONNECT_SECONDS):
            await asyncio.sleep(seconds)
            return
        self._now += seconds  # what comes in this step is of its end
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
