"""A simulated laser scanner on the network or a serial port; the bench supplies its scans."""

from __future__ import annotations

import asyncio
import contextlib
import os
import tty
from collections.abc import Callable, Iterator
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from tangy_sim.servers.connections import Connections
from tangy_sim.servers.scip_session import CLOCK, URG, Scanner, ScipSession

MOST_UNSENT = 1 << 18
"""Queued bytes of a slow client, after which it misses scans, as with a real scanner."""


class _Wire(Protocol):
    session: ScipSession

    @property
    def unsent(self) -> int: ...

    def cut(self) -> None: ...


class ScipServer(Connections[_Wire]):
    """Answers as a SCIP 2.0 scanner, and sends each scan to every measuring client.

    Faults: while `silent`, it sends nothing, and requests are lost; while `closed`, connections are
    cut, and new ones at once; `fault` is the status of a broken scanner ("0L", or "70" for a
    stalled motor), sent instead of scans.
    """

    def __init__(self, scanner: Scanner = URG) -> None:
        super().__init__()
        self.scanner = scanner
        self.silent = False
        self.fault = ""
        self.sent = 0
        """Scans sent to at least one client."""
        self.port = 0
        self.cable: Callable[[bytes], bytes] = bytes
        """Transmission fault applied to replies."""
        self._now = 0
        self._server: asyncio.Server | None = None
        self._ready = asyncio.Event()

    @property
    def url(self) -> str:
        """Address of the server."""
        return f"tcp://127.0.0.1:{self.port}"

    @property
    def measuring(self) -> int:
        """Number of clients waiting for scans."""
        return sum(wire.session.measuring for wire in self.connections)

    async def start(self, host: str = "127.0.0.1", port: int = 0) -> None:
        """Start to listen, by default at a free port."""
        loop = asyncio.get_running_loop()
        self._server = await loop.create_server(lambda: _Connection(self), host, port)
        self.port = self._server.sockets[0].getsockname()[1]

    def serve_serial(self, path: str = "") -> str:
        """Also serve a serial port: the given one, or a new pseudo-terminal.

        When the server is `closed`, it is unplugged for good.

        Returns:
            The port for clients: the other end of a new one, otherwise `path`.
        """
        if path:
            near = os.open(path, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
            far = path
            self.connections.add(_Port(self, near))
        else:
            near, other = os.openpty()
            tty.setraw(other)
            os.set_blocking(near, False)
            far = os.ttyname(other)
            # The held end keeps the port open when a client leaves.
            self.connections.add(_Port(self, near, held=other))
            return far
        tty.setraw(near)
        return far

    def send(self, ranges: NDArray[np.float64], stamp_ms: int) -> int:
        """Send a scan, (n,) in m, to all measuring clients.

        Args:
            ranges: range of each beam in m; inf or out of the scanner's limits: no return.
            stamp_ms: the scanner's time in ms.

        Returns:
            The number of clients that got it.

        Raises:
            ValueError: it has not as many ranges as the scanner has beams.
        """
        if len(ranges) != self.scanner.beams:
            raise ValueError(f"{len(ranges)} ranges for {self.scanner.beams} beams")
        self._now = stamp_ms
        distances = in_millimetres(self.scanner, ranges)
        got = 0
        for wire in tuple(self.connections):
            wire.session.fault = self.fault
            if not self.silent and wire.unsent < MOST_UNSENT:
                got += wire.session.offer(distances, stamp_ms % CLOCK)
        self.sent += got > 0
        return got

    async def somebody(self, count: int = 1) -> None:
        """Wait until `count` clients measure."""
        while self.measuring < count:
            self._ready.clear()
            await self._ready.wait()

    async def close(self) -> None:
        """Stop, and close all connections."""
        self.cut()
        if self._server is not None:
            self._server.close()
            await self._server.wait_closed()

    def _joined(self, wire: _Wire) -> None:
        self.connections.add(wire)

    def _left(self, wire: _Wire) -> None:
        self.connections.discard(wire)

    def _heard(self, wire: _Wire, came: bytes) -> None:
        if not self.silent:
            wire.session.fault = self.fault
            wire.session.feed(came)
            self._ready.set()


def in_millimetres(scanner: Scanner, ranges: NDArray[np.float64]) -> NDArray[np.int64]:
    """Return ranges (n,) in mm in the scanner's encoding: out of its limits is `nothing`."""
    with np.errstate(invalid="ignore"):
        reached = (ranges >= scanner.nearest) & (ranges <= scanner.farthest)
    whole = np.rint(np.where(reached, ranges, 0.0) * 1000).astype(np.int64)
    return np.where(reached, whole, scanner.nothing)


class _Connection(asyncio.Protocol):
    """A TCP client."""

    def __init__(self, server: ScipServer) -> None:
        self._server = server
        self._transport: asyncio.Transport | None = None
        self.session = ScipSession(server.scanner, self._send)

    @property
    def unsent(self) -> int:
        return self._transport.get_write_buffer_size() if self._transport is not None else 0

    def cut(self) -> None:
        self._server._left(self)
        if self._transport is not None:
            self._transport.abort()

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        assert isinstance(transport, asyncio.Transport)  # noqa: S101
        self._transport = transport
        if self._server.closed:
            transport.abort()
        else:
            self._server._joined(self)

    def data_received(self, data: bytes) -> None:
        self._server._heard(self, data)

    def connection_lost(self, error: Exception | None) -> None:
        self._server._left(self)

    def _send(self, answer: bytes) -> None:
        if self._transport is not None:
            self._transport.write(self._server.cable(answer))


class _Port:
    """A client at a serial port."""

    def __init__(self, server: ScipServer, port: int, held: int | None = None) -> None:
        self._server, self._port, self._held = server, port, held
        self._waiting = bytearray()
        self._gone = False
        self._loop = asyncio.get_running_loop()
        self._loop.add_reader(port, self._receive)
        self.session = ScipSession(server.scanner, self._send)

    @property
    def unsent(self) -> int:
        return len(self._waiting)

    def cut(self) -> None:
        if self._gone:
            return
        self._gone = True
        self._server._left(self)
        self._loop.remove_reader(self._port)
        self._loop.remove_writer(self._port)
        for port in (self._port, self._held):
            if port is not None:
                os.close(port)

    def _receive(self) -> None:
        with self._cut_at_need():
            came = os.read(self._port, 4096)
            if not came:  # the other end was unplugged
                self.cut()
            self._server._heard(self, came)

    def _send(self, answer: bytes) -> None:
        self._waiting += self._server.cable(answer)
        self._flush()

    def _flush(self) -> None:
        if self._gone:
            return
        self._loop.remove_writer(self._port)
        with self._cut_at_need():
            try:
                while self._waiting:
                    del self._waiting[: os.write(self._port, self._waiting)]
            except BlockingIOError:
                self._loop.add_writer(self._port, self._flush)

    @contextlib.contextmanager
    def _cut_at_need(self) -> Iterator[None]:
        try:
            yield
        except BlockingIOError:
            pass
        except OSError:
            self.cut()
