"""Waits for the robot process to switch the robot on, and names a driver that blocks it."""

from __future__ import annotations

import time
from collections.abc import Mapping
from concurrent.futures import Future
from concurrent.futures import TimeoutError as TooLate
from typing import Any

from tangy_hw.device_protocols import STARTED, DeviceError, DeviceFailed, hangs

DEVICE_SECONDS = 27.0
"""Time for each device. The process itself notices drivers that only wait."""
PART_SECONDS = 60.0
"""Time for each other part, such as loading the modules on a busy machine."""
LOOK_SECONDS = 0.1  # between two looks at the part in progress
NO_DEVICES = ("", "program", "senses", "first words")
"""Parts of the start-up that are no devices."""


class StartUp:
    """One start-up: the part in progress, and since when."""

    def __init__(self) -> None:
        self._part = self._called = ""
        self._did = STARTED
        self._begun = time.monotonic()

    def hear(self, said: Mapping[str, Any]) -> str | None:
        """Note a message about the start-up.

        Returns:
            The part that begins, "" if it is none to show; None: the message is of another kind.
        """
        if "starts" in said:
            self._part, self._begun = str(said["starts"]), time.monotonic()
            return self._part
        if "calls" in said:
            self._called, self._begun = str(said["calls"]), time.monotonic()
            self._did = str(said.get("did", STARTED))
            return ""
        return None

    def wait(self, first: Future[dict[str, Any]]) -> dict[str, Any]:
        """Wait for the first answer of the process.

        Raises:
            TooLate: a device or another part takes too long.
            DeviceError: the process tells of a problem.
        """
        while True:
            try:
                return first.result(LOOK_SECONDS)
            except TooLate:
                seconds = DEVICE_SECONDS if self._device else PART_SECONDS
                if time.monotonic() - self._begun > seconds:
                    raise

    def blocked(self) -> DeviceError:
        """Return the error of a start-up that does not go on; it names the driver that blocks."""
        device = self._device
        if not device:
            return DeviceError("The robot process does not begin.")
        did = self._did if self._called else STARTED
        return DeviceFailed(device, f"{device}: {hangs(DEVICE_SECONDS, did)}")

    @property
    def _device(self) -> str:
        """The device whose driver is called, "" if none is."""
        return self._called or ("" if self._part in NO_DEVICES else self._part)
