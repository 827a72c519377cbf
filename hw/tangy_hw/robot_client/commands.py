"""What the world tells the robot to do, one thing after another, broken off where it must be."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from typing import Any

from tangy_hw.device_protocols import DeviceError, Picture
from tangy_hw.robot_client.client import RobotLink
from tangy_hw.robot_process.requests import Request
from tangy_hw.robot_process.stop_latch import Preempted
from tangy_profiles.health import Health

BREAK_SECONDS = 20.0  # of real time, after which what was called off is taken to be over

Diagnosed = Callable[[Health], Mapping[str, bool]]
"""Says which faults devices show, by code, and whether each is critical."""


class Commands:
    """Gives a robot commands and waits for each of them."""

    def __init__(self, link: RobotLink) -> None:
        self.link = link
        self.diagnosed: Diagnosed = _nothing
        self._heedless: frozenset[str] = frozenset()

    def do(self, do: Request, **what: Any) -> dict[str, Any]:
        """Carry out a command; a critical reading of a device breaks it off.

        Raises:
            BrokenOff: it was, or the robot had to stand still.
            DeviceError: it could not be done.
        """
        asked = self.link.ask(do, **what)
        broken, until = "", 0.0
        while not self.link.wait(asked):
            if silent := self.link.silent:
                raise Preempted(silent)
            if broken and time.monotonic() > until:
                raise Preempted(broken)
            if not broken and (broken := self._critical()):
                until = time.monotonic() + BREAK_SECONDS
                self.link.ask("cancel", why=broken)
        return asked.result()

    @contextmanager
    def heedless(self, *codes: str) -> Iterator[None]:
        """Break nothing off for faults of these codes, as long as somebody is in it."""
        before, self._heedless = self._heedless, self._heedless | set(codes)
        try:
            yield
        finally:
            self._heedless = before

    def perform(
        self,
        text: str,
        picture: Picture,
        posture: Mapping[str, Sequence[float]] | None = None,
        sound: str = "",
    ) -> dict[str, Any]:
        """Let the robot say, show, gesture (joints in rad), then play a WAV; raises as `do`."""
        angles = {limb: list(joints) for limb, joints in (posture or {}).items()}
        shown = picture._asdict()
        return self.do("perform", text=text, picture=shown, posture=angles, sound=sound)

    def wait(self, seconds: float, *, asks: bool = False) -> None:
        """Let s pass, with `asks` until somebody else asks; raises as `do`."""
        self.do("wait", seconds=seconds, asks=asks)

    def settle(self) -> None:
        """Let a stepped bench deliver fresh observations."""
        if self.link.setup.stepped:
            with suppress(DeviceError):  # what is wrong with it is seen by what devices report
                self.do("settle")

    def _critical(self) -> str:
        """Name a critical fault that the devices show, "" if they show none."""
        found = self.diagnosed(self.link.health())
        return next(
            (code for code, critical in found.items() if critical and code not in self._heedless),
            "",
        )


def _nothing(_: Health) -> Mapping[str, bool]:
    return {}
