"""Switching the robot on in its process, and giving that up as soon as the program does.

The program gives it up by closing the pipe, by SIGTERM, or by ending.
"""

from __future__ import annotations

import asyncio
import signal
from collections.abc import AsyncIterator
from contextlib import AsyncExitStack, asynccontextmanager, suppress

from tangy_hw.robot_process.assembly import RobotRuntime
from tangy_profiles.worker_lines import LineError, next_line

GIVE_UP_SECONDS = 1.0
"""In which a robot that was not switched on yet is let go of; then the process ends anyway."""
BEAT = b'{"beat"'


@asynccontextmanager
async def switched_on(
    wired: RobotRuntime, lines: asyncio.StreamReader
) -> AsyncIterator[list[bytes] | None]:
    """Switch a robot on, unless the program gives it up before that, and off again.

    Args:
        wired: the robot.
        lines: what the program says; it is read while the robot is being switched on.

    Yields:
        What the program said meanwhile, but for its beats; None where it gave up, with nothing on.

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
    """Take what the program says, until it says no more."""
    line = b"\n"
    while line:
        with suppress(LineError):  # it is too long
            line = await next_line(lines)
            if line and not line.startswith(BEAT):
                said.append(line)


async def _give_up(opening: asyncio.Future[RobotRuntime]) -> None:
    """Let go of all that is open; devices and threads that do not answer are not waited for."""
    signal.setitimer(signal.ITIMER_REAL, GIVE_UP_SECONDS)  # which ends a process
    opening.cancel()
    with suppress(asyncio.CancelledError, Exception):
        async with AsyncExitStack() as opened:
            opened.push_async_exit(await opening)
