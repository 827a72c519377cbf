"""Bodies of live robots for tests: devices that record their commands, and a body of them."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from tangy_hw.device_protocols import (
    DeviceError,
    Odometry,
    Picture,
    Pose,
    Scan,
    Stamped,
    Twist,
)
from tangy_hw.robot_process.body import Body
from tangy_profiles.health import OK, DeviceState, Reading

HERE = Pose(2.0, 1.0, 0.0)


class ToldDevice:
    """A healthy device, or one with a given fault; `told` are the commands of the whole body."""

    def __init__(self, name: str, told: list[Any]) -> None:
        self.name, self.told = name, told
        self.state: DeviceState = OK
        self.age = 0.0
        self.facts: dict[str, Any] = {}

    async def start(self) -> None:
        """Begin."""

    async def close(self) -> None:
        """End."""

    def reading(self) -> Reading:
        return Reading(self.name, self.age, self.state, self.facts)


def _newest(value: Stamped[Any]) -> Stamped[Any]:
    """Return a value as one that has just come; one with a stamp keeps it."""
    return value if value.stamp else replace(value, stamp=time.monotonic())


class ToldBase(ToldDevice):
    """Wheels that stay in place despite commands."""

    sent = Stamped(Odometry(HERE, Twist()), 0.0, 1)

    @property
    def odometry(self) -> Stamped[Odometry]:
        return _newest(self.sent)

    @odometry.setter
    def odometry(self, value: Stamped[Odometry]) -> None:
        self.sent = value

    async def drive(self, twist: Twist) -> None:
        self.told.append(twist)

    async def stop(self) -> None:
        self.told.append("stop")


class ToldLaser(ToldDevice):
    """A scanner without a return within its range."""

    sent = Stamped(Scan(-1.5, 0.1, np.full(31, np.inf), 30.0), 0.0, 1)

    @property
    def scan(self) -> Stamped[Scan]:
        return _newest(self.sent)

    @scan.setter
    def scan(self, value: Stamped[Scan]) -> None:
        self.sent = value


class ToldArms(ToldDevice):
    """Arms whose movements last until `hold`."""

    def __init__(self, name: str, told: list[Any]) -> None:
        super().__init__(name, told)
        self.held = asyncio.Event()
        self.breaks = False

    async def pose(self, angles: Mapping[str, Sequence[float]], seconds: float) -> None:
        self.told.append("pose")
        await self.held.wait()
        raise DeviceError("It was told to hold.")

    async def hold(self) -> None:
        self.told.append("hold")
        self.held.set()
        if self.breaks:
            raise OSError("The bus is gone.")

    async def relax(self) -> None:
        self.told.append("relax")


class ToldVoice(ToldDevice):
    """A voice that speaks until it is hushed, or cannot even be hushed."""

    def __init__(self, name: str, told: list[Any]) -> None:
        super().__init__(name, told)
        self.hushed = asyncio.Event()
        self.hangs = self.breaks = False

    async def say(self, text: str) -> None:
        self.told.append("say")
        await self.hushed.wait()

    async def play(self, sound: Path) -> None:
        self.told.append(f"play {sound.name}")

    async def hush(self) -> None:
        self.told.append("hush")
        if self.breaks:
            raise RuntimeError("no voice")
        if self.hangs:
            await asyncio.sleep(60)
        self.hushed.set()


class ToldScreen(ToldDevice):
    async def show(self, picture: Picture) -> None:
        self.told.append("show")


class ToldBody:
    """A whole body, and `told`, the commands to its devices in order."""

    def __init__(self) -> None:
        self.told: list[Any] = []
        self.base = ToldBase("base", self.told)
        self.laser = ToldLaser("laser", self.told)
        self.arms = ToldArms("arms", self.told)
        self.voice = ToldVoice("voice", self.told)
        self.screen = ToldScreen("screen", self.told)

    def body(self, *others: Any) -> Body:
        return Body(
            self.base,
            self.laser,
            arms=self.arms,
            voice=self.voice,
            screen=self.screen,
            others=others,
        )
