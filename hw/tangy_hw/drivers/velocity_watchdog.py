"""Stops the base if the robot process hangs: a child process waits for the next velocity command.

A frozen robot process cannot stop anything. The child (`velocity_watchdog_child`) has its own
connection to the base, and stops it if no command follows a drive command within its time to live,
or if the robot process ends.
"""

from __future__ import annotations

import asyncio
import logging
import sys
from typing import Any

from tangy_hw.worker_process import WorkerError, WorkerProcess

_LOG = logging.getLogger(__name__)

CHILD = (sys.executable, "-P", "-m", "tangy_hw.drivers.velocity_watchdog_child")
AGAIN_SECONDS = 1.0  # until a dead process is restarted
END_SECONDS = 1.0


class VelocityWatchdog:
    """The robot process's side: it reports each velocity command to the child."""

    def __init__(
        self,
        url: str,
        *,
        ros: int = 1,
        drive: str = "/cmd_vel",
        stamped: bool = False,
        lives: float,
    ) -> None:
        """Describe the base; `start` starts the child.

        Args:
            url: its rosbridge server, ws://HOST:PORT.
            ros: 1 or 2: how types and times are spelled.
            drive: topic for velocity commands.
            stamped: whether the topic takes geometry_msgs/TwistStamped.
            lives: time to live of a command in s.
        """
        self.stopped = 0
        """How often it has stopped the base because no command came in time."""
        self._base = {"at": url, "ros": ros, "drive": drive, "stamped": stamped, "lives": lives}
        self._worker: WorkerProcess | None = None
        self._keeping: asyncio.Task[None] | None = None

    @property
    def pid(self) -> int | None:
        """Id of the child, if one runs."""
        return None if self._worker is None else self._worker.pid

    def start(self) -> None:
        """Start the child, and restart it if it ends."""
        if self._keeping is None:
            self._keeping = asyncio.create_task(self._keep(), name="velocity watchdog")

    async def close(self) -> None:
        """Let the child stop the base once more, and end it."""
        keeping, self._keeping = self._keeping, None
        if keeping is not None:
            keeping.cancel()
            await asyncio.wait({keeping})

    def note(self, *, drives: bool) -> None:
        """Report a command; only one that drives must be followed by another in time."""
        if self._worker is not None and drives:
            self._worker.beat({"drives": True})
        elif self._worker is not None:
            self._worker.tell({"drives": False})

    async def _keep(self) -> None:
        while True:
            try:
                worker = self._worker = WorkerProcess(
                    CHILD, hear=self._hear, stderr=None, loop=asyncio.get_running_loop()
                )
            except WorkerError as error:
                _LOG.warning("the velocity watchdog cannot be started: %s", error)
            else:
                worker.tell(self._base)
                try:
                    await asyncio.wait({asyncio.wrap_future(worker.over)})
                    _LOG.warning("the velocity watchdog has ended: %s", worker.how)
                finally:
                    self._worker = None
                    await worker.stopped(END_SECONDS)
            await asyncio.sleep(AGAIN_SECONDS)

    def _hear(self, said: dict[str, Any], _: bytes) -> None:
        match said:
            case {"stopped": float(late)}:
                self.stopped += 1
                _LOG.warning("the velocity watchdog stopped the base: no command for %.2f s", late)
            case {"failed": str(why)}:
                _LOG.warning("the velocity watchdog says: %s", why)
