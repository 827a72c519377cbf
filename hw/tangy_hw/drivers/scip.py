"""A laser scanner that speaks SCIP 2.0, over TCP or a serial port."""

from __future__ import annotations

import asyncio
import contextlib
import math
import time
from collections import deque
from collections.abc import Callable, Mapping
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from tangy_hw.device_protocols import DeviceError, Scan, Stamped
from tangy_hw.drivers.scip_codec import (
    Optics,
    ScipError,
    ScipReply,
    decode,
    decode_all,
    joined,
    named,
    optics,
    parse,
    reply_from_echo,
    split,
    trouble,
)
from tangy_hw.drivers.scip_link import Link, open_link
from tangy_hw.drivers.source_clock import SourceClock
from tangy_hw.rate_estimator import RateEstimator
from tangy_profiles.health import ERROR, NEVER, OK, STALE, WARN, DeviceState, Fact, Reading

NEAR = 0.15
"""A hand's breadth in m: nearer returns come from an object that covers the scanner."""

WINDOW = 1.0
"""Seconds in which ranges change, unless the scanner is covered."""

SEEN = 0.8
"""Share of that time that scans must span before the change is reported."""

ANSWER_SECONDS = 1.0  # timeout of a command; scanners answer within 10 ms
SILENT_SECONDS = 2.0  # without a scan, after which it reconnects
AGAIN_SECONDS = (0.05, 0.1, 0.2, 0.5)  # until it retries; the last one repeats
CLOCK = 1 << 24  # ms after which the scanner's clock wraps


class _Refusal(DeviceError):
    """The scanner itself reports that it cannot measure."""


