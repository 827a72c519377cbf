"""The camera driver reads the simulated network camera, and notices its faults."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator

import cv2
import numpy as np
import pytest

from tangy_hw.drivers.camera import Camera
from tangy_hw.drivers.camera_source import find_camera
from tangy_sim.servers.mjpeg_server import MjpegServer
from tests.hw.pictures import encoded, room, seen
from tests.hw.waiting import until
from tests.support.terminal import PATIENCE

RATE = 15.0


@pytest.fixture
async def filming() -> AsyncIterator[MjpegServer]:
    """A server whose head camera looks at a room."""
    server = MjpegServer()
    await server.start()
    rng = np.random.default_rng(1)
    still = room(1, 320, 240)
    pictures = [encoded(seen(still, rng, noise=2)).tobytes() for _ in range(int(RATE))]

    async def film() -> None:
        number = 0
        while True:
            server.push("/head", pictures[number % len(pictures)])
            number += 1
            await asyncio.sleep(1 / RATE)

    task = asyncio.create_task(film())
    yield server
    task.cancel()
    await server.close()


@pytest.mark.slow
async def test_the_camera_driver_reads_the_stream_and_notices_every_fault(
    filming: MjpegServer,
) -> None:
    def is_in(*states: str) -> bool:
        return camera.sight.state in states

    async with Camera(find_camera(filming.url("/head"))) as camera:
        await until(lambda: is_in("OK"), PATIENCE)
        frame = await anext(aiter(camera))
        assert cv2.absdiff(frame.image(), room(1, 320, 240)).mean() < 8
        assert camera.reading().state == "OK"
        head = filming.camera["/head"]
        head.frozen = True
        await until(lambda: is_in("FROZEN"), PATIENCE)
        head.frozen = False
        await until(lambda: is_in("OK"), PATIENCE)
        head.closed = True
        await until(lambda: is_in("DISCONNECTED"), PATIENCE)
        head.closed = False
        await until(lambda: is_in("OK"), PATIENCE)
        head.hangs = True
        await until(lambda: is_in("DISCONNECTED"), PATIENCE)
        head.hangs = False
        await until(lambda: is_in("OK"), PATIENCE)
