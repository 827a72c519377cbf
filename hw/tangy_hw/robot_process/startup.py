"""Switches the robot on in its process, and aborts as soon as the program cancels this.

The program cancels by closing the pipe, by SIGTERM, or by exiting.
"""

from __future__ import annotations

import asyncio
import signal
from collections.abc import AsyncIterator
from contextlib import AsyncExitStack, asynccontextmanager, suppress

from tangy_hw.robot_process.assembly import RobotRuntime
from tangy_profiles.worker_lines import LineError, next_line

GIVE_UP_SECONDS = 1.0
"""Time for an aborted start-up to release devices; then the process exits anyway."""
BEAT = b'{"beat"'


@asynccontextmanager
async def switched_on(
    wired: RobotRuntime, lines: asyncio.StreamReader
) -> AsyncIterator[list[bytes] | None]:
    """Switch a robot on, unless the program cancels this, and off again.

    Args:
        wired: the robot.
        lines: input from the program, read during the start-up.

    Yields:
        The lines received meanwhile, without heartbeats; None if cancelled, with nothing switched
        on.

    Raises:
        TangyError: a device cannot be switched on.
    """
    said: list[bytes] = []
    opening = asyncio.ensure_future(wired.__aenter__())
    listening = asyncio.create_task(_until_the_end(lines, said))
    await asyncio.wait({opening, listening}, return_when=asyncio.FIRST_COMPLETED)
    if listening.done():
        await _give_up(opening)
        yield None
        return
    listening.cancel()
    await asyncio.wait({listening})
    async with AsyncExitStack() as opened:
        opened.push_async_exit(opening.result())
        yield said


async def _until_the_end(lines: asyncio.StreamReader, said: list[bytes]) -> None:
    """Collect lines of the program until its input closes."""
    line = b"\n"
    while line:
        with suppress(LineError):  # the line is too long
            line = await next_line(lines)
            if line and not line.startswith(BEAT):
                said.append(line)


async def _give_up(opening: asyncio.Future[RobotRuntime]) -> None:
    """Release everything that is open, without waiting for devices and threads that hang."""
    signal.setitimer(signal.ITIMER_REAL, GIVE_UP_SECONDS)  # SIGALRM ends the process
    opening.cancel()
    with suppress(asyncio.CancelledError, Exception):
        async with AsyncExitStack() as opened:
            opened.push_async_exit(await opening)
