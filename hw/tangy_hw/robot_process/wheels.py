"""Commands to a base, each of which goes its own way: none is carried out after a later stop.

All that drives a base from here goes through `Wheels.send`, and no faster than its limits.
"""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from contextlib import suppress
from functools import partial

from tangy_hw.device_protocols import STILL, Base, DeviceError, Twist
from tangy_hw.navigation.limits import MotionLimits


class Wheels:
    """Tells a base how to drive, without waiting for it."""

    def __init__(self, base: Base, limits: MotionLimits) -> None:
        """Take charge of a base that may drive so."""
        self.driven = STILL
        """What it was told last."""
        self._base, self._limits = base, limits
        self.sent: asyncio.Task[None] | None = None
        self._again = False

    @property
    def stand(self) -> bool:
        """Whether it was told to stand, and after a stop once more."""
        return self.driven == STILL and not self._again

    def send(self, command: Twist) -> None:
        """Tell the base; a command that could not be handed over is followed by the next.

        One that is faster than the base may drive is carried out on the same arc, as fast as it
        may; one that is no number stands still.
        """
        command = self._limits.clamped(command)
        halting = command == STILL and self.driven != STILL
        if halting:
            self._call_off()
        elif self.sent is not None and not self.sent.done():
            return
        self.driven = command
        if command == STILL:
            self._again = False
        base = self._base
        work = base.stop if command == STILL else partial(base.drive, command)
        self.sent = asyncio.create_task(_quietly(work))

    async def stop(self) -> None:
        """Stop the base now; commands not yet handed over are dropped."""
        self._call_off()
        self.driven, self._again = STILL, True
        await self._base.stop()

    def _call_off(self) -> None:
        if self.sent is not None:
            self.sent.cancel()


async def _quietly(work: Callable[[], Awaitable[None]]) -> None:
    with suppress(DeviceError):  # its reading tells
        await work()
