"""The process that stops a base whose robot process hangs or ends.

Run as `python -m tangy_hw.drivers.velocity_watchdog_child`, spoken to by JSON, one object a line:

    {"at": "ws://HOST:9090", "ros": 1, "drive": "/cmd_vel", "stamped": false, "lives": 0.2}
                               the base, and a command's time to live in s; comes once
    {"drives": true}           the base was told to drive; false: to stand
    {"stopped": 0.21}          it told the base to stand, so many s after the last command
    {"failed": "..."}          a line cannot be heeded, and nothing comes of it

It ends when its input closes, and tells the base to stand before it does.
"""

from __future__ import annotations

import asyncio
import logging
import time
from collections.abc import Callable
from contextlib import suppress

from tangy_hw.device_protocols import STILL, DeviceError
from tangy_hw.drivers.ros_velocity import VelocityTopic
from tangy_hw.drivers.rosbridge import Rosbridge
from tangy_profiles.process_log import log_to_stderr
from tangy_profiles.worker_lines import AnswerWriter, Asked, LineError, coming, open_lines

_LOG = logging.getLogger("tangy_hw.drivers.velocity_watchdog_child")  # also run as a process

LAST_SECONDS = 0.7  # at the end, in which a connection may come


class Watchdog:
    """Stops a base if a command to drive is not followed by another one in time."""

    def __init__(self, say: Callable[[Asked], None]) -> None:
        """Begin without a base."""
        self._say = say
        self._bridge: Rosbridge | None = None
        self._topic: VelocityTopic | None = None
        self._lives = 0.0
        self._driven = 0.0  # when the base was told to drive last (monotonic, s)
        self._due: asyncio.TimerHandle | None = None
        self._stands = True  # whether it has to, should the connection come back

    async def take(self, told: Asked) -> None:
        """Take the base, or that it was told to drive or to stand.

        Raises:
            LineError: it is neither.
            DeviceError: the address is none.
        """
        match told:
            case {
                "at": str(at),
                "ros": int(ros),
                "drive": str(drive),
                "stamped": bool(stamped),
                "lives": float(lives),
            } if self._bridge is None:
                self._bridge, self._lives = Rosbridge(at, ros=ros), lives
                self._topic = VelocityTopic(self._bridge, drive, stamped=stamped)
                self._bridge.on_connect(self._connected)
                await self._bridge.start()
                self._topic.advertise()
            case {"drives": bool(drives)} if self._topic is not None:
                self._stands = False
                if self._due is not None:
                    self._due.cancel()
                    self._due = None
                if drives:
                    self._driven = time.monotonic()
                    loop = asyncio.get_running_loop()
                    self._due = loop.call_later(self._lives, self._expire)
            case _:
                raise LineError("A line must describe the base, once, or say whether it drives.")

    async def close(self) -> None:
        """Tell the base to stand, and end."""
        if self._bridge is None:
            return
        if self._due is not None:  # it drives: a connection that is not there yet is worth waiting
            self._due.cancel()
            self._stands = True
            await self._bridge.wait_connected(LAST_SECONDS)
        self._stand()
        await self._bridge.close()

    def _expire(self) -> None:
        self._stand()
        self._due, self._stands = None, True
        self._say({"stopped": round(time.monotonic() - self._driven, 3)})

    def _connected(self) -> None:
        if self._stands:
            self._stand()

    def _stand(self) -> None:
        if self._topic is not None:
            with suppress(DeviceError):  # it is said again when there is a connection
                self._topic.say(STILL)


async def run() -> None:
    """Watch until there is nothing more to hear."""
    answers = AnswerWriter()
    lines, _ = await open_lines()
    watchdog = Watchdog(answers.write)
    async for told in coming(answers.refuse, lines):
        try:
            await watchdog.take(told)
        except (LineError, DeviceError) as error:
            answers.refuse(str(error))
    await watchdog.close()


def main() -> None:
    """Run it."""
    log_to_stderr()
    _LOG.info("watches the velocity commands")
    with suppress(KeyboardInterrupt):
        asyncio.run(run())


if __name__ == "__main__":
    main()
