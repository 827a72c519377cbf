"""Forwards a laptop's microphone to the program that listens at a socket.

Sound is never stored: if it cannot be sent at once, the oldest is dropped, so that nobody is heard
long after they spoke.
"""

from __future__ import annotations

import asyncio
import contextlib
import socket
import time
from collections import deque
from collections.abc import Callable
from pathlib import Path

from tangy_hw.audio.meter import Meter
from tangy_hw.audio.socket_place import connect
from tangy_hw.audio.socket_source import LISTENING, TAKEN
from tangy_hw.audio.source import Source
from tangy_hw.audio.wav import RATE, SoundError

KEPT = 2 * RATE // 8  # bytes, 1/8 s; the socket's buffer holds as much again
SOCKET_HOLDS = 4_096  # bytes of the requested socket buffer
PIECE = 2 * RATE // 50  # bytes, 20 ms; larger writes make the system buffer more
AGAIN_SECONDS = 0.3  # between two attempts to connect
LAST_SECONDS = 1.0  # timeout for the last sound
PACE = 2 * RATE // 20  # bytes of a recording sent at once, 50 ms

SPEED_SECONDS = 4.0  # measurement window of the data rate
TOO_FAST, TOO_SLOW = 1.4, 0.7  # of real time


class TakenOver(SoundError):
    """Another microphone has replaced this one."""


class Forwarder:
    """Forwards sound from a source whenever a program listens at the socket."""

    def __init__(
        self,
        source: Source,
        path: Path,
        *,
        tell: Callable[[str], None],
        clock: Callable[[], float] = time.monotonic,
        again: float = AGAIN_SECONDS,
    ) -> None:
        """Prepare to forward a source.

        Args:
            source: the source, which is closed at the end.
            path: path of the socket.
            tell: called with a sentence about each change.
            clock: returns a time in s.
            again: seconds between two attempts to connect.
        """
        self.meter = Meter(clock)
        self.dropped = 0
        """Bytes that a listener took too slowly."""
        self._source = source
        self._path = path
        self._tell = tell
        self._again = again
        self._speed = _Speed(clock)
        self._waiting: deque[bytes] = deque()
        self._arrived = asyncio.Event()
        self._connection = asyncio.Event()
        self._told_waiting = False
        self._over = False

    @property
    def connected(self) -> bool:
        """Whether a program takes the sound."""
        return self._connection.is_set()

    async def run(self) -> None:
        """Forward sound until the source ends.

        Raises:
            SoundError: the source cannot be used, the socket belongs to another user, or another
                microphone has replaced this one (`TakenOver`).
        """
        taking = asyncio.create_task(self._take())
        giving = asyncio.create_task(self._give())
        tasks = {taking, giving}
        try:
            await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
            if taking.done():
                taking.result()
                if self.connected:
                    await asyncio.wait({giving}, timeout=LAST_SECONDS)
            if giving.done():
                giving.result()
        finally:
            for task in tasks:
                task.cancel()
            await asyncio.wait(tasks)
            await self._source.close()

    async def _take(self) -> None:
        try:
            async for chunk in self._source:
                if self._source.live:
                    self._keep(chunk)
                    continue
                for place in range(0, len(chunk), PACE):  # at the speed of speech
                    await self._connection.wait()
                    self._keep(chunk[place : place + PACE])
                    await asyncio.sleep(PACE / RATE / 2)
        finally:
            self._over = True
            self._arrived.set()

    def _keep(self, chunk: bytes) -> None:
        self.meter.feed(chunk)
        odd = self._speed.odd(len(chunk)) if self._source.live else ""
        if odd:
            self._tell(odd)
        if not self.connected:
            return
        pieces = (chunk[place : place + PIECE] for place in range(0, len(chunk), PIECE))
        self._waiting.extend(pieces)
        kept = sum(map(len, self._waiting))
        while kept > max(KEPT, PIECE):
            dropped = len(self._waiting.popleft())
            kept -= dropped
            self.dropped += dropped
        self._arrived.set()

    async def _give(self) -> None:
        while not self._over:
            connection = await self._connected()
            with contextlib.closing(connection):
                await self._serve(connection)
            if self.connected and not self._over:
                self._tell("Tangy has closed; waiting until it listens again.")
                self._told_waiting = True
            self._connection.clear()
            self._waiting.clear()
            if not self._over:
                await asyncio.sleep(self._again)

    async def _connected(self) -> socket.socket:
        """Connect once a program listens."""
        while (connection := connect(self._path)) is None:
            if not self._told_waiting:
                self._tell("Tangy does not listen yet; start it with --mic socket. Waiting.")
            self._told_waiting = True
            await asyncio.sleep(self._again)
        connection.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, SOCKET_HOLDS)
        return connection

    async def _serve(self, connection: socket.socket) -> None:
        """Forward sound until the other side closes, or all is sent."""
        watching = asyncio.create_task(self._watch(connection))
        sending = asyncio.create_task(self._send(connection))
        try:
            await asyncio.wait({watching, sending}, return_when=asyncio.FIRST_COMPLETED)
            if sending.done() and not sending.result():
                await watching  # it knows why nothing can be sent
            if watching.done():
                watching.result()
        finally:
            for task in (watching, sending):
                task.cancel()
            await asyncio.wait({watching, sending})

    async def _watch(self, connection: socket.socket) -> None:
        """Read messages of the other side until it closes."""
        loop = asyncio.get_running_loop()
        said = b""
        with contextlib.suppress(ConnectionError):
            while heard := await loop.sock_recv(connection, 100):
                *lines, said = (said + heard).split(b"\n")
                for line in lines:
                    if line + b"\n" == LISTENING:
                        self._connection.set()
                        self._tell("Connected: Tangy listens to this microphone.")
                    elif line + b"\n" == TAKEN:
                        raise TakenOver("Another microphone has taken over; this one has ended.")

    async def _send(self, connection: socket.socket) -> bool:
        """Send queued sound as it arrives; return False if it cannot be sent."""
        loop = asyncio.get_running_loop()
        while True:
            await self._arrived.wait()
            self._arrived.clear()
            while self._waiting:
                try:
                    await loop.sock_sendall(connection, self._waiting.popleft())
                except OSError:
                    return False
            if self._over:
                return True


class _Speed:
    """Detects sound that arrives faster or slower than real time, and reports it once."""

    def __init__(self, clock: Callable[[], float]) -> None:
        self._clock = clock
        self._since: float | None = None
        self._bytes = 0
        self._speeds: list[float] = []

    def odd(self, count: int) -> str:
        """Count bytes; return a sentence when their rate is wrong for the first time."""
        now = self._clock()
        if self._since is None:
            self._since = now  # earlier data was buffered somewhere
            return ""
        self._bytes += count
        seconds = now - self._since
        if seconds < SPEED_SECONDS:
            return ""
        self._speeds.append(self._bytes / seconds / (2 * RATE))
        self._since, self._bytes = now, 0
        if len(self._speeds) != 3:  # the first may include buffered data; two must agree
            return ""
        low, high = sorted(self._speeds[1:])
        if low <= TOO_FAST and high >= TOO_SLOW:
            self._speeds.pop()
            return ""
        return (
            f"The sound comes {high:.1f} times as fast as it should: record 16,000 samples a "
            "second, one channel, 16 bits."
        )
