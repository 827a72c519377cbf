"""A session of a SCIP 2.0 laser scanner: commands and state for one client.

Written from Hokuyo C-42-03320B independently of the driver, so that each tests the other.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

LINE = 64
"""Characters of a measurement in one line."""

LONGEST_COMMAND = 100
CLOCK = 1 << 24  # ms after which a scanner's clock wraps


@dataclass(frozen=True, slots=True)
class Scanner:
    """Properties of a simulated scanner; distances in m, `rate` in turns per s.

    Beams are numbered from 0, with `resolution` steps to a full turn; `front` is straight ahead.
    `nothing` is its code, in mm, for a beam without a return.
    """

    model: str
    nearest: float
    farthest: float
    resolution: int
    beams: int
    front: int
    rate: float
    nothing: int

    @property
    def step(self) -> float:
        """Angle between two beams, in rad."""
        return 2 * math.pi / self.resolution

    @property
    def first(self) -> float:
        """Bearing of the first beam in rad, counter-clockwise from straight ahead."""
        return -self.front * self.step


URG = Scanner("URG-04LX", 0.02, 5.6, 540, 360, 180, 10.0, 0)
"""A small scanner for desks and robots: 360 beams over 240 degrees."""

UTM = Scanner("UTM-30LX", 0.1, 30.0, 480, 360, 180, 40.0, 1)
"""A long-range scanner: 360 beams over 270 degrees."""


def check(written: bytes) -> bytes:
    """Return the checksum character of a line."""
    return bytes([sum(written) % 64 + 48])


def number(value: int, signs: int) -> bytes:
    """Encode a number, six bits a character."""
    return bytes(48 + (value >> shift) % 64 for shift in range(6 * signs - 6, -1, -6))


def measurement(distances: NDArray[np.int64], signs: int) -> bytes:
    """Encode distances (n,) in mm as lines of 64 characters, each with its checksum."""
    shifts = np.arange(6 * signs - 6, -1, -6)
    body = (48 + (distances[:, None] >> shifts) % 64).astype(np.uint8).tobytes()
    pieces = (body[begin : begin + LINE] for begin in range(0, len(body), LINE))
    return b"".join(piece + check(piece) + b"\n" for piece in pieces)


@dataclass(slots=True)
class _Wanted:
    """A client's measurement request: its beams, and the number of scans left."""

    echo: bytes
    first: int
    last: int
    cluster: int
    signs: int
    skip: int = 0
    left: int | None = None  # None: unlimited
    passed: int = 0  # scans skipped since the last


MEASURE = re.compile(
    rb"(?P<many>M|G)(?P<kind>D|S)(?P<first>....)(?P<last>....)(?P<cluster>..)"
    rb"((?P<skip>.)(?P<count>..))?$"
)


