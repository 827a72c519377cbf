"""Codec of SCIP 2.0, the protocol of Hokuyo's laser scanners: numbers, checksums, replies.

Numbers have six bits per character, the most significant first, each plus 30 (hex). A reply
consists of lines, the last one empty: the echoed command, a status, and the data; status and data
end with a checksum. Source: Hokuyo C-42-03320B, "Communication Protocol Specification for SCIP2.0
Standard".
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

BASE = 0x30
END = b"\n\n"
LONGEST = 1 << 16
"""Maximum bytes of a reply; one of 4,096 beams with intensities has 25,000."""


class ScipError(Exception):
    """A reply that is not valid SCIP 2.0; a few words say why."""


@dataclass(frozen=True, slots=True)
class ScipReply:
    """A reply of a scanner: the echoed command, its status, and lines with checksums."""

    echo: bytes
    status: str
    lines: tuple[bytes, ...]


@dataclass(frozen=True, slots=True)
class Optics:
    """Properties of a scanner: `nearest` and `farthest` in m, angular steps, scans per s (`rate`).

    A full turn has `resolution` steps, counter-clockwise; `first` to `last` are measured, and
    `front` is straight ahead.
    """

    model: str
    nearest: float
    farthest: float
    resolution: int
    first: int
    last: int
    front: int
    rate: float

    @property
    def step(self) -> float:
        """Angle between two steps in rad."""
        return 2 * math.pi / self.resolution


def decode(written: bytes) -> int:
    """Decode a number from all these characters.

    Raises:
        ScipError: a character is invalid.
    """
    value = 0
    for sign in written:
        if not BASE <= sign < BASE + 64:
            raise ScipError("a character that is not a digit")
        value = value << 6 | sign - BASE
    return value


def decode_all(written: bytes, length: int) -> NDArray[np.int64]:
    """Decode consecutive numbers (n,) of `length` characters each.

    Raises:
        ScipError: the last is cut off, or a character is invalid.
    """
    if len(written) % length:
        raise ScipError("a distance that is cut off")
    bits = np.frombuffer(written, np.uint8).astype(np.int64) - BASE
    if bits.size and not (bits.min() >= 0 and bits.max() < 64):
        raise ScipError("a character that is not a digit")
    weights = 64 ** np.arange(length - 1, -1, -1, dtype=np.int64)
    numbers: NDArray[np.int64] = bits.reshape(-1, length) @ weights
    return numbers


def checksum(written: bytes) -> int:
    """Return the checksum character: the last six bits of the sum, encoded."""
    return (sum(written) & 0x3F) + BASE


def checked(line: bytes) -> bytes:
    """Return a line without its checksum.

    Raises:
        ScipError: the checksum is wrong, or missing.
    """
    if not line or checksum(line[:-1]) != line[-1]:
        raise ScipError("a checksum that is wrong")
    return line[:-1]


def split(buffer: bytes) -> tuple[list[bytes], bytes]:
    """Split received bytes into complete replies and the rest.

    The caller passes the rest again, followed by the next bytes.

    Raises:
        ScipError: the rest is too long for a reply.
    """
    *whole, rest = buffer.split(END)
    if len(rest) > LONGEST:
        raise ScipError("a reply without an end")
    # A surplus empty line is at the beginning of the next reply.
    return [one.lstrip(b"\n") for one in whole if one.strip(b"\n")], rest


def reply_from_echo(reply: bytes, echo: bytes) -> bytes:
    """Return a reply from its echo on, without anything before.

    Noise from a bad cable, or the rest of a truncated reply, may precede it. A reply without the
    echo is returned unchanged.
    """
    at = reply.rfind(echo + b"\n")
    return reply[at:] if at > 0 else reply


def parse(reply: bytes) -> ScipReply:
    """Parse one reply, without its empty line.

    Raises:
        ScipError: it has no status, or the status has a wrong checksum.
    """
    echo, *lines = reply.split(b"\n")
    if not lines:
        raise ScipError("a reply without a status")
    # Scanners in SCIP 1.1 answer the change to 2.0 with a bare 0.
    status = lines[0] if lines[0] == b"0" else checked(lines[0])
    try:
        return ScipReply(echo, status.decode("ascii"), tuple(lines[1:]))
    except UnicodeDecodeError:
        raise ScipError("a status that is not text") from None


def joined(lines: Iterable[bytes]) -> bytes:
    """Join the lines of a measurement, each without its checksum.

    Raises:
        ScipError: a checksum is wrong.
    """
    return b"".join(checked(line) for line in lines)


def named(lines: Iterable[bytes]) -> Mapping[str, str]:
    """Parse lines such as `DMAX:5600[mm];C`, as in answers to VV, PP and II; skip other lines.

    Raises:
        ScipError: a checksum is wrong.
    """
    found: dict[str, str] = {}
    for line in lines:
        body, semicolon, sums = line.rpartition(b";")
        if not semicolon or len(sums) != 1:
            continue
        # Some firmware includes the semicolon in the checksum, some does not.
        if sums[0] not in (checksum(body), checksum(body + b";")):
            raise ScipError("a checksum that is wrong")
        name, colon, value = body.decode("ascii", "replace").partition(":")
        if colon:
            found[name.strip()] = value.strip()
    return found


def optics(facts: Mapping[str, str]) -> Optics:
    """Parse the answer to PP.

    Raises:
        ScipError: a property is missing or impossible.
    """
    try:
        whole = {
            name: int(facts[name].partition("[")[0])
            for name in ("DMIN", "DMAX", "ARES", "AMIN", "AMAX", "AFRT", "SCAN")
        }
    except (KeyError, ValueError) as error:
        raise ScipError(f"no use of its properties ({error})") from None
    possible = (
        0 <= whole["DMIN"] < whole["DMAX"]
        and whole["ARES"] > 0
        and 0 <= whole["AMIN"] < whole["AMAX"] < 10_000
        and whole["SCAN"] > 0
    )
    if not possible:
        raise ScipError("properties that cannot be")
    return Optics(
        facts.get("MODL", "").partition("(")[0].strip() or "scanner",
        whole["DMIN"] / 1000,
        whole["DMAX"] / 1000,
        whole["ARES"],
        whole["AMIN"],
        whole["AMAX"],
        whole["AFRT"],
        whole["SCAN"] / 60,
    )


def trouble(status: str, command: str = "") -> str:
    """Return the meaning of an error status in a few words; "" for success."""
    if status in ("00", "99", "0", "98"):
        return ""
    if command == "BM":
        return "its laser cannot be lit"
    known = {
        "0E": "it does not know a command",
        "0F": "it does not support a command",
        "0L": "it is in an abnormal state",
        "0M": "it is unsteady",
        "10": "its laser is off",
    }
    if status in known:
        return known[status]
    if status.isdecimal() and 21 <= int(status) <= 49:
        return f"it stopped to look for an error of its own (status {status})"
    if status.isdecimal() and 50 <= int(status) <= 97:
        return f"its motor or laser is broken (status {status})"
    return f"it refuses to measure (status {status})"
