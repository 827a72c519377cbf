"""Requests by a box of buttons: whatever Linux takes for a keyboard, a number pad or a joystick.

The events of such a device are read as the kernel writes them (linux/input.h), which needs no
package. The device is grabbed, so that its keys do not also arrive in the terminal.
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
PRESSED = 1  # 0 let go, 2 held down
GRAB = 0x40044590  # EVIOCGRAB
AGAIN_SECONDS = 0.5  # until a box that has gone is looked for again

_PAD = (79, 80, 81, 75, 76, 77, 71, 72, 73)
SEATS = {
    **{code: code - 1 for code in range(2, 11)},  # the number keys 1 to 9
    **{code: place + 1 for place, code in enumerate(_PAD)},  # those of a number pad
    **{0x100 + number: number for number in range(1, 10)},  # numbered buttons
    **{0x120 + place: place + 1 for place in range(9)},  # a joystick's
    **{0x130 + place: place + 1 for place in range(9)},  # a game pad's
}
"""Which seat a key is for."""

DEVICES = Path("/dev/input")
LISTED = Path("/sys/class/input")


class Events:
    """Assembles a device's bytes into events, and yields the pressed keys."""

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
                self._dropped = code == SYN_DROPPED  # what follows one is not complete
            elif kind == KEY and value == PRESSED and not self._dropped:
                found.append(code)
        return found


def find_boxes(listed: Path = LISTED, devices: Path = DEVICES) -> list[tuple[str, str]]:
    """Return the devices with keys, and what they are called."""
    found = []
    for folder in listed.glob("event*"):
        device = devices / folder.name
        with contextlib.suppress(OSError, ValueError):
            keys = (folder / "device" / "capabilities" / "key").read_text().split()
            if any(int(word, 16) for word in keys) and device.exists():
                found.append((str(device), plain((folder / "device" / "name").read_text().strip())))
    return sorted(found, key=lambda one: int(re.sub(r"\D", "", one[0]) or 0))


class ButtonBox(RequestSource):
    """A button asks for its seat, as often as it is pressed; helping ends that (`answered`)."""

    def __init__(self, name: str, device: str, seats: int, people: Sequence[str] = ()) -> None:
        """Name the box.

        Args:
            name: as it was given.
            device: /dev/input/event5, or a part of what the box is called; "" for the only one.
            seats: how many there are.
            people: the ids of who sits at them.

        Raises:
            RequestError: it is not clear which box is meant.
        """
        super().__init__(name, seats, people)
        self._device = device if device.startswith("/") else _by_name(device)
        self._task: asyncio.Task[None] | None = None
        self._lost: float | None = time.monotonic()

    def reading(self) -> Reading:
        """Return what the diagnosis is told of it; a button that is not pressed is no silence."""
        if self._lost is None:
            return Reading(DEVICE, 0.0, OK)
        return Reading(DEVICE, time.monotonic() - self._lost, STALE)

    async def start(self) -> None:
        """Begin to hear who asks."""
        self._task = asyncio.create_task(self._run())

    async def close(self) -> None:
        """Hear no more."""
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
        """Read events until the box has gone."""
        import fcntl

        with contextlib.suppress(OSError):
            fcntl.ioctl(descriptor, GRAB, 1)
        loop, ready, events = asyncio.get_running_loop(), asyncio.Event(), Events()
        loop.add_reader(descriptor, ready.set)
        try:
            while True:
                await ready.wait()
                ready.clear()
                try:
                    content = os.read(descriptor, 64 * EVENT.size)
                except BlockingIOError:
                    continue
                except OSError:  # ENODEV: it is unplugged
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
