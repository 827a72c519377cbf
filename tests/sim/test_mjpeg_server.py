"""Simulated network cameras send their newest picture, and fail like real ones."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator

import pytest

from tangy_sim.servers.mjpeg_server import MjpegServer
from tests.hw.waiting import PATIENCE, until


class Viewer:
    """A client that reads a stream part by part."""

    def __init__(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self._reader, self._writer = reader, writer
        self.head = b""

    @classmethod
    async def open(cls, server: MjpegServer, path: str) -> Viewer:
        reader, writer = await asyncio.open_connection("127.0.0.1", server.port)
        writer.write(f"GET {path} HTTP/1.1\r\nHost: here\r\n\r\n".encode())
        return cls(reader, writer)

    async def see(self) -> bytes:
        """Return the next JPEG; b"": the stream has ended."""
        async with asyncio.timeout(PATIENCE):
            try:
                if not self.head:
                    self.head = await self._reader.readuntil(b"\r\n\r\n")
                part = await self._reader.readuntil(b"\r\n\r\n")
                length = int(part.split(b"Content-Length:")[1].split(b"\r\n")[0])
                body = await self._reader.readexactly(length + 2)
            except (asyncio.IncompleteReadError, ConnectionError):
                return b""
        assert b"--frame\r\nContent-Type: image/jpeg" in part and body.endswith(b"\r\n")
        return body[:-2]

    def close(self) -> None:
        self._writer.transport.abort()


@pytest.fixture
async def server() -> AsyncIterator[MjpegServer]:
    made = MjpegServer()
    await made.start()
    yield made
    await made.close()


async def test_each_path_is_a_separate_camera(server: MjpegServer) -> None:
    head, infrared = await Viewer.open(server, "/head"), await Viewer.open(server, "/infrared?x=1")
    await until(lambda: all(camera.viewers == 1 for camera in server.camera.values()))
    server.push("/head", b"a head")
    server.push("/infrared", b"warm hands")
    assert (await head.see(), await infrared.see()) == (b"a head", b"warm hands")
    assert b"multipart/x-mixed-replace; boundary=frame" in head.head
    head.close()
    await until(lambda: server.camera["/head"].viewers == 0)


async def test_a_late_viewer_gets_the_newest_picture_at_once(server: MjpegServer) -> None:
    for picture in (b"one", b"two"):
        server.push("/head", picture)
    viewer = await Viewer.open(server, "/head")
    assert await viewer.see() == b"two"


async def test_a_slow_viewer_misses_pictures_but_gets_the_newest(server: MjpegServer) -> None:
    slow, quick = await Viewer.open(server, "/head"), await Viewer.open(server, "/head")
    await until(lambda: server.camera["/head"].viewers == 2)
    count, large = 60, bytes(200_000)
    for number in range(count):
        server.push("/head", large + bytes([number]))
        assert (await quick.see())[-1] == number  # a fast client sees every one
    seen = [(await slow.see())[-1]]
    while seen[-1] != count - 1:
        seen.append((await slow.see())[-1])
    assert seen == sorted(seen) and len(seen) < count / 2


async def test_a_limited_rate_still_delivers_the_newest_picture(
    server: MjpegServer,
) -> None:
    server.camera["/head"].rate = 10
    viewer = await Viewer.open(server, "/head")
    await server.somebody("/head")
    for picture in (b"one", b"two", b"three"):
        server.push("/head", picture)
    assert [await viewer.see(), await viewer.see()] == [b"one", b"three"]


async def test_a_frozen_camera_repeats_its_last_picture(server: MjpegServer) -> None:
    viewer = await Viewer.open(server, "/head")
    await server.somebody("/head")
    server.push("/head", b"before")
    assert await viewer.see() == b"before"
    server.camera["/head"].frozen = True
    server.push("/head", b"after")
    assert await viewer.see() == b"before"
    server.camera["/head"].frozen = False
    server.push("/head", b"after")
    assert await viewer.see() == b"after"


async def test_a_closed_camera_disconnects_only_its_viewers(server: MjpegServer) -> None:
    head, infrared = await Viewer.open(server, "/head"), await Viewer.open(server, "/infrared")
    await until(lambda: all(camera.viewers for camera in server.camera.values()))
    server.camera["/head"].closed = True
    assert await head.see() == b""
    assert await (await Viewer.open(server, "/head")).see() == b""
    server.push("/infrared", b"still here")
    assert await infrared.see() == b"still here"
    server.camera["/head"].closed = False
    server.push("/head", b"again")
    assert await (await Viewer.open(server, "/head")).see() == b"again"


async def test_a_hanging_camera_sends_nothing_and_disconnects_nobody(server: MjpegServer) -> None:
    viewer = await Viewer.open(server, "/head")
    await server.somebody("/head")
    server.push("/head", b"before")
    assert await viewer.see() == b"before"
    server.camera["/head"].hangs = True
    late = await Viewer.open(server, "/head")
    await until(lambda: server.camera["/head"].viewers == 2)
    server.push("/head", b"unseen")
    waiting = [asyncio.ensure_future(one.see()) for one in (viewer, late)]
    assert not (await asyncio.wait(waiting, timeout=0.1))[0]
    server.camera["/head"].hangs = False
    server.push("/head", b"seen")
    assert await asyncio.gather(*waiting) == [b"seen", b"seen"]


@pytest.mark.parametrize(
    "request_line", [b"GET /tail HTTP/1.0", b"POST /head HTTP/1.0", b"rubbish"]
)
async def test_unknown_paths_are_not_found(server: MjpegServer, request_line: bytes) -> None:
    reader, writer = await asyncio.open_connection("127.0.0.1", server.port)
    writer.write(request_line + b"\r\n\r\n")
    async with asyncio.timeout(PATIENCE):
        answer = await reader.read()
    assert answer.startswith(b"HTTP/1.0 404") and b"/head, /infrared" in answer
    writer.close()
