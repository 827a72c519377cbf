"""Commands of the world to the robot, one after another, aborted if necessary."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from typing import Any, Literal

from tangy_hw.device_protocols import DeviceError, Picture
from tangy_hw.robot_client.client import RobotLink
from tangy_hw.robot_process.requests import Request
from tangy_hw.robot_process.stop_latch import Preempted
from tangy_profiles.health import Health

BREAK_SECONDS = 20.0  # of real time, after which a cancelled command counts as over
RETURN_SECONDS = 4.0  # of real time in which tablets connect again

Diagnosed = Callable[[Health], Mapping[str, bool]]
"""Returns the codes of the faults that devices show, and whether each is critical."""


WaitKind = Literal["response", "sign", "act"]
"""What is waited for: the person does what they were asked, turns the sign down, or acts freely."""


@dataclass(frozen=True, slots=True)
class WaitsFor:
    """The robot waits for a person ("": for everybody) until a time of the robot (s) at most."""

    kind: WaitKind
    person: str
    until: float


class Commands:
    """Sends commands to the robot and waits for each of them."""

    def __init__(self, link: RobotLink) -> None:
        self.link = link
        self.waits_for: WaitsFor | None = None
        """What people are given time for now; read from any thread."""
        self.diagnosed: Diagnosed = _nothing
        self._ignored: frozenset[str] = frozenset()

    def do(self, do: Request, **what: Any) -> dict[str, Any]:
        """Execute a command; a critical reading of a device aborts it.

        Raises:
            Preempted: it was aborted, or the robot had to stop.
            DeviceError: it failed.
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
    def ignoring_faults(self, *codes: str) -> Iterator[None]:
        """Ignore faults of these codes while the context is active."""
        before, self._ignored = self._ignored, self._ignored | set(codes)
        try:
            yield
        finally:
            self._ignored = before

    def perform(
        self,
        text: str,
        picture: Picture,
        posture: Mapping[str, Sequence[float]] | None = None,
        sound: str = "",
    ) -> dict[str, Any]:
        """Let the robot speak, show, gesture (degrees), then play a WAV; raises as `do`."""
        angles = {limb: list(joints) for limb, joints in (posture or {}).items()}
        shown = picture._asdict()
        return self.do("perform", text=text, picture=shown, posture=angles, sound=sound)

    def wait(self, seconds: float, *, asks: bool = False) -> None:
        """Let s pass, with `asks` only until a new request comes; raises as `do`."""
        self.do("wait", seconds=seconds, asks=asks)

    @contextmanager
    def waiting_for(self, kind: WaitKind, person: str, seconds: float) -> Iterator[None]:
        """Tell meanwhile that the robot waits for a person ("": everybody), up to so many s."""
        self.waits_for = WaitsFor(kind, person, self.link.time + seconds)
        try:
            yield
        finally:
            self.waits_for = None

    def settle(self) -> None:
        """Let a stepped bench deliver fresh observations."""
        if self.link.setup.stepped:
            with suppress(DeviceError):  # the devices' readings show the problem
                self.do("settle")

    def await_tablets(self) -> None:
        """Wait a moment while only non-critical faults show: tablets return after a restart."""
        until = time.monotonic() + RETURN_SECONDS
        while time.monotonic() < until:
            found = self.diagnosed(self.link.health())
            if not found or any(found.values()):
                return
            self.link.beat()

    def _critical(self) -> str:
        """Return the code of a critical fault that the devices show, "" if there is none."""
        found = self.diagnosed(self.link.health())
        return next(
            (code for code, critical in found.items() if critical and code not in self._ignored),
            "",
        )


def _nothing(_: Health) -> Mapping[str, bool]:
    return {}
