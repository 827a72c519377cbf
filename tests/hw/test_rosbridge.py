"""The link by rosbridge: topics, services and actions through a server, and what befalls a link."""

from __future__ import annotations

import asyncio
import json
import math
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from websockets.asyncio.client import connect
from websockets.asyncio.server import ServerConnection, serve

from tangy_hw.devices import DeviceError
from tangy_hw.drivers.rosbridge import Rosbridge
from tangy_hw.drivers.rosbridge_parts import Fragments
from tangy_profiles.health import OK, STALE
from tangy_sim.wires.rosbridge_server import RosbridgeServer

SOON = 5  # s within which what must happen at once has happened on any machine


@asynccontextmanager
async def linked(**settings: Any) -> AsyncIterator[tuple[RosbridgeServer, Rosbridge]]:
    server = RosbridgeServer()
    await server.start()
    bridge = Rosbridge(server.url, **settings)
    await bridge.start()
    assert await bridge.wait_connected(SOON)
    try:
        yield server, bridge
    finally:
        await bridge.close()
        await server.close()


async def soon(thing: Awaitable[Any]) -> Any:
    return await asyncio.wait_for(thing, SOON)


async def until(holds: Callable[[], bool]) -> None:
    async def looking() -> None:
        while not holds():  # noqa: ASYNC110 (whatever holds, there is no event of it)
            await asyncio.sleep(0.002)

    await soon(looking())


class Raw:
    """A server that is told by the test what to say, and keeps what it heard."""

    def __init__(self) -> None:
        self.heard: list[dict[str, Any]] = []
        self.link: ServerConnection | None = None

    @asynccontextmanager
    async def serving(self, **settings: Any) -> AsyncIterator[Rosbridge]:
        async def attend(link: ServerConnection) -> None:
            self.link = link
            async for text in link:
                self.heard.append(json.loads(text))

        async with serve(attend, "127.0.0.1", 0, compression=None) as server:
            port = next(iter(server.sockets)).getsockname()[1]
            bridge = Rosbridge(f"ws://127.0.0.1:{port}", **settings)
            await bridge.start()
            assert await bridge.wait_connected(SOON)
            await until(lambda: self.link is not None)
            yield bridge
            await bridge.close()

    async def say(self, text: str | bytes | dict[str, Any]) -> None:
        assert self.link is not None
        await self.link.send(json.dumps(text) if isinstance(text, dict) else text)


class TestTopics:
    async def test_what_is_published_is_heard_by_those_who_subscribed_alone(self) -> None:
        async with linked() as (server, bridge):
            heard: list[Any] = []
            bridge.subscribe("odom", "nav_msgs/Odometry", heard.append)
            await soon(server.subscribed("/odom"))
            server.publish("/other", "std_msgs/String", {"data": "no"})
            server.publish("/odom", "nav_msgs/Odometry", {"n": np.array([1.0, math.inf])})
            await until(lambda: bool(heard))
            assert heard == [{"n": [1.0, None]}]

    async def test_what_a_client_publishes_reaches_the_simulator_and_other_clients(self) -> None:
        async with linked() as (server, bridge):
            other, mine, theirs = Rosbridge(server.url), list[Any](), list[Any]()
            await other.start()
            other.subscribe("/say", "std_msgs/String", theirs.append)
            server.on_message("/say", mine.append)
            await soon(server.subscribed("/say"))
            bridge.advertise("/say", "std_msgs/String")
            bridge.publish("/say", {"data": "hello"})
            await until(lambda: bool(theirs))
            await other.close()
            assert mine == theirs == [{"data": "hello"}]

    async def test_nothing_is_heard_after_unsubscribing(self) -> None:
        async with linked() as (server, bridge):
            heard: list[Any] = []
            bridge.subscribe("/odom", "nav_msgs/Odometry", heard.append)
            await soon(server.subscribed("/odom"))
            bridge.unsubscribe("/odom", heard.append)
            await until(lambda: not server.is_subscribed("/odom"))

    async def test_a_throttled_topic_comes_as_seldom_as_was_wished(self) -> None:
        now = 0.0
        server = RosbridgeServer(clock=lambda: now)
        await server.start()
        bridge, heard = Rosbridge(server.url), list[Any]()
        bridge.subscribe("/scan", "sensor_msgs/LaserScan", heard.append, throttle=0.2)
        await bridge.start()
        await soon(server.subscribed("/scan"))
        for number in range(21):
            now = number / 20
            server.publish("/scan", "", {"at": number})
        server.provide("/done", done)
        await soon(bridge.call("/done", {}))
        await bridge.close()
        await server.close()
        assert [message["at"] for message in heard] == [0, 4, 8, 12, 16, 20]

    async def test_types_are_spelled_as_the_robot_s_ros_does(self) -> None:
        raw = Raw()
        async with raw.serving(ros=2) as bridge:
            bridge.subscribe("/odom", "nav_msgs/Odometry", print)
            bridge.advertise("/cmd_vel", "geometry_msgs/Twist")
            await until(lambda: len(raw.heard) == 2)
        assert [message["type"] for message in raw.heard] == [
            "nav_msgs/msg/Odometry",
            "geometry_msgs/msg/Twist",
        ]


