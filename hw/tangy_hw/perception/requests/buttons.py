"""Requests from a box of buttons: any keyboard, number pad or joystick that Linux supports.

Events are read in the kernel's format (linux/input.h), without a package. The device is grabbed, so
that its keys do not also reach the terminal.
"""

from __future__ import annotations

import asyncio
import contextlib
import os
import re
import struct
import time
from collections.abc import Sequence
from pathlib import Path

from tangy_hw.perception.requests.help_request_source import DEVICE, RequestError, RequestSource
from tangy_profiles.health import OK, STALE, Reading
from tangy_profiles.reading import plain

EVENT = struct.Struct("llHHi")  # time in s and us, type, code, value
SYN, KEY = 0x00, 0x01
SYN_REPORT, SYN_DROPPED = 0, 3
PRESSED = 1  # 0: released, 2: repeated
GRAB = 0x40044590  # EVIOCGRAB
AGAIN_SECONDS = 0.5  # until a missing box is tried again

_PAD = (79, 80, 81, 75, 76, 77, 71, 72, 73)
SEATS = {
    **{code: code - 1 for code in range(2, 11)},  # number keys 1 to 9
    **{code: place + 1 for place, code in enumerate(_PAD)},  # number pad
    **{0x100 + number: number for number in range(1, 10)},  # numbered buttons
    **{0x120 + place: place + 1 for place in range(9)},  # joystick
    **{0x130 + place: place + 1 for place in range(9)},  # game pad
}
"""Seat of each key."""

DEVICES = Path("/dev/input")
LISTED = Path("/sys/class/input")


class KeyEventParser:
    """Parses a device's bytes into events, and returns the pressed keys."""

    def __init__(self) -> None:
        self._rest = b""
        self._dropped = False

    def pressed(self, content: bytes) -> list[int]:
        """Return the codes of the keys that were pressed."""
        content = self._rest + content
        whole = len(content) // EVENT.size * EVENT.size
        self._rest = content[whole:]
        found = []
        for _, _, kind, code, value in EVENT.iter_unpack(content[:whole]):
            if kind == SYN and code in (SYN_DROPPED, SYN_REPORT):
                self._dropped = code == SYN_DROPPED  # incomplete events follow
            elif kind == KEY and value == PRESSED and not self._dropped:
                found.append(code)
        return found


def find_boxes(listed: Path = LISTED, devices: Path = DEVICES) -> list[tuple[str, str]]:
    """Return the paths and names of the devices with keys."""
    found = []
    for folder in listed.glob("event*"):
        device = devices / folder.name
        with contextlib.suppress(OSError, ValueError):
            keys = (folder / "device" / "capabilities" / "key").read_text().split()
            if any(int(word, 16) for word in keys) and device.exists():
                found.append((str(device), plain((folder / "device" / "name").read_text().strip())))
    return sorted(found, key=lambda one: int(re.sub(r"\D", "", one[0]) or 0))


class ButtonBox(RequestSource):
    """Each press of a button asks for its seat; `answered` ends the request."""

    def __init__(self, name: str, device: str, seats: int, people: Sequence[str] = ()) -> None:
        """Prepare the box.

        Args:
            name: name of the source, as given.
            device: /dev/input/event5, or part of the box's name; "" for the only one.
            seats: number of seats.
            people: ids of the people at the seats.

        Raises:
            RequestError: the box is missing or ambiguous.
        """
        super().__init__(name, seats, people)
        self._device = device if device.startswith("/") else _by_name(device)
        self._task: asyncio.Task[None] | None = None
        self._lost: float | None = time.monotonic()

    def reading(self) -> Reading:
        """Return the reading for the diagnosis; buttons at rest are not a fault."""
        if self._lost is None:
            return Reading(DEVICE, 0.0, OK)
        return Reading(DEVICE, time.monotonic() - self._lost, STALE)

    async def start(self) -> None:
        """Start listening."""
        self._task = asyncio.create_task(self._run())

    async def close(self) -> None:
        """Stop listening."""
        await super().close()
        if self._task is not None:
            self._task.cancel()
            await asyncio.wait({self._task})

    async def _run(self) -> None:
        told = ""
        while True:
            try:
                descriptor = os.open(self._device, os.O_RDONLY | os.O_NONBLOCK)
            except OSError as error:
                why = error.strerror or "it cannot be opened"
                if told != why:
                    told = why
                    hint = "; join the group input" if isinstance(error, PermissionError) else ""
                    self.tell(f"The button box is not there ({why}{hint}). It is waited for.")
            else:
                if told:
                    self.tell("The button box is back.")
                told = "unplugged"
                self._lost = None
                try:
                    await self._listen(descriptor)
                finally:
                    os.close(descriptor)
                self._lost = time.monotonic()
                self.tell("The button box was unplugged. It is waited for.")
            await asyncio.sleep(AGAIN_SECONDS)

    async def _listen(self, descriptor: int) -> None:
        """Read events until the box is unplugged."""
        import fcntl

        with contextlib.suppress(OSError):
            fcntl.ioctl(descriptor, GRAB, 1)
        loop, ready, events = asyncio.get_running_loop(), asyncio.Event(), KeyEventParser()
        loop.add_reader(descriptor, ready.set)
        try:
            while True:
                await ready.wait()
                ready.clear()
                try:
                    content = os.read(descriptor, 64 * EVENT.size)
                except BlockingIOError:
                    continue
                except OSError:  # ENODEV: it was unplugged
                    return
                if not content:
                    return
                for code in events.pressed(content):
                    self._ask(SEATS.get(code, 0))
        finally:
            loop.remove_reader(descriptor)


def _by_name(word: str) -> str:
    found = find_boxes()
    fitting = [device for device, title in found if word.lower() in title.lower()]
    if len(fitting) == 1:
        return fitting[0]
    listed = ", ".join(f"{device} ({title})" for device, title in found) or "none is found"
    what = f"no box called {word!r}" if word and not fitting else "it is not clear which box"
    raise RequestError(plain(f"buttons: {what}; give buttons:/dev/input/event0 or so: {listed}."))