class ScipLaser:
    """A scanner in continuous measurement mode; it reconnects by itself.

    Scans are numbered from 1. `missed` counts scans that never arrived (by the scanner's own
    clock), `spoilt` damaged replies, and `connected` connections that delivered scans.
    """

    def __init__(
        self,
        address: str,
        *,
        name: str = "laser",
        clock: Callable[[], float] = time.monotonic,
        stale_after: float = 0.25,
        turned: float = 0.0,
        flipped: bool = False,
        skip: int = 0,
        baud: int = 115_200,
    ) -> None:
        """Prepare a scanner; `start` opens it.

        Args:
            address: `tcp://host:port`, or the path of a serial port.
            name: its name in the robot's profile.
            clock: returns the time of the stamps, in s.
            stale_after: age in s above which a scan is stale.
            turned: rotation of the scanner to the left of the robot's front, in rad.
            flipped: whether it is mounted upside down.
            skip: scans to skip after each, 0 to 9.
            baud: speed of a serial port.
        """
        self.name = name
        self.address = address
        self.optics: Optics | None = None
        self.about: Mapping[str, str] = MappingProxyType({})
        """Manufacturer, firmware and serial number (VV)."""
        self.missed = self.spoilt = self.connected = 0
        self._clock = clock
        self._stale_after = stale_after
        self._turned, self._flipped, self._skip, self._baud = turned, flipped, skip, baud
        self._link: Link | None = None
        self._rest = b""
        self._replies: deque[bytes] = deque()
        self._scan: Stamped[Scan] | None = None
        self._seen: deque[tuple[float, NDArray[np.int64]]] = deque()
        self._arrivals = RateEstimator()
        self._facts: tuple[int, Mapping[str, Fact]] = (0, MappingProxyType({}))
        self._arrived = asyncio.Event()
        self._ticks: int | None = None
        self._scanner_clock = SourceClock()
        self._warned = -math.inf
        self._refused = False  # by an explicit status, not by silence
        self._why = "It was not started."
        self._task: asyncio.Task[None] | None = None

    @property
    def scan(self) -> Stamped[Scan] | None:
        """The newest scan; None before the first."""
        return self._scan

    @property
    def why(self) -> str:
        """Its problem, in one sentence; "" if none is known."""
        return self._why

    async def start(self) -> None:
        """Start connecting and measuring."""
        if self._task is None:
            self._why = f"{self.name} at {self.address} has not answered yet."
            self._task = asyncio.create_task(self._run(), name=f"scip {self.name}")

    async def close(self) -> None:
        """Close for good; switch the laser off if still connected."""
        task, self._task = self._task, None
        if task is None:
            return
        task.cancel()
        await asyncio.wait({task})

    async def after(self, seq: int) -> Stamped[Scan]:
        """Wait for a scan with a higher number than `seq`, and return the newest."""
        while self._scan is None or self._scan.seq <= seq:
            self._arrived.clear()
            await self._arrived.wait()
        return self._scan

    def reading(self) -> Reading:
        """Return its state, the age of its newest scan, and the facts about its view.

        `near_share` is the share of beams that end within `NEAR`; `variety` the share that changed
        within a second, once a second was seen.
        """
        now = self._clock()
        age = NEVER if self._scan is None else min(max(0.0, now - self._scan.stamp), NEVER)
        if self._refused:
            return Reading(self.name, age, ERROR)
        rate = self._arrivals.rate(now)
        if self._scan is None or age > self._stale_after:
            return Reading(self.name, age, STALE, rate=rate)
        state: DeviceState = WARN if now - self._warned < WINDOW else OK
        return Reading(self.name, age, state, self._told(), rate)

    def _told(self) -> Mapping[str, Fact]:
        assert self._scan is not None  # noqa: S101
        seq, facts = self._facts
        if seq != self._scan.seq:
            told: dict[str, Fact] = {"near_share": float(np.mean(self._scan.value.ranges < NEAR))}
            if self._seen[-1][0] - self._seen[0][0] >= SEEN * WINDOW:
                taken = np.stack([ranges for _, ranges in self._seen])
                told["variety"] = float(np.mean(taken.min(0) != taken.max(0)))
            facts = MappingProxyType(told)
            self._facts = self._scan.seq, facts
        return facts

    async def _run(self) -> None:
        tries = 0
        while True:
            before = self.connected
            try:
                self._link = await open_link(self.address, self._baud)
                self._rest, self._ticks = b"", None
                self._replies.clear()
                await self._begin()
                await self._measure()
            except DeviceError as error:
                self._refused = isinstance(error, _Refusal)
                self._why = f"{self.name} at {self.address} {error}."
            except (OSError, ScipError) as error:
                self._refused = False
                self._why = f"{self.name} at {self.address} broke off ({error})."
            finally:
                await self._hang_up()
            tries = 0 if self.connected > before else tries + 1
            await asyncio.sleep(AGAIN_SECONDS[min(tries, len(AGAIN_SECONDS) - 1)])

    async def _hang_up(self) -> None:
        link, self._link = self._link, None
        if link is None:
            return
        with contextlib.suppress(OSError, TimeoutError):
            async with asyncio.timeout(0.2):
                await link.write(b"QT\n")
        await asyncio.sleep(0)  # let the write complete
        link.close()

    async def _begin(self) -> None:
        """Stop the scanner, query its properties, and switch its laser on."""
        if "://" not in self.address:
            # Old scanners start in SCIP 1.1, in which they answer nothing else that we parse; newer
            # ones reject this command.
            with contextlib.suppress(DeviceError):
                await self._ask(b"SCIP2.0")
        # It may still measure for an earlier client, or hold part of its command.
        await self._ask(b"QT", tries=2)
        self.optics = optics(named((await self._ask(b"PP")).lines))
        self.about = MappingProxyType(dict(named((await self._ask(b"VV")).lines)))
        await self._ask(b"BM", also=("02",))

    async def _ask(
        self, command: bytes, *, also: tuple[str, ...] = (), tries: int = 1
    ) -> ScipReply:
        """Send a command and return its reply; skip replies to other commands.

        Raises:
            DeviceError: no reply, or a refusal.
        """
        assert self._link is not None  # noqa: S101
        for last in range(tries - 1, -1, -1):
            await self._link.write(command + b"\n")
            try:
                async with asyncio.timeout(ANSWER_SECONDS):
                    while True:
                        reply = await self._next(command)
                        if reply.echo == command:
                            break
                break
            except TimeoutError:
                if not last:
                    raise DeviceError("does not answer") from None
        if reply.status not in also and (problem := trouble(reply.status, command.decode())):
            raise _Refusal(f"cannot measure: {problem}")
        return reply

    async def _next(self, echo: bytes) -> ScipReply:
        """Return the next valid reply; skip noise before the given echo.

        Raises:
            OSError: the connection has ended.
        """
        while True:
            while not self._replies:
                came = await self._link.read() if self._link is not None else b""
                if not came:
                    raise ConnectionResetError("the connection has ended")
                whole, self._rest = split(self._rest + came)
                self._replies.extend(whole)
            came = self._replies.popleft()
            reply = reply_from_echo(came, echo)
            if reply is not came:
                self._damaged()
            try:
                return parse(reply)
            except ScipError:
                self._damaged()

    async def _measure(self) -> None:
        """Receive scans until an error."""
        assert self.optics is not None and self._link is not None  # noqa: S101
        command = b"MD%04d%04d01%d00" % (self.optics.first, self.optics.last, self._skip)
        await self._link.write(command + b"\n")
        heard, self._why = self._clock(), ""
        while True:
            try:
                async with asyncio.timeout(ANSWER_SECONDS):
                    reply = await self._next(command)
            except TimeoutError:
                # While a bench is paused, no time passes, and nothing is wrong.
                if self._clock() - heard >= SILENT_SECONDS:
                    raise DeviceError("sends nothing any more") from None
                continue
            if reply.echo != command:
                continue
            if reply.status == "99":
                try:
                    self._take(reply)
                except ScipError:
                    self._damaged()
                    continue
                heard = self._clock()
            elif reply.status == "0M":
                self._warned = self._clock()
            elif problem := trouble(reply.status):
                raise _Refusal(f"cannot measure: {problem}")

    def _take(self, reply: ScipReply) -> None:
        """Turn a measurement into a scan.

        Raises:
            ScipError: it is damaged, or has the wrong length.
        """
        assert self.optics is not None  # noqa: S101
        have = joined(reply.lines[1:])
        ticks = decode(joined(reply.lines[:1]))
        measured = decode_all(have, 3)
        if len(measured) != self.optics.last - self.optics.first + 1:
            raise ScipError("not as many distances as were asked for")
        nearest, farthest = self.optics.nearest * 1000, self.optics.farthest * 1000
        # Values outside the limits are error codes of the scanner.
        measured[(measured < nearest) | (measured > farthest)] = 0
        ranges = np.where(measured > 0, measured / 1000, np.inf)
        first = (self.optics.first - self.optics.front) * self.optics.step
        if self._flipped:
            ranges, first = ranges[::-1].copy(), -first - (len(ranges) - 1) * self.optics.step
        ranges.flags.writeable = False
        scan = Scan(first + self._turned, self.optics.step, ranges, self.optics.farthest)
        self._count(ticks)
        stamp = self._clock()
        self._arrivals.count(stamp)
        self._seen.append((stamp, measured))
        while self._seen[0][0] < stamp - WINDOW:
            self._seen.popleft()
        taken = self._scanner_clock.measured(ticks / 1000, stamp)
        number = 1 if self._scan is None else self._scan.seq + 1
        self._scan = Stamped(scan, stamp, number, taken)
        self._refused, self._why = False, ""
        self._arrived.set()

    def _count(self, ticks: int) -> None:
        """Count the missed scans since the last one."""
        assert self.optics is not None  # noqa: S101
        if self._ticks is None:
            self.connected += 1
        else:
            turns = (ticks - self._ticks) % CLOCK * self.optics.rate / 1000
            self.missed += max(0, round(turns / (self._skip + 1)) - 1)
        self._ticks = ticks

    def _damaged(self) -> None:
        self.spoilt += 1
        self._warned = self._clock()