async def done(_: Any) -> dict[str, Any]:
    return {"done": True}


class TestServices:
    async def test_what_was_published_before_an_answer_arrives_before_it(self) -> None:
        """A bench in lock-step relies on it: after `advance` all of the step's data is there."""
        async with linked() as (server, bridge):
            heard: list[int] = []

            async def advance(arguments: Any) -> dict[str, Any]:
                for number in range(200):
                    server.publish("/scan", "", {"n": number, "ranges": np.zeros(360)})
                return {"sent": server.sent["/scan"], "by": arguments["seconds"]}

            server.provide("/bench/advance", advance)
            bridge.subscribe("/scan", "", lambda message: heard.append(message["n"]))
            await soon(server.subscribed("/scan"))
            answer = await soon(bridge.call("/bench/advance", {"seconds": 0.1}))
            assert answer == {"sent": 200, "by": 0.1}
            assert heard == list(range(200))

    async def test_who_fails_says_why_and_who_is_silent_is_not_waited_for(self) -> None:
        async def fails(_: Any) -> dict[str, Any]:
            raise RuntimeError("the motor is hot")

        async def sleeps(_: Any) -> dict[str, Any]:
            await asyncio.sleep(60)
            return {}

        async with linked() as (server, bridge):
            server.provide("/fails", fails)
            server.provide("/sleeps", sleeps)
            with pytest.raises(DeviceError, match="/fails refused: the motor is hot"):
                await soon(bridge.call("/fails", {}))
            with pytest.raises(DeviceError, match=r"/none refused: .*does not exist"):
                await soon(bridge.call("/none", {}))
            with pytest.raises(DeviceError, match=r"/sleeps did not answer within 0\.05 s"):
                await soon(bridge.call("/sleeps", {}, 0.05))

    async def test_who_waits_for_an_answer_is_told_of_the_loss(self) -> None:
        called = asyncio.Event()

        async def sleeps(_: Any) -> dict[str, Any]:
            called.set()
            await asyncio.sleep(60)
            return {}

        async with linked() as (server, bridge):
            server.provide("/sleeps", sleeps)
            call = asyncio.create_task(bridge.call("/sleeps", {}, 60))
            await soon(called.wait())
            server.drop()
            with pytest.raises(DeviceError, match="/sleeps: the link was lost"):
                await soon(call)


