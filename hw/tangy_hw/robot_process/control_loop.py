"""The control loop: at each tick the robot senses, decides and drives.

On a machine's clock ticks come by themselves. On a bench in a hurry they come only while somebody
waits for time to pass: what takes real time (a picture, a face) takes none of the robot's.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from contextlib import nullcontext

from tangy_hw.device_protocols import Clock, DeviceError

TICK = 0.05
"""Seconds between two ticks: a base wants a command ten times a second, and staleness is to stop
it within .35 s."""

HOPS = 3  # turns of the event loop from a socket to whoever waits for it

ON_THE_WAY, AT_REST = 0.1, 0.2
"""Seconds that a bench in a hurry steps at once while the robot drives (its scanner gives no more)
and while it stands: no data is stale yet."""


class ControlLoop:
    """The ticks of a robot: `run` lets them come, `until` waits for what comes about with them."""

    def __init__(self, clock: Clock, tick: Callable[[], bool], *, stepped: bool = False) -> None:
        """Prepare.

        Args:
            clock: the robot's time.
            tick: is called at each tick; it says whether the robot moves.
            stepped: time stands still while nobody waits for it.
        """
        self.clock = clock
        self._tick = tick
        self._stepped = stepped
        self.still = asyncio.Lock()
        """Whoever holds it sees no half of a step on a bench in a hurry."""
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
                come.exception()  # read here: everybody who waited may have given up by now
            raise

    async def _run(self) -> None:
        step = TICK
        while True:
            if self._stepped and not self.waiting:
                self._wanted.clear()
                await self._wanted.wait()
            async with self.still if self._stepped else nullcontext():
                await self.clock.sleep(step)
                for _ in range(HOPS):  # what has come is taken in before it is looked at
                    await asyncio.sleep(0)
            moves = self._tick()
            if self._stepped:
                step = ON_THE_WAY if moves else AT_REST
            come, self._next = self._next, None
            if come is not None:
                come.set_result(None)
            if self._stepped:  # whoever waited goes on, and may wait again, before time passes
                for _ in range(HOPS):
                    await asyncio.sleep(0)

    async def until(self, condition: Callable[[], bool], seconds: float) -> bool:
        """Let time pass until something holds; return whether it does, after at most so many s."""
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
        """Let so many s pass."""
        await self.until(lambda: False, seconds)
