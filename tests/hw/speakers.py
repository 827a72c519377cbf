"""Stand-ins for speech: a synthesiser and players that are shell scripts, and a clock."""

from __future__ import annotations

import asyncio
import heapq
import struct
from pathlib import Path

VOICES = """Pty Language       Age/Gender VoiceName          File                 Other Languages
 5  en-029          --/M      English_(Caribbean) gmw/en-029           (en 10)
 2  en-gb           --/M      English_(Great_Britain) gmw/en               (en 2)
 2  en-us           --/M      English_(America)  gmw/en-US            (en 3)
 5  de              --/M      German             gmw/de               \n"""
VARIANTS = """Pty Language       Age/Gender VoiceName          File                 Other Languages
 5  variant         --/F      female3            !v/f3                \n"""
SYNTHESISER = """cd '{folder}'
case "$1" in
    --version) echo 'eSpeak NG text-to-speech: 9.9  Data at: /nowhere';;
    --voices) cat voices;;
    --voices=variant) cat variants;;
    *) echo "$@" >> asked; cat >> heard; echo >> heard; cat sound;;
esac"""


def program(path: Path, does: str) -> Path:
    """Write a shell script in the place of a program."""
    path.parent.mkdir(exist_ok=True)
    path.touch(mode=0o755)
    path.write_text(f"#!/bin/sh\n{does}\n", encoding="utf-8")
    return path


def from_pipe(seconds: float, rate: int = 22_050) -> bytes:
    """Make a WAV as espeak-ng writes it to a pipe: without its length, which is not known yet."""
    samples = bytes(2 * round(seconds * rate))
    form = struct.pack("<HHIIHH", 1, 1, rate, 2 * rate, 2, 16)
    head = b"RIFF" + struct.pack("<I", 0x7FFFF024) + b"WAVEfmt " + struct.pack("<I", 16)
    return head + form + b"data" + struct.pack("<I", 0x7FFFF000) + samples


class Speaker:
    """A synthesiser with one sound for every text, which records the requests."""

    def __init__(self, folder: Path, *, seconds: float = 2.0) -> None:
        folder.mkdir(exist_ok=True)
        self._folder = folder
        (folder / "voices").write_text(VOICES)
        (folder / "variants").write_text(VARIANTS)
        (folder / "sound").write_bytes(from_pipe(seconds))
        self.path = program(folder / "bin" / "espeak-ng", SYNTHESISER.format(folder=folder))

    def which(self, name: str) -> str:
        """Return this synthesiser for any name."""
        return str(self.path)

    @property
    def asked(self) -> list[str]:
        """The arguments of each synthesised text."""
        return self._read("asked")

    @property
    def heard(self) -> list[str]:
        """The texts it was given, with their mark-up."""
        return self._read("heard")

    def _read(self, name: str) -> list[str]:
        path = self._folder / name
        return path.read_text(encoding="utf-8").splitlines() if path.exists() else []


class Clock:
    """A clock that tests advance."""

    def __init__(self) -> None:
        self.now = 0.0
        self._sleepers: list[tuple[float, int, asyncio.Future[None]]] = []
        self._slept = asyncio.Event()

    async def sleep(self, seconds: float) -> None:
        """Wait until the clock has advanced this far."""
        waiting: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        heapq.heappush(self._sleepers, (self.now + seconds, id(waiting), waiting))
        self._slept.set()
        await waiting

    async def somebody_sleeps(self) -> None:
        """Wait until a task sleeps by this clock."""
        while not any(not waiting.done() for _, _, waiting in self._sleepers):
            self._slept.clear()
            await self._slept.wait()

    def pass_by(self, seconds: float) -> None:
        """Advance the clock."""
        self.now += seconds
        while self._sleepers and self._sleepers[0][0] <= self.now + 1e-9:
            _, _, waiting = heapq.heappop(self._sleepers)
            if not waiting.done():
                waiting.set_result(None)
