"""SCIP 2.0, the language of Hokuyo's laser scanners, as bytes: numbers, checksums, replies.

Numbers are written six bits a character, the highest first, each character 30 (hex) above its
bits. A reply is lines, the last one empty: the command again, a status, then what was asked for;
status and data end with a checksum. Source: Hokuyo C-42-03320B, "Communication Protocol
Specification for SCIP2.0 Standard".
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
"""Bytes within which a reply must end; one of 4,096 beams with intensities has 25,000."""


class ScipError(Exception):
    """The reply is not valid SCIP 2.0; a few words say why."""


@dataclass(frozen=True, slots=True)
class ScipReply:
    """A reply of a scanner: the echoed command, its status, and lines with checksums."""

    echo: bytes
    status: str
    lines: tuple[bytes, ...]


@dataclass(frozen=True, slots=True)
class Optics:
    """Parameters of a scanner: `nearest` and `farthest` in m, its steps, its turns a second.

    There are `resolution` steps to a full turn, counter-clockwise; those from `first` to `last` are
    measured, and `front` is straight ahead.
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
        """The angle between two steps in radians."""
        return 2 * math.pi / self.resolution


def encode(value: int, length: int) -> bytes:
    """Write a number in so many characters.

    Raises:
        ValueError: it is negative, or too large for them.
    """
    if not 0 <= value < 1 << 6 * length:
        raise ValueError(f"{value} does not fit {length} characters")
    return bytes((value >> 6 * place & 0x3F) + BASE for place in reversed(range(length)))


def decode(written: bytes) -> int:
    """Read a number from all these characters.

    Raises:
        ScipError: a character is none that SCIP writes.
    """
    value = 0
    for sign in written:
        if not BASE <= sign < BASE + 64:
            raise ScipError("a character that is no number")
        value = value << 6 | sign - BASE
    return value


def decode_all(written: bytes, length: int) -> NDArray[np.int64]:
    """Read numbers of `length` characters each, one after the other, (n,).

    Raises:
        ScipError: the last is cut off, or a character is none that SCIP writes.
    """
    if len(written) % length:
        raise ScipError("a distance that is cut off")
    bits = np.frombuffer(written, np.uint8).astype(np.int64) - BASE
    if bits.size and not (bits.min() >= 0 and bits.max() < 64):
        raise ScipError("a character that is no number")
    weights = 64 ** np.arange(length - 1, -1, -1, dtype=np.int64)
    numbers: NDArray[np.int64] = bits.reshape(-1, length) @ weights
    return numbers


def checksum(written: bytes) -> int:
    """Return the character that stands after these: the last six bits of their sum."""
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
    """Cut what came into whole replies, and the beginning of the next.

    Replies that came together are distinguished, and one that came in pieces is put together by
    giving the rest back with what comes after it.

    Raises:
        ScipError: what came goes on without an end.
    """
    *whole, rest = buffer.split(END)
    if len(rest) > LONGEST:
        raise ScipError("a reply without an end")
    # An empty line too many stands at the beginning of what comes next.
    return [one.lstrip(b"\n") for one in whole if one.strip(b"\n")], rest


def reply_from_echo(reply: bytes, echo: bytes) -> bytes:
    """Return a reply from its echo on, without what stands before that.

    Before it may be noise from a bad cable, or the rest of a reply that lost its end. A reply
    without the echo is returned as it is.
    """
    at = reply.rfind(echo + b"\n")
    return reply[at:] if at > 0 else reply


def parse(reply: bytes) -> ScipReply:
    """Read one reply, without its empty line.

    Raises:
        ScipError: it has no status, or one with a wrong checksum.
    """
    echo, *lines = reply.split(b"\n")
    if not lines:
        raise ScipError("a reply without a status")
    # Scanners that still speak SCIP 1.1 answer the change to 2.0 with a bare 0.
    status = lines[0] if lines[0] == b"0" else checked(lines[0])
    try:
        return ScipReply(echo, status.decode("ascii"), tuple(lines[1:]))
    except UnicodeDecodeError:
        raise ScipError("a status that is no text") from None


def joined(lines: Iterable[bytes]) -> bytes:
    """Put the lines of a measurement together, each without its checksum.

    Raises:
        ScipError: a checksum is wrong.
    """
    return b"".join(checked(line) for line in lines)


def named(lines: Iterable[bytes]) -> Mapping[str, str]:
    """Read lines such as `DMAX:5600[mm];C`, as VV, PP and II answer; those that are none are left.

    Raises:
        ScipError: a checksum is wrong.
    """
    found: dict[str, str] = {}
    for line in lines:
        body, semicolon, sums = line.rpartition(b";")
        if not semicolon or len(sums) != 1:
            continue
        # Some firmwares count the semicolon in, some do not.
        if sums[0] not in (checksum(body), checksum(body + b";")):
            raise ScipError("a checksum that is wrong")
        name, colon, value = body.decode("ascii", "replace").partition(":")
        if colon:
            found[name.strip()] = value.strip()
    return found


def optics(facts: Mapping[str, str]) -> Optics:
    """Read what PP answers.

    Raises:
        ScipError: a fact is missing, or cannot be.
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
    """Say in a few words what a status means that is no success; "" if it is one."""
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
