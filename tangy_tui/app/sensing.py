"""What a robot's devices report, see and read, requested from the robot process for a screen."""

from __future__ import annotations

import asyncio
import base64
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import replace
from typing import Any

from tangy_hw.device_protocols import DeviceError
from tangy_hw.drivers.camera import Frame
from tangy_hw.drivers.camera_state import Sight
from tangy_hw.perception.camera_hub import CARDS, CardSight, SeenCard
from tangy_hw.robot_client.client import RobotLink
from tangy_hw.robot_process.requests import Request
from tangy_profiles.cards import Deck
from tangy_profiles.health import Health
from tangy_profiles.robot import Robot

LOOK_SECONDS = 0.4  # between two requests for the state of the cameras
ANSWER_SECONDS = 2.5  # timeout of a request, including the wait for a new picture
AGAIN_SECONDS = 0.5  # delay after a request without an answer
OWN = ("link", "localisation", "navigator")
"""Parts that the robot process reports itself, without a driver."""
OWN_SOURCE = "the robot process"
PAGE = "page"  # the kind of driver whose address is known once it is open


class LinkedSensors:
    """The devices of a robot, read through its process; satisfies `text.sensors.Sensing`.

    Within `async with` it polls the state of the cameras. It shows the card that the game read
    last, and triggers no reading of its own.
    """

    def __init__(self, link: RobotLink, robot: Robot, deck: Deck) -> None:
        """Prepare the polling.

        Args:
            link: the link to the robot process.
            robot: its profile.
            deck: the deck of the cards to read.
        """
        self._link = link
        self._deck = deck
        setup = link.setup
        drivers = {name: dict(driver) for name, driver in setup.drivers.items()}
        self._drivers: dict[str, dict[str, Any]] = {
            **{name: {"kind": own.kind, **own.settings} for name, own in robot.drivers.items()},
            **drivers,
        }
        self.cameras = tuple(
            device.name
            for device in robot.devices.values()
            if device.name in setup.cameras or device.source
        )
        looking = (name for name in self.cameras if robot.devices[name].looks_at == CARDS)
        self.card_device = next(looking, "")
        self._there = {*OWN, *self._drivers, *self.cameras, *(["requests"] * bool(setup.requests))}
        self._sights: dict[str, tuple[str, Sight, float]] = {}
        self._cards = CardSight()
        self._asking: asyncio.Task[None] | None = None
        self._pid: int | None = None

    async def __aenter__(self) -> LinkedSensors:
        if self._asking is None:
            self._asking = asyncio.create_task(self._follow())
        return self

    async def __aexit__(self, *_: object) -> None:
        asking, self._asking = self._asking, None
        if asking is not None:
            asking.cancel()
            await asyncio.wait([asking])

    def health(self) -> Health:
        """Return the newest reading of each device that the robot has."""
        return tuple(one for one in self._link.health() if one.device in self._there)

    @property
    def cards(self) -> CardSight:
        """The card that the robot read last."""
        return self._cards

    @contextmanager
    def reading_cards(self) -> Iterator[None]:
        """Do nothing: only the game reads cards."""
        yield

    def source(self, device: str) -> str:
        """Return the source of a device's data: of pictures, or a driver."""
        if device in self._sights:
            return self._sights[device][0]
        if device == "requests":
            return self._link.setup.requests
        if device not in self._drivers:
            return OWN_SOURCE
        driver = self._drivers[device]
        kind = str(driver["kind"])
        if kind == PAGE and self._link.screen:
            return f"{self._link.screen}, code {self._link.code}"
        return f"{kind} {driver.get('at', '')}".rstrip()

    def sight(self, device: str) -> Sight:
        """Return the last known state of a camera, with the present age of its picture."""
        now, silent = time.monotonic(), self._link.silent
        found = self._sights.get(device)
        if found is None:
            why = f"Nothing is known of it: {silent}." if silent else "It is being asked."
            return Sight("DISCONNECTED" if silent else "OPENING", why, 0, 0, 0, None, None, None)
        _, sight, told = found
        since = now - told
        sight = replace(sight, age=sight.age + since, seconds=sight.seconds + since)
        if silent:
            return replace(
                sight, state="DISCONNECTED", why=f"No picture comes: {silent}.", seconds=since
            )
        return sight

    async def picture(self, device: str, fit: tuple[int, int], *, after: int = -1) -> Frame | None:
        """Return a camera's picture, scaled to fit; None if there is none newer than `after`."""
        if self._link.pid != self._pid:  # another process numbers its pictures from 0
            self._pid, after = self._link.pid, -1
        told = await self._ask("picture", device=device, fit=list(fit), after=after)
        if told is None or "pixels" not in told:
            return None
        width, height = told["size"]
        pixels = base64.b64decode(told["pixels"])
        return Frame(told["seq"], time.monotonic(), width, height, pixels, self.sight(device))

    async def _follow(self) -> None:
        """Poll the state of the cameras."""
        while True:
            told = await self._ask("sights")
            if told is not None:
                self._take(told, time.monotonic())
            await asyncio.sleep(LOOK_SECONDS)

    async def _ask(self, do: Request, **what: Any) -> dict[str, Any] | None:
        """Send a request to the robot process; None if it does not answer."""
        if not self._link.silent:  # or requests would pile up for a process that hangs
            answer = asyncio.wrap_future(self._link.ask(do, **what))
            answer.add_done_callback(_heard)
            with suppress(DeviceError, TimeoutError):
                async with asyncio.timeout(ANSWER_SECONDS):
                    # The caller may be cancelled; cancelling the answer would break the link.
                    return await asyncio.shield(answer)
        await asyncio.sleep(AGAIN_SECONDS)
        return None

    def _take(self, told: dict[str, Any], now: float) -> None:
        self._sights = {
            name: (source, Sight(*sight), now) for name, (source, *sight) in told["sights"].items()
        }
        looked, read = told["looked"], told["read"]
        if looked is None:
            return
        last = None
        if read is not None:
            last = SeenCard.of(
                self._deck,
                read["card"],
                read["marked"],
                read["hidden"],
                now - read["age"],
                self._link.setup.deck_seed,
            )
        problem = "" if looked["card"] is not None else looked["problem"]
        self._cards = CardSight(last, problem, now - looked["age"])


def _heard(answer: asyncio.Future[dict[str, Any]]) -> None:
    """Retrieve the exception of an answer that nobody may await any more."""
    if not answer.cancelled():
        answer.exception()
