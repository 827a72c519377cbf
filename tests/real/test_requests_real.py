"""Requests from a real client of a real broker, and from signs in pictures on disk."""

from __future__ import annotations

import asyncio
from itertools import islice
from pathlib import Path

import cv2
import pytest

from tangy_hw.perception.requests.help_request_source import RequestError, RequestSource
from tangy_hw.perception.requests.mqtt import Topic
from tangy_hw.perception.requests.signs import SignRequests
from tangy_hw.perception.requests.sources import open_requests
from tangy_profiles.health import OK, STALE
from tangy_profiles.room import load_room
from tests.hw.signs import CORNERS, sequence
from tests.real.broker import Broker
from tests.support.terminal import PATIENCE

PEOPLE = ("ada", "ben", "cleo", "dot")


async def until(source: RequestSource, *seats: int) -> None:
    """Wait until exactly these people ask."""
    async with asyncio.timeout(PATIENCE):
        async for asks in source:
            if sorted(ask.seat for ask in asks) == list(seats):
                return
        raise AssertionError(f"it ended with {source.asking}")


async def stale(source: RequestSource, state: str) -> None:
    """Wait until a source reports a state."""
    async with asyncio.timeout(PATIENCE):
        while source.reading().state != state:  # noqa: ASYNC110 - nobody tells
            await asyncio.sleep(0.01)


class TestMqtt:
    async def test_messages_set_and_clear_requests(self) -> None:
        async with Broker() as broker, Topic(broker.url, 4, PEOPLE) as source:
            await asyncio.wait_for(broker.listened_to(), PATIENCE)
            assert broker.subscribed == ["tangy/requests/#"]
            broker.publish("tangy/requests/3", b"1", retain=True)  # left from yesterday
            broker.publish("tangy/requests/2", b"1")
            await until(source, 2)
            broker.publish("tangy/requests/dot", b'{"action": "single"}')
            await until(source, 2, 4)
            assert [ask.person for ask in source.asking] == ["ben", "dot"]
            broker.publish("tangy/requests/2", b"0")
            await until(source, 4)
            assert source.reading().state == OK

    async def test_a_lost_broker_is_reported_until_it_returns(self) -> None:
        told: list[str] = []
        async with Broker() as broker:
            source = Topic(broker.url, 4, PEOPLE)
            source.tell = told.append
            async with source:
                await asyncio.wait_for(broker.listened_to(), PATIENCE)
                broker.publish("tangy/requests/1", b"1")
                await until(source, 1)
                await broker.unplug()
                await stale(source, STALE)
                assert source.reading().age >= 0
                assert [ask.seat for ask in source.asking] == [1]  # the request is remembered
                await broker.listen()
                await asyncio.wait_for(broker.listened_to(), PATIENCE)
                broker.publish("tangy/requests/2", b"1")
                await until(source, 1, 2)
                assert source.reading().state == OK
        assert told[0].startswith("Listening at mqtt://127.0.0.1:")
        assert "the connection was lost. It is tried again." in told[1]

    async def test_a_refusing_broker_is_reported(self) -> None:
        async with Broker() as broker:
            broker.refuses = True
            source = Topic(broker.url, 4)
            said: asyncio.Future[str] = asyncio.get_running_loop().create_future()
            source.tell = lambda sentence: None if said.done() else said.set_result(sentence)
            async with source:
                sentence = await asyncio.wait_for(said, PATIENCE)
        assert "it refuses us: not authorized" in sentence


class TestSigns:
    @pytest.fixture
    def pictures(self, tmp_path: Path) -> Path:
        """A table at which two people hold their signs up, and then turn them down."""
        seed = next(
            seed for seed in range(9_000, 9_100) if len(next(sequence(seed, 1)).asking) == 2
        )
        scenes = [*sequence(seed, 10), *islice(sequence(seed, 10, signs=False), 6)]
        for number, scene in enumerate(scenes):
            cv2.imwrite(str(tmp_path / f"{number}.png"), scene.image)
        self.asking = sorted(seat + 1 for seat in scenes[0].asking)
        return tmp_path

    @pytest.mark.slow
    async def test_signs_are_requests_of_their_seats_until_they_go_down(
        self, pictures: Path
    ) -> None:
        source = open_requests(f"signs:{pictures}", load_room(), PEOPLE, corners=CORNERS, each=True)
        assert isinstance(source, SignRequests)
        async with source:
            given = [[(ask.seat, ask.person) for ask in asks] async for asks in source]
        most = max(given, key=len)
        assert sorted(most) == [(seat, PEOPLE[seat - 1]) for seat in self.asking]
        assert source.asking == ()

    @pytest.mark.slow
    async def test_a_file_that_cannot_be_read_is_an_error(self, tmp_path: Path) -> None:
        (tmp_path / "a.avi").write_bytes(b"no video")
        source = open_requests(f"signs:{tmp_path / 'a.avi'}", load_room(), PEOPLE, corners=CORNERS)
        async with source:
            with pytest.raises(RequestError, match="no video that can be read"):
                await until(source, 1)

    async def test_a_missing_camera_is_stale(self) -> None:
        source = open_requests("signs:/dev/video93", load_room(), PEOPLE, corners=CORNERS)
        async with source:
            await stale(source, STALE)
            assert source.reading().device == "requests"