class ScipSession:
    """A client's session: `feed` takes its bytes, `offer` a scan."""

    def __init__(self, scanner: Scanner, write: Callable[[bytes], None]) -> None:
        self.fault = ""
        """Status that a broken scanner sends instead of scans; "" without a fault."""
        self._scanner = scanner
        self._write = write
        self._heard = b""
        self._lit = False
        self._adjusting = False
        self._stream: _Wanted | None = None
        self._single: list[_Wanted] = []
        self._ticks = 0

    @property
    def measuring(self) -> bool:
        """Whether a measurement is active."""
        return self._stream is not None or bool(self._single)

    def feed(self, came: bytes) -> None:
        """Parse bytes of the client, and answer the complete commands."""
        *commands, self._heard = re.split(rb"\r?\n|\r", self._heard + came)
        if len(self._heard) > LONGEST_COMMAND:
            self._heard = b""
        for command in commands:
            if command:
                self._obey(command)

    def offer(self, distances: NDArray[np.int64], ticks: int) -> bool:
        """Send a scan, (n,) in mm, with a time in ms; return whether the client got it."""
        self._ticks = ticks
        got = False
        while self._single:
            self._give(self._single.pop(0), b"00", distances)
            got = True
        wanted = self._stream
        if wanted is None:
            return got
        if self.fault:
            self._stream = None
            self._answer(wanted.echo, self.fault.encode())
            return got
        if wanted.passed < wanted.skip:
            wanted.passed += 1
            return got
        wanted.passed = 0
        if wanted.left is not None:
            wanted.left -= 1
            # The number of remaining scans replaces the requested one in the echo.
            head, semicolon, tail = wanted.echo.partition(b";")
            wanted.echo = head[:-2] + b"%02d" % wanted.left + semicolon + tail
            if not wanted.left:
                self._stream = None
        self._give(wanted, b"99", distances)
        return True

    def _give(self, wanted: _Wanted, status: bytes, distances: NDArray[np.int64]) -> None:
        part = distances[wanted.first : wanted.last + 1]
        if wanted.cluster > 1:
            part = np.minimum.reduceat(part, np.arange(0, len(part), wanted.cluster))
        part = np.minimum(part, (1 << 6 * wanted.signs) - 1)
        time = number(self._ticks % CLOCK, 4)
        self._answer(
            wanted.echo, status, time + check(time) + b"\n" + measurement(part, wanted.signs)
        )

    def _answer(self, echo: bytes, status: bytes, lines: bytes = b"") -> None:
        closed = status if len(status) == 1 else status + check(status)
        self._write(echo + b"\n" + closed + b"\n" + lines + b"\n")

    def _obey(self, command: bytes) -> None:
        word = command.partition(b";")[0]  # a comment of the client follows
        if word[:2] in (b"MD", b"MS", b"GD", b"GS"):
            self._measure(command, word)
        elif word in (b"VV", b"PP", b"II"):
            self._answer(command, b"00", self._described(word))
        elif word == b"BM":
            status = b"01" if self.fault else b"02" if self._lit else b"00"
            self._lit = self._lit or not self.fault
            self._answer(command, status)
        elif word in (b"QT", b"RS", b"RT"):
            self._lit, self._stream = False, None
            self._single.clear()
            self._answer(command, b"00")
        elif word[:2] == b"TM":
            self._adjust(command, word)
        elif word == b"%ST":
            state = b"900" if self.fault else self._state()
            self._answer(command, b"00", state + check(state) + b"\n")
        elif word == b"SCIP2.0" or re.fullmatch(rb"(SS|CR|HS|DB)\d+", word):
            self._answer(command, b"00")
        else:
            self._answer(command, b"0E")

    def _measure(self, command: bytes, word: bytes) -> None:
        asked = MEASURE.match(word)
        if asked is None or (asked["many"] == b"M") != (asked["count"] is not None):
            self._answer(command, b"0E")
            return
        names = ("first", "last", "cluster", "skip", "count")
        for place, name in enumerate(names, 1):
            if asked[name] is not None and not asked[name].isdigit():
                self._answer(command, b"%02d" % (place if place < 4 else place + 2))
                return
        first, last, cluster = (int(asked[name]) for name in names[:3])
        if last >= self._scanner.beams:
            self._answer(command, b"04")
        elif last < first:
            self._answer(command, b"05")
        else:
            signs = 3 if asked["kind"] == b"D" else 2
            wanted = _Wanted(command, first, last, max(1, cluster), signs)
            self._begin(wanted, int(asked["skip"] or 0), asked["count"])

    def _begin(self, wanted: _Wanted, skip: int, count: bytes | None) -> None:
        if self.fault:
            self._answer(wanted.echo, self.fault.encode())
        elif count is None and not self._lit:
            self._answer(wanted.echo, b"10")
        elif count is None:
            self._single.append(wanted)
        else:
            self._lit = True
            self._answer(wanted.echo, b"00")
            wanted.skip, wanted.left = skip, int(count) or None
            self._stream = wanted

    def _adjust(self, command: bytes, word: bytes) -> None:
        """Answer the commands of time synchronisation."""
        if word == b"TM0":
            self._answer(command, b"02" if self._adjusting else b"00")
            self._adjusting, self._stream, self._lit = True, None, False
        elif word == b"TM1":
            time = number(self._ticks % CLOCK, 4)
            if self._adjusting:
                self._answer(command, b"00", time + check(time) + b"\n")
            else:
                self._answer(command, b"04")
        elif word == b"TM2":
            self._answer(command, b"00" if self._adjusting else b"03")
            self._adjusting = False
        else:
            self._answer(command, b"01")

    def _state(self) -> bytes:
        if self._adjusting:
            return b"002"
        return b"004" if self._stream is not None else b"003" if self._lit else b"000"

    def _described(self, word: bytes) -> bytes:
        one = self._scanner
        said: dict[str, object]
        if word == b"VV":
            said = {
                "VEND": "Tangy's bench", "PROD": f"stands in for {one.model}",
                "FIRM": "1.0", "PROT": "SCIP 2.0", "SERI": "BENCH-1",
            }  # fmt: skip
        elif word == b"PP":
            said = {
                "MODL": one.model, "DMIN": round(one.nearest * 1000),
                "DMAX": round(one.farthest * 1000), "ARES": one.resolution, "AMIN": 0,
                "AMAX": one.beams - 1, "AFRT": one.front, "SCAN": round(one.rate * 60),
            }  # fmt: skip
        else:
            said = {
                "MODL": one.model, "LASR": "ON" if self._lit else "OFF",
                "SCSP": f"{round(one.rate * 60)}[rpm]", "MESM": "IDLE" if not self._stream else "3",
                "SBPS": "115200[bps]", "TIME": f"{self._ticks % CLOCK:06X}",
                "STAT": f"trouble {self.fault}" if self.fault else "sensor is working normally",
            }  # fmt: skip
        lines = (f"{name}:{value}".encode() for name, value in said.items())
        return b"".join(line + b";" + check(line) + b"\n" for line in lines)
