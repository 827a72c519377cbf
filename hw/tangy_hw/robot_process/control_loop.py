"""The control loop: at each tick the robot senses, decides and drives.

In real time, ticks come at a fixed rate. On a stepped bench, they come only while a caller waits
for time to pass, so that work in real time (an image, a face) takes no robot time.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from contextlib import nullcontext

from tangy_hw.device_protocols import Clock, DeviceError

TICK = 0.05
"""Seconds between two ticks: a base needs ten commands a second, and stale data must stop it within
.35 s."""

HOPS = 3  # event loop iterations from a socket to a waiting callback

ON_THE_WAY, AT_REST = 0.1, 0.2
"""Step sizes in s on a stepped bench: while the robot drives (the scanner's period), and at rest.
No data goes stale within them."""


class ControlLoop:
    """Ticks of a robot: `run` produces them, `until` waits for a condition."""

    def __init__(self, clock: Clock, tick: Callable[[], bool], *, stepped: bool = False) -> None:
        """Prepare the loop.

        Args:
            clock: the robot's clock.
            tick: called at each tick; returns whether the robot moves.
            stepped: whether time stands still while no caller waits.
        """
        self.clock = clock
        self._tick = tick
        self._stepped = stepped
        self.still = asyncio.Lock()
        """Held during a step of a stepped bench; its holder sees no partial step."""
        self.waiting = 0
        self._failed: BaseException | None = None
        self._wanted = asyncio.Event()
        self._next: asyncio.Future[None] | None = None

    async def run(self) -> None:
        """Tick until cancelled; any other end raises in all waiters."""
        try:
            await self._run()
        except BaseException as error:
            self._failed = error
            come, self._next = self._next, None
            if come is not None and not come.done():
                come.set_exception(DeviceError(f"The robot's time stands still ({error!r})."))
                come.exception()  # mark as retrieved: all waiters may have given up
            raise

    async def _run(self) -> None:
        step = TICK
        while True:
            if self._stepped and not self.waiting:
                self._wanted.clear()
                await self._wanted.wait()
            async with self.still if self._stepped else nullcontext():
                await self.clock.sleep(step)
                for _ in range(HOPS):  # process arrived messages first
                    await asyncio.sleep(0)
            moves = self._tick()
            if self._stepped:
                step = ON_THE_WAY if moves else AT_REST
            come, self._next = self._next, None
            if come is not None:
                come.set_result(None)
            if self._stepped:  # let waiters go on, and perhaps wait again, before time passes
                for _ in range(HOPS):
                    await asyncio.sleep(0)

    async def until(self, condition: Callable[[], bool], seconds: float) -> bool:
        """Let time pass until a condition holds, with a timeout in s; return whether it does.

        Raises:
            DeviceError: the robot's time stands still, because the control loop failed.
        """
        if self._failed is not None:
            raise DeviceError(f"The robot's time stands still ({self._failed!r}).")
        deadline = self.clock.now() + seconds
        self.waiting += 1
        self._wanted.set()
        try:
            while not condition():
                if self.clock.now() >= deadline:
                    return False
                if self._next is None:
                    self._next = asyncio.get_running_loop().create_future()
                await asyncio.shield(self._next)
            return True
        finally:
            self.waiting -= 1

    async def sleep(self, seconds: float) -> None:
        """Let a time in s pass."""
        await self.until(lambda: False, seconds)
