"""The link by rosbridge: topics, services and actions through a server."""

from __future__ import annotations

import asyncio
import math
from typing import Any

import numpy as np
import pytest

from tangy_hw.device_protocols import DeviceError
from tangy_hw.drivers.rosbridge import Rosbridge
from tangy_sim.servers.rosbridge_server import RosbridgeServer
from tests.hw.ros_links import Raw, done, linked, soon
from tests.support.waiting import until


class TestTopics:
    async def test_only_subscribers_receive_a_message(self) -> None:
        async with linked() as (server, bridge, _):
            heard: list[Any] = []
            bridge.subscribe("odom", "nav_msgs/Odometry", heard.append)
            await soon(server.subscribed("/odom"))
            server.publish("/other", "std_msgs/String", {"data": "no"})
            server.publish("/odom", "nav_msgs/Odometry", {"n": np.array([1.0, math.inf])})
            await until(lambda: bool(heard))
            assert heard == [{"n": [1.0, None]}]

    async def test_a_published_message_reaches_the_simulator_and_other_clients(self) -> None:
        async with linked() as (server, bridge, _):
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

    async def test_no_message_arrives_after_unsubscribing(self) -> None:
        async with linked() as (server, bridge, _):
            heard: list[Any] = []
            bridge.subscribe("/odom", "nav_msgs/Odometry", heard.append)
            await soon(server.subscribed("/odom"))
            bridge.unsubscribe("/odom", heard.append)
            await until(lambda: not server.is_subscribed("/odom"))

    async def test_a_throttled_topic_keeps_its_interval(self) -> None:
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


class TestServices:
    async def test_messages_published_before_an_answer_arrive_first(self) -> None:
        """A bench in lock-step relies on it: after `advance` all data of the step is there."""
        async with linked() as (server, bridge, _):
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

    async def test_a_failing_service_gives_its_reason_and_a_silent_one_times_out(self) -> None:
        async def fails(_: Any) -> dict[str, Any]:
            raise RuntimeError("the motor is hot")

        async def sleeps(_: Any) -> dict[str, Any]:
            await asyncio.sleep(60)
            return {}

        async with linked() as (server, bridge, _):
            server.provide("/fails", fails)
            server.provide("/sleeps", sleeps)
            with pytest.raises(DeviceError, match="/fails refused: the motor is hot"):
                await soon(bridge.call("/fails", {}))
            with pytest.raises(DeviceError, match=r"/none refused: .*does not exist"):
                await soon(bridge.call("/none", {}))
            with pytest.raises(DeviceError, match=r"/sleeps did not answer within 0\.05 s"):
                await soon(bridge.call("/sleeps", {}, 0.05))

    async def test_a_lost_link_ends_a_pending_call(self) -> None:
        called = asyncio.Event()

        async def sleeps(_: Any) -> dict[str, Any]:
            called.set()
            await asyncio.sleep(60)
            return {}

        async with linked() as (server, bridge, _):
            server.provide("/sleeps", sleeps)
            call = asyncio.create_task(bridge.call("/sleeps", {}, 60))
            await soon(called.wait())
            server.drop()
            with pytest.raises(DeviceError, match="/sleeps: the link was lost"):
                await soon(call)


class TestActions:
    async def test_a_goal_gives_feedback_and_a_result(self) -> None:
        async def drives(goal: Any, feedback: Any) -> dict[str, Any]:
            for left in (2, 1):
                feedback({"left": left})
            if goal["far"]:
                raise RuntimeError("too far")
            return {"there": True}

        async with linked(ros=2) as (server, bridge, _):
            server.provide_action("/go", drives)
            fed: list[Any] = []
            good = bridge.send_goal("/go", "nav2_msgs/NavigateToPose", {"far": False}, fed.append)
            assert await soon(good.over) == {"there": True}
            assert fed == [{"left": 2}, {"left": 1}]
            bad = bridge.send_goal("/go", "nav2_msgs/NavigateToPose", {"far": True})
            with pytest.raises(DeviceError, match="/go did not succeed: too far"):
                await soon(bad.over)

    async def test_a_cancelled_goal_ends_at_the_robot(self) -> None:
        began, ended = asyncio.Event(), asyncio.Event()

        async def drives(_goal: Any, _feedback: Any) -> dict[str, Any]:
            began.set()
            try:
                await asyncio.sleep(60)
            finally:
                ended.set()
            return {}

        async with linked(ros=2) as (server, bridge, _):
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
    async def test_other_formats_of_action_results_are_understood(
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
