"""A minimal broker of MQTT 3.1.1 on the loopback: it publishes what a test says."""

from __future__ import annotations

import asyncio
import struct
from contextlib import suppress


class Broker:
    """Takes connections and subscriptions, and publishes a test's messages to all of them."""

    def __init__(self) -> None:
        self.port = 0
        self.subscribed: list[str] = []
        self.refuses = False
        self._server: asyncio.Server | None = None
        self._writers: set[asyncio.StreamWriter] = set()
        self._arrived = asyncio.Event()

    async def __aenter__(self) -> Broker:
        await self.listen()
        return self

    async def __aexit__(self, *_: object) -> None:
        await self.unplug()

    @property
    def url(self) -> str:
        return f"mqtt://127.0.0.1:{self.port}/tangy/requests"

    async def listen(self) -> None:
        """Listen at the same port as before."""
        self._server = await asyncio.start_server(self._serve, "127.0.0.1", self.port)
        self.port = self._server.sockets[0].getsockname()[1]

    async def unplug(self) -> None:
        """Break off all connections, and refuse new ones until `listen`."""
        if self._server is not None:
            self._server.close()
        for writer in list(self._writers):
            writer.transport.abort()
        self._arrived.clear()

    async def listened_to(self) -> None:
        """Wait until a client has subscribed."""
        await self._arrived.wait()

    def publish(self, topic: str, payload: bytes, *, retain: bool = False) -> None:
        """Publish to all subscribers."""
        name = topic.encode()
        body = struct.pack(">H", len(name)) + name + payload
        for writer in self._writers:
            writer.write(bytes([0x31 if retain else 0x30]) + _length(len(body)) + body)

    async def _serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        with suppress(asyncio.IncompleteReadError, ConnectionError):
            while True:
                (first,) = await reader.readexactly(1)
                size, shift = 0, 0
                while True:
                    (part,) = await reader.readexactly(1)
                    size |= (part & 0x7F) << shift
                    shift += 7
                    if part < 0x80:
                        break
                body = await reader.readexactly(size)
                match first >> 4:
                    case 1:
                        writer.write(bytes((0x20, 2, 0, 5 if self.refuses else 0)))
                    case 8:
                        length = struct.unpack_from(">H", body, 2)[0]
                        self.subscribed.append(body[4 : 4 + length].decode())
                        writer.write(bytes((0x90, 3)) + body[:2] + b"\x01")
                        self._writers.add(writer)
                        self._arrived.set()
                    case 12:
                        writer.write(bytes((0xD0, 0)))
                    case 14:
                        break
        self._writers.discard(writer)
        writer.close()


def _length(size: int) -> bytes:
    made = b""
    while True:
        size, part = size >> 7, size & 0x7F
        made += bytes([part | (0x80 if size else 0)])
        if not size:
            return made
