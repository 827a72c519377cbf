"""Process that stops the base if the robot process hangs or ends.

Run as `python -m tangy_hw.drivers.velocity_watchdog_child`; speaks JSON lines:

    {"at": "ws://HOST:9090", "ros": 1, "drive": "/cmd_vel", "stamped": false, "lives": 0.2}
                               the base, and a command's time to live in s; once
    {"drives": true}           the base was commanded to drive; false: to stop
    {"stopped": 0.21}          it stopped the base; s since the last command
    {"failed": "..."}          an invalid line was ignored

When its input closes, it stops the base and exits.
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

_LOG = logging.getLogger("tangy_hw.drivers.velocity_watchdog_child")  # also if run as a script

LAST_SECONDS = 0.7  # at the end, to wait for a connection


class Watchdog:
    """Stops the base if no command follows a drive command in time."""

    def __init__(self, say: Callable[[Asked], None]) -> None:
        """Start without a base."""
        self._say = say
        self._bridge: Rosbridge | None = None
        self._topic: VelocityTopic | None = None
        self._lives = 0.0
        self._driven = 0.0  # time of the last drive command (monotonic, s)
        self._due: asyncio.TimerHandle | None = None
        self._stands = True  # whether to stop the base at a new connection

    async def take(self, told: Asked) -> None:
        """Handle the description of the base, or a command to it.

        Raises:
            LineError: the line is neither.
            DeviceError: the address is invalid.
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
        """Stop the base, and close the connection."""
        if self._bridge is None:
            return
        if self._due is not None:  # the base drives: wait for a connection
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
            with suppress(DeviceError):  # it is sent again at a new connection
                self._topic.say(STILL)


async def run() -> None:
    """Watch until the input closes."""
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
    """Run the process."""
    log_to_stderr()
    _LOG.info("watches the velocity commands")
    with suppress(KeyboardInterrupt):
        asyncio.run(run())


if __name__ == "__main__":
    main()
