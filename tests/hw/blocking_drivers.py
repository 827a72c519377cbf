"""Tries a robot in its own process, as doctor does, with a driver that blocks in one of its steps.

Run as `python blocking_drivers.py STEP`.
"""

from __future__ import annotations

import asyncio
import os
import sys
import threading
from collections.abc import Mapping

from tangy_hw.drivers import registry
from tangy_hw.drivers.registry import DriverKind, DriverSettings, Wiring
from tangy_hw.robot_process import isolated_test
from tangy_profiles.health import Reading


class Works:
    """A battery, or arms, of another package."""

    def __init__(self, name: str) -> None:
        self.name = name

    async def start(self) -> None: ...

    async def close(self) -> None: ...

    def reading(self) -> Reading:
        return Reading(self.name, facts={"charge": 0.5, "charging": True})


class Blocks(Works):
    """One that blocks in a step of its process, or ends it."""

    def __init__(self, name: str, step: str) -> None:
        super().__init__(name)
        self._step = step
        self._at("open")

    def _at(self, step: str) -> None:
        if step == self._step:
            threading.Event().wait()

    async def start(self) -> None:
        self._at("start")
        if self._step == "thread":  # it may block a thread that the loop waits for at its end
            asyncio.get_running_loop().run_in_executor(None, threading.Event().wait)
        if self._step == "exit":
            os._exit(7)

    async def close(self) -> None:
        self._at("close")

    def reading(self) -> Reading:
        self._at("read")
        return super().reading()


def main() -> None:
    """Try the robot, whose drivers are the two above."""

    def blocks(_: Wiring, settings: DriverSettings) -> Works:
        return Blocks(settings.device, sys.argv[1])

    def works(_: Wiring, settings: DriverSettings) -> Works:
        return Works(settings.device)

    kinds: Mapping[str, DriverKind] = {
        "blocks": DriverKind(("gripper",), blocks),
        "works": DriverKind(("battery",), works),
    }
    registry.DRIVERS = kinds
    isolated_test.main()


if __name__ == "__main__":
    main()
