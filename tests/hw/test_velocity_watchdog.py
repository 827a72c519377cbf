"""The velocity watchdog: a separate process stops the base if the robot process hangs or ends."""

from __future__ import annotations

import asyncio
import os
import signal
import sys
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress
from typing import Any

import pytest

from tangy_hw.device_protocols import DeviceError, Twist
from tangy_hw.drivers.ros_base import RosBase
from tangy_hw.drivers.rosbridge import Rosbridge
from tangy_hw.drivers.velocity_watchdog import VelocityWatchdog
from tangy_hw.drivers.velocity_watchdog_child import Watchdog
from tangy_profiles.worker_lines import LineError
from tangy_sim.servers.rosbridge_server import RosbridgeServer
from tests.support.waiting import until

DRIVES = """
import asyncio, sys
from tangy_hw.device_protocols import Twist
from tangy_hw.drivers.ros_base import RosBase
from tangy_hw.drivers.rosbridge import Rosbridge
from tangy_hw.drivers.velocity_watchdog import VelocityWatchdog

async def drive():
    bridge = Rosbridge(sys.argv[1])
    watchdog = VelocityWatchdog(sys.argv[1], lives=0.2)
    base = RosBase(bridge, watchdog=watchdog)
    await base.start()
    await bridge.wait_connected(5)
    for _ in range(100_000):
        await base.drive(Twist(0.3, 0.0))
        await asyncio.sleep(0.05)

asyncio.run(drive())
"""


@asynccontextmanager
async def listening() -> AsyncIterator[tuple[RosbridgeServer, list[float]]]:
    """Open a base that records its commanded speeds, in m/s."""
    server, told = RosbridgeServer(), list[float]()
    server.on_message("/cmd_vel", lambda message: told.append(message["linear"]["x"]))
    await server.start()
    try:
        yield server, told
    finally:
        await server.close()


@asynccontextmanager
async def watched(
    server: RosbridgeServer, lives: float
) -> AsyncIterator[tuple[Watchdog, list[Any]]]:
    """Start a watchdog for a base; return it and its reports."""
    said: list[Any] = []
    watchdog = Watchdog(said.append)
    base = {"at": server.url, "ros": 1, "drive": "/cmd_vel", "stamped": False, "lives": lives}
    await watchdog.take(base)
    try:
        yield watchdog, said
    finally:
        await watchdog.close()


async def test_a_drive_command_without_a_successor_is_followed_by_a_stop(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    loop, waits = asyncio.get_running_loop(), list[float]()
    later = loop.call_later

    def call_later(seconds: float, call: Any, *given: Any, **context: Any) -> asyncio.TimerHandle:
        waits.append(seconds)
        return later(seconds, call, *given, **context)

    async with listening() as (server, told), watched(server, 0.05) as (watchdog, said):
        await until(lambda: told == [0.0])  # a new connection
        with monkeypatch.context() as patched:
            patched.setattr(loop, "call_later", call_later)
            await watchdog.take({"drives": True})
        assert waits == [0.05]
        await until(lambda: told == [0.0, 0.0])
        assert [list(one) for one in said] == [["stopped"]]
        assert said[0]["stopped"] >= 0.05


async def test_a_stop_command_needs_no_successor() -> None:
    async with listening() as (server, told), watched(server, 0.05) as (watchdog, said):
        await until(lambda: told == [0.0])
        await watchdog.take({"drives": True})
        await watchdog.take({"drives": False})
        loop = asyncio.get_running_loop()
        passed = loop.create_future()
        loop.call_later(0.15, passed.set_result, None)
        await passed
        assert (told, said) == ([0.0], [])


async def test_the_watchdog_stops_the_base_when_it_ends() -> None:
    async with listening() as (server, told):
        async with watched(server, 60.0) as (watchdog, said):
            await until(lambda: told == [0.0])
            await watchdog.take({"drives": True})
        await until(lambda: told == [0.0, 0.0])
        assert said == []


async def test_the_watchdog_stops_a_base_that_reconnects() -> None:
    async with listening() as (server, told), watched(server, 0.05) as (watchdog, said):
        await until(lambda: told == [0.0])
        await watchdog.take({"drives": True})
        await until(lambda: told == [0.0, 0.0] and bool(said))
        server.drop()
        await until(lambda: told == [0.0, 0.0, 0.0])


async def test_an_invalid_line_is_refused() -> None:
    with pytest.raises(LineError):
        await Watchdog(list[Any]().append).take({"drives": True})


class Noting(VelocityWatchdog):
    """A watchdog without a child; it records the robot process's reports."""

    def __init__(self, url: str) -> None:
        super().__init__(url, lives=0.2)
        self.noted: list[bool] = []

    def start(self) -> None:
        """Start nothing."""

    def note(self, *, drives: bool) -> None:
        """Record whether a command drives."""
        self.noted.append(drives)


async def test_a_command_lost_with_the_link_does_not_reset_the_watchdog() -> None:
    async with listening() as (server, told):
        bridge, watchdog = Rosbridge(server.url), Noting(server.url)
        base = RosBase(bridge, watchdog=watchdog)
        await base.start()
        await bridge.wait_connected(5)
        await base.drive(Twist(0.3, 0.0))
        await until(lambda: bool(told) and told[-1] == 0.3)
        before = list(watchdog.noted)
        await server.close()
        await until(lambda: not bridge.connected)
        await base.stop()
        with pytest.raises(DeviceError):
            await base.drive(Twist(0.3, 0.0))
        assert (before[-1], watchdog.noted) == (True, before)
        await base.close()
        await bridge.close()


@pytest.mark.slow
@pytest.mark.parametrize("how", [signal.SIGSTOP, signal.SIGKILL])
async def test_a_frozen_or_killed_robot_process_stops_the_base(
    how: signal.Signals,
) -> None:
    async with listening() as (server, told):
        process = await asyncio.create_subprocess_exec(sys.executable, "-c", DRIVES, server.url)
        try:
            await until(lambda: told[-5:] == [0.3] * 5, 30)
            os.kill(process.pid, how)
            await until(lambda: told[-1] == 0.0, 10)
        finally:
            with suppress(ProcessLookupError):  # it was killed already
                process.kill()
            await process.wait()
