"""Sends commands to a base without blocking; no command overtakes a later stop.

Every command to the base passes `Wheels.send`, which applies the motion limits.
"""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from contextlib import suppress
from functools import partial

from tangy_hw.device_protocols import STILL, Base, DeviceError, Twist
from tangy_hw.navigation.limits import MotionLimits
from tangy_hw.robot_process.tick_watchdog import time_awake_and_asleep

OLD_SECONDS = 0.3
"""The age of a command that is not carried out any more; the next tick decides anew."""


class Wheels:
    """Sends velocity commands to a base without waiting for it."""

    def __init__(
        self,
        base: Base,
        limits: MotionLimits,
        clock: Callable[[], float] = time_awake_and_asleep,
    ) -> None:
        """Set the base, its limits, and a clock in s that goes on while the process is frozen."""
        self.driven = STILL
        """Last command."""
        self._base, self._limits, self._clock = base, limits, clock
        self.sent: asyncio.Task[None] | None = None
        self._again = False

    @property
    def stand(self) -> bool:
        """Whether the last command was to stop, repeated once after a `stop`."""
        return self.driven == STILL and not self._again

    def send(self, command: Twist) -> None:
        """Send a command; one that could not be sent is followed by the next.

        A command above the limits is scaled down on the same arc; one that is not finite stops the
        base.
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
        work = self._base.stop if command == STILL else partial(self._drive, command, self._clock())
        self.sent = asyncio.create_task(_quietly(work))

    async def _drive(self, command: Twist, decided: float) -> None:
        """Drive, unless the process was frozen since the command was decided."""
        if self._clock() - decided < OLD_SECONDS:
            await self._base.drive(command)

    async def stop(self) -> None:
        """Stop the base now; pending commands are dropped."""
        self._call_off()
        self.driven, self._again = STILL, True
        await self._base.stop()

    def _call_off(self) -> None:
        if self.sent is not None:
            self.sent.cancel()


async def _quietly(work: Callable[[], Awaitable[None]]) -> None:
    with suppress(DeviceError):  # its reading reports the error
        await work()