class TestActions:
    async def test_a_goal_feeds_back_and_succeeds_or_not(self) -> None:
        async def drives(goal: Any, feedback: Any) -> dict[str, Any]:
            for left in (2, 1):
                feedback({"left": left})
            if goal["far"]:
                raise RuntimeError("too far")
            return {"there": True}

        async with linked(ros=2) as (server, bridge):
            server.provide_action("/go", drives)
            fed: list[Any] = []
            good = bridge.send_goal("/go", "nav2_msgs/NavigateToPose", {"far": False}, fed.append)
            assert await soon(good.over) == {"there": True}
            assert fed == [{"left": 2}, {"left": 1}]
            bad = bridge.send_goal("/go", "nav2_msgs/NavigateToPose", {"far": True})
            with pytest.raises(DeviceError, match="/go did not succeed: too far"):
                await soon(bad.over)

    async def test_a_goal_that_is_cancelled_ends_at_the_robot(self) -> None:
        began, ended = asyncio.Event(), asyncio.Event()

        async def drives(_goal: Any, _feedback: Any) -> dict[str, Any]:
            began.set()
            try:
                await asyncio.sleep(60)
            finally:
                ended.set()
            return {}

        async with linked(ros=2) as (server, bridge):
            server.provide_action("/go", drives)
            goal = bridge.send_goal("/go", "nav2_msgs/NavigateToPose", {})
            await soon(began.wait())
            bridge.cancel_goal(goal)
            with pytest.raises(DeviceError, match="was cancelled"):
                await soon(goal.over)
            assert ended.is_set()

    @pytest.mark.parametrize(
        ("cancels", "answer", "error"),
        [
            (False, {"result": True, "values": {"status": 4, "result": {}}}, ""),
            (False, {"result": True, "values": {"status": 6, "result": {}}}, "did not succeed"),
            (False, {"result": True, "values": {}}, ""),
            (True, {"result": True, "values": {}}, "was cancelled"),
            (False, {"result": False, "values": "rejected"}, "did not succeed: rejected"),
            (True, {"result": False, "status": 0, "values": "no status"}, "was cancelled"),
        ],
    )
    async def test_bridges_that_tell_the_end_otherwise_are_understood(
        self, cancels: bool, answer: dict[str, Any], error: str
    ) -> None:
        raw = Raw()
        async with raw.serving(ros=2) as bridge:
            goal = bridge.send_goal("/go", "nav2_msgs/NavigateToPose", {})
            if cancels:
                bridge.cancel_goal(goal)
            await until(lambda: len(raw.heard) == 1 + cancels)
            assert raw.heard[0]["action_type"] == "nav2_msgs/action/NavigateToPose"
            await raw.say({"op": "action_result", "id": raw.heard[0]["id"], **answer})
            if error:
                with pytest.raises(DeviceError, match=error):
                    await soon(goal.over)
            else:
                await soon(goal.over)


class TestLink:
    async def test_a_lost_link_comes_back_with_all_subscriptions(self) -> None:
        said: list[str] = []
        async with linked(tell=said.append) as (server, bridge):
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
        now = 10.0
        async with linked(clock=lambda: now) as (server, bridge):
            bridge.subscribe("/odom", "nav_msgs/Odometry", lambda _: None)
            await soon(server.subscribed("/odom"))
            assert bridge.reading() == ("link", 0.0, STALE, {})
            server.publish("/odom", "", {})
            await until(lambda: bridge.heard is not None)
            assert bridge.reading() == ("link", 0.0, OK, {})
            server.pause()
            server.publish("/odom", "", {})
            now += 0.3
            await asyncio.sleep(0.05)
            assert bridge.connected
            assert bridge.reading().age == pytest.approx(0.3)
            server.resume()
            server.publish("/odom", "", {})
            await until(lambda: bridge.reading().age == 0)

    async def test_a_pause_can_leave_out_the_clock_of_a_bench(self) -> None:
        async with linked() as (server, bridge):
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

    async def test_what_was_said_in_a_pause_is_heard_after_it_and_the_newest_last(self) -> None:
        async with linked() as (server, bridge):
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

    async def test_a_client_that_does_not_read_delays_nobody(self) -> None:
        async with (
            linked() as (server, bridge),
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
    def test_an_address_that_is_none_is_one_sentence(self, url: str) -> None:
        with pytest.raises(DeviceError, match="give ws://HOST:PORT"):
            Rosbridge(url)


class TestOddMessages:
    async def test_what_is_no_message_is_told_once_and_does_not_end_the_link(self) -> None:
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

    async def test_a_large_message_comes_in_fragments_where_that_is_wished(self) -> None:
        message = {"data": list(range(500))}
        raw, heard = Raw(), list[Any]()
        async with linked() as (server, _), connect(server.url) as client:
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

    def test_fragments_that_never_become_whole_are_given_up(self) -> None:
        whole = Fragments()
        for number in range(1_000):
            whole.take({"id": number, "num": 0, "total": 2, "data": "x"})
        assert len(whole._open) <= 17
        with pytest.raises(ValueError, match="fragment"):
            whole.take({"id": "b", "num": 5, "total": 2, "data": "x"})
