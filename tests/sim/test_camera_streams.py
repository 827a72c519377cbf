"""The stream of the bench's head camera."""

from __future__ import annotations

import asyncio
import socket
from threading import Event

import pytest

from tangy_profiles.activity import load_activity
from tangy_profiles.defaults import USUAL_ROBOT
from tangy_profiles.person import load_people
from tangy_profiles.robot import load_robot
from tangy_profiles.room import room_for
from tangy_sim.device_simulator.camera_streams import HEAD, CameraStreams
from tangy_sim.device_simulator.camera_views import HeadCamera
from tangy_sim.device_simulator.world import BenchWorld


async def test_the_stream_goes_on_while_cards_are_drawn_in_advance(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    people = load_people(4)
    world = BenchWorld(room_for(4), load_robot(USUAL_ROBOT), load_activity("bingo"), people, seed=1)
    streams = CameraStreams(world, {p.id: n for n, p in enumerate(people, 1)}, seed=1)
    goes_on, begun = Event(), Event()

    def slow(_camera: HeadCamera, _game: int, _who: int, _card: int) -> None:
        begun.set()
        goes_on.wait(10)

    monkeypatch.setattr(HeadCamera, "prepare", slow)
    await streams.start()
    try:
        host, port = "127.0.0.1", int(streams.url(HEAD).split(":")[2].split("/")[0])
        with socket.create_connection((host, port)) as viewer:
            viewer.sendall(b"GET /head HTTP/1.0\r\n\r\n")
            world.games = 1
            world.people.sitters["user1"].card = 17
            async with asyncio.timeout(8):
                while not begun.is_set():  # noqa: ASYNC110 - another thread sets it
                    await asyncio.sleep(0.02)
                sent = streams.sent["head"]
                while streams.sent["head"] < sent + 3:  # noqa: ASYNC110 - a counter
                    await asyncio.sleep(0.02)
    finally:
        goes_on.set()
        await streams.close()
