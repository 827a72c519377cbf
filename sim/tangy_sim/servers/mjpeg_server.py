"""Network cameras that stream MJPEG over HTTP, each at its own path."""

from __future__ import annotations

import asyncio
import socket
from collections.abc import Iterable

from tangy_sim.servers.connections import Connections

PATHS = ("/head", "/infrared")
BOUNDARY = b"frame"
HEAD = (
    b"HTTP/1.0 200 OK\r\nCache-Control: no-store\r\nConnection: close\r\n"
    b"Content-Type: multipart/x-mixed-replace; boundary=" + BOUNDARY + b"\r\n\r\n"
)
PART = b"--" + BOUNDARY + b"\r\nContent-Type: image/jpeg\r\nContent-Length: %d\r\n\r\n"
LONGEST_REQUEST = 8192
KERNEL_BYTES = 1 << 17
"""Bytes buffered for a slow viewer; more would only hold old frames."""


class JpegStream(Connections["_Viewer"]):
    """One camera: it sends every viewer the newest JPEG; slow viewers skip frames.

    Faults: while `frozen`, each new frame repeats the last one; while `closed`, viewers are
    disconnected, and new ones at once; while `hangs`, they stay connected and get nothing.
    """

    def __init__(self, path: str) -> None:
        super().__init__()
        self.path = path
        self.frozen = False
        self.hangs = False
        self.newest = b""
        self.pushed = 0
        """Number of frames pushed."""
        self.rate = 0.0
        """Maximum frames a second sent to a viewer; 0: all."""

    @property
    def viewers(self) -> int:
        """Number of viewers."""
        return len(self.connections)

    def push(self, jpeg: bytes) -> None:
        """Send a new frame."""
        self.pushed += 1
        if not (self.frozen and self.newest):
            self.newest = jpeg
        for viewer in tuple(self.connections):
            viewer.show(self.newest)


class MjpegServer:
    """Cameras at one port; `camera["/head"].frozen = True` injects a fault."""

    def __init__(self, paths: Iterable[str] = PATHS) -> None:
        self.camera = {path: JpegStream(path) for path in paths}
        self.port = 0
        self._open: set[_Viewer] = set()
        self._server: asyncio.Server | None = None
        self._ready = asyncio.Event()

    async def start(self, host: str = "127.0.0.1", port: int = 0) -> None:
        """Start to listen, by default at a free port."""
        loop = asyncio.get_running_loop()
        self._server = await loop.create_server(lambda: _Viewer(self), host, port)
        self.port = self._server.sockets[0].getsockname()[1]

    def url(self, path: str) -> str:
        """Return the address of a camera."""
        return f"http://127.0.0.1:{self.port}{path}"

    def push(self, path: str, jpeg: bytes) -> None:
        """Send a new frame at a path."""
        self.camera[path].push(jpeg)

    async def somebody(self, path: str) -> None:
        """Wait until a camera has a viewer."""
        while not self.camera[path].viewers:
            self._ready.clear()
            await self._ready.wait()

    async def close(self) -> None:
        """Stop, and disconnect all viewers."""
        for viewer in tuple(self._open):
            viewer.cut()
        if self._server is not None:
            self._server.close()
            await self._server.wait_closed()


class _Viewer(asyncio.Protocol):
    """A viewer's connection: an unsent frame is replaced by the next one."""

    def __init__(self, server: MjpegServer) -> None:
        self._server = server
        self._asked = b""
        self._camera: JpegStream | None = None
        self._transport: asyncio.Transport | None = None
        self._begun = False
        self._full = False
        self._next = b""
        self._due = 0.0
        self._timer: asyncio.TimerHandle | None = None
        self._loop = asyncio.get_running_loop()

    def show(self, jpeg: bytes) -> None:
        """Send a frame, or the newest one once the connection is writable."""
        self._next = jpeg
        self._send()

    def cut(self) -> None:
        """Disconnect."""
        if self._camera is not None:
            self._camera.connections.discard(self)
        if self._timer is not None:
            self._timer.cancel()
        if self._transport is not None:
            self._transport.abort()

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        assert isinstance(transport, asyncio.Transport)  # noqa: S101
        self._transport = transport
        self._server._open.add(self)
        transport.set_write_buffer_limits(high=0)
        connection = transport.get_extra_info("socket")
        connection.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, KERNEL_BYTES)

    def data_received(self, data: bytes) -> None:
        if self._camera is not None or self._transport is None:
            return
        self._asked += data
        if len(self._asked) > LONGEST_REQUEST:
            self.cut()
        elif b"\r\n\r\n" in self._asked:
            self._answer(self._asked.split(b"\r\n", 1)[0].split(b" "))

    def connection_lost(self, error: Exception | None) -> None:
        self._server._open.discard(self)
        self._transport = None
        self.cut()

    def pause_writing(self) -> None:
        self._full = True

    def resume_writing(self) -> None:
        self._full = False
        self._send()

    def _answer(self, words: list[bytes]) -> None:
        assert self._transport is not None  # noqa: S101
        path = words[1].partition(b"?")[0].decode("ascii", "replace") if len(words) > 1 else ""
        camera = self._server.camera.get(path)
        if words[0] != b"GET" or camera is None:
            there = ", ".join(self._server.camera).encode()
            self._transport.write(
                b"HTTP/1.0 404 Not Found\r\nContent-Type: text/plain\r\n\r\nCameras: %b\n" % there
            )
            self._transport.close()
            return
        if camera.closed:
            self.cut()
            return
        self._camera = camera
        camera.connections.add(self)
        self._server._ready.set()
        self.show(camera.newest)

    def _send(self) -> None:
        camera = self._camera
        if self._transport is None or camera is None or camera.hangs or self._full:
            return
        if not self._begun:
            self._begun = True
            self._transport.write(HEAD)
        if not self._next or self._full or self._timer is not None:
            return
        now = self._loop.time()
        if camera.rate and now < self._due:
            self._timer = self._loop.call_at(self._due, self._again)
            return
        self._due = now + (1 / camera.rate if camera.rate else 0.0)
        jpeg, self._next = self._next, b""
        self._transport.write(PART % len(jpeg) + jpeg + b"\r\n")

    def _again(self) -> None:
        self._timer = None
        self._send()
