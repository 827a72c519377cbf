"""A link by rosbridge under loss, freezes, slow readers, and invalid messages."""

from __future__ import annotations

import asyncio
import json
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from websockets.asyncio.client import connect

from tangy_hw.device_protocols import DeviceError
from tangy_hw.drivers.rosbridge import Rosbridge
from tangy_hw.drivers.rosbridge_parts import Fragments
from tangy_profiles.health import OK, STALE
from tests.hw.ros_links import SOON, Raw, done, linked, soon
from tests.support.waiting import until


class TestLink:
    async def test_a_restored_link_renews_all_subscriptions(self) -> None:
        said: list[str] = []
        async with linked(tell=said.append) as (server, bridge, _):
            heard: list[Any] = []
            bridge.subscribe("/odom", "nav_msgs/Odometry", heard.append)
            await soon(server.subscribed("/odom"))
            await server.close()
            await until(lambda: not bridge.connected)
            with pytest.raises(DeviceError, match="there is no link to ws://"):
                bridge.publish("/cmd_vel", {})
            await server.start()
            await soon(server.subscribed("/odom"))
            server.publish("/odom", "", {"n": 1})
            await until(lambda: heard == [{"n": 1}])
            assert [line for line in said if "was lost" in line]

    async def test_a_frozen_robot_stays_connected_and_its_data_ages(self) -> None:
        async with linked() as (server, bridge, now):
            bridge.subscribe("/odom", "nav_msgs/Odometry", lambda _: None)
            await soon(server.subscribed("/odom"))
            assert bridge.reading() == ("link", 0.0, STALE, {}, None)
            server.publish("/odom", "", {})
            await until(lambda: bridge.heard is not None)
            assert bridge.reading() == ("link", 0.0, OK, {}, None)
            for _ in range(6):
                now.time += 0.2
                before = bridge.heard
                server.publish("/odom", "", {})
                await until(lambda before=before: bridge.heard != before)  # type: ignore[misc]
            assert bridge.reading().rate == pytest.approx(5)
            server.pause()
            server.publish("/odom", "", {})
            now.time += 0.3
            await asyncio.sleep(0.05)
            assert bridge.connected
            assert bridge.reading().age == pytest.approx(0.3)
            server.resume()
            server.publish("/odom", "", {})
            await until(lambda: bridge.reading().age == 0)

    async def test_a_pause_can_spare_the_clock_of_a_bench(self) -> None:
        async with linked() as (server, bridge, _):
            ticks: list[Any] = []
            server.provide("/bench/advance", done)
            server.provide("/other", done)
            bridge.subscribe("/clock", "", ticks.append)
            bridge.subscribe("/odom", "", ticks.append)
            await soon(server.subscribed("/clock", "/odom"))
            server.pause(still=("/bench/advance", "clock"))
            server.publish("/odom", "", {"no": 1})
            server.publish("/clock", "", {"t": 1})
            other = asyncio.create_task(bridge.call("/other", {}))
            assert await soon(bridge.call("/bench/advance", {})) == {"done": True}
            assert ticks == [{"t": 1}]
            assert not other.done()
            server.resume()
            assert await soon(other) == {"done": True}

    async def test_messages_sent_during_a_pause_arrive_after_it_in_order(self) -> None:
        async with linked() as (server, bridge, _):
            heard: list[Any] = []
            server.on_message("/cmd_vel", lambda message: heard.append(message["n"]))
            server.pause()
            bridge.subscribe("/odom", "", print)
            for number in range(1_500):
                bridge.publish("/cmd_vel", {"n": number})
            server.provide("/done", done)
            call = asyncio.create_task(bridge.call("/done", {}, SOON))
            await asyncio.sleep(0.3)
            assert heard == []
            assert not server.is_subscribed("/odom")
            server.resume()
            assert await soon(call)
            assert heard[-1] == 1_499
            assert server.is_subscribed("/odom")

    async def test_a_client_that_does_not_read_delays_no_other(self) -> None:
        async with (
            linked() as (server, bridge, _),
            connect(server.url, compression=None, max_queue=1, close_timeout=0) as slow,
        ):
            await slow.send('{"op":"subscribe","topic":"/big"}')
            await soon(server.subscribed("/big"))
            heard: list[Any] = []
            bridge.subscribe("/small", "", heard.append)
            await soon(server.subscribed("/small"))
            for number in range(60):
                server.publish("/big", "", {"data": "x" * 400_000})
                server.publish("/small", "", {"n": number})
            await until(lambda: len(heard) == 60)

    @pytest.mark.parametrize(
        "url", ["", "robot", "http://robot:9090", "ws://", "ws://a:b", "ws://[x"]
    )
    def test_an_invalid_address_is_refused_in_one_sentence(self, url: str) -> None:
        with pytest.raises(DeviceError, match="give ws://HOST:PORT"):
            Rosbridge(url)


class TestOddMessages:
    async def test_an_invalid_message_is_reported_once_and_keeps_the_link(self) -> None:
        raw, said, heard = Raw(), list[str](), list[Any]()
        async with raw.serving(tell=said.append) as bridge:
            bridge.subscribe("/odom", "", lambda message: heard.append(message["n"]))
            for odd in ("", "{", "[1]", "7", "[" * 100_000, b"\x00\xff", '{"op":"png"}'):
                await raw.say(odd)
                await raw.say(odd)
            await raw.say({"op": "status", "level": "error", "msg": "no such\x1b[2J type"})
            messages: list[Any] = [{"m": 1}, [], None, 7, {"n": 1}]
            for message in messages:
                await raw.say({"op": "publish", "topic": "/odom", "msg": message})
            await raw.say({"op": "publish", "topic": "/odom"})
            await raw.say({"op": "service_response", "id": "never asked"})
            await raw.say({"op": "publish", "topic": "odom", "msg": {"n": 2}})
            await until(lambda: 2 in heard)
        assert heard == [1, 2]
        assert len(said) == len(set(said))
        assert not any("\x1b" in line for line in said)

    async def test_a_large_message_is_fragmented_on_request(self) -> None:
        message = {"data": list(range(500))}
        raw, heard = Raw(), list[Any]()
        async with linked() as (server, _, _), connect(server.url) as client:
            await client.send('{"op":"subscribe","topic":"/map","fragment_size":100}')
            await soon(server.subscribed("/map"))
            server.publish("/map", "", message)
            parts = [json.loads(await soon(client.recv()))]
            parts += [json.loads(await soon(client.recv())) for _ in range(parts[0]["total"] - 1)]
        async with raw.serving() as bridge:
            bridge.subscribe("/map", "", heard.append)
            for part in parts:
                await raw.say(part)
            await until(lambda: bool(heard))
        assert len(parts) > 10
        assert heard == [message]

    @given(st.text(min_size=1, max_size=60), st.integers(1, 9), st.randoms(use_true_random=False))
    def test_fragments_come_in_any_order(self, text: str, size: int, random: Any) -> None:
        parts = [text[place : place + size] for place in range(0, len(text), size)]
        numbered = [
            {"id": "a", "num": number, "total": len(parts), "data": part}
            for number, part in enumerate(parts)
        ]
        random.shuffle(numbered)
        whole = Fragments()
        assert [whole.take(part) for part in numbered] == [None] * (len(parts) - 1) + [text]

    def test_incomplete_fragments_are_dropped(self) -> None:
        whole = Fragments()
        for number in range(1_000):
            whole.take({"id": number, "num": 0, "total": 2, "data": "x"})
        assert len(whole.open_parts) <= 17
        with pytest.raises(ValueError, match="fragment"):
            whole.take({"id": "b", "num": 5, "total": 2, "data": "x"})
