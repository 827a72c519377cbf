"""Robots with their own navigation: goals of ROS 1 and ROS 2, and their results."""

from __future__ import annotations

import asyncio
import json
import math
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from typing import Any

import pytest
from websockets.asyncio.server import ServerConnection, serve

from tangy_hw.device_protocols import DeviceError, Pose
from tangy_hw.drivers.ros_messages import pose_message
from tangy_hw.drivers.ros_navigator import AGAIN_SECONDS, RosNavigator
from tangy_hw.drivers.rosbridge import Rosbridge
from tangy_profiles.health import OK, STALE
from tangy_sim.servers.rosbridge_server import RosbridgeServer
from tests.hw.move_base import MoveBase
from tests.hw.ros_links import SOON, linked, soon
from tests.support.waiting import until

ORIGIN = Pose(10.0, 20.0, math.pi / 2)
GOAL = Pose(2.0, 1.0, 0.5)
IN_MAP = Pose(9.0, 22.0, 0.5 + math.pi / 2)


def pose_in(message: Any) -> tuple[float, float, float]:
    pose = message["pose"]
    turn = 2 * math.atan2(pose["orientation"]["z"], pose["orientation"]["w"])
    return pose["position"]["x"], pose["position"]["y"], turn


@asynccontextmanager
async def navigating(ros: int) -> AsyncIterator[tuple[RosbridgeServer, RosNavigator, Rosbridge]]:
    server = RosbridgeServer()
    await server.start()
    bridge = Rosbridge(server.url, ros=ros)
    await bridge.start()
    assert await bridge.wait_connected(SOON)
    navigator = RosNavigator(bridge, origin=ORIGIN)
    await navigator.start()
    await soon(server.subscribed("/amcl_pose"))
    try:
        yield server, navigator, bridge
    finally:
        await navigator.close()
        await bridge.close()
        await server.close()


class TestMoveBase:
    async def test_goals_are_sent_in_the_map_frame_and_poses_read_in_the_room_frame(self) -> None:
        async with navigating(1) as (server, navigator, _):
            base = MoveBase(server)
            going = asyncio.create_task(navigator.go(GOAL, 30))
            await until(lambda: base.goals)
            assert pose_in(base.goals[base.newest]) == pytest.approx(IN_MAP)
            assert base.goals[base.newest]["header"]["frame_id"] == "map"
            base.feed(IN_MAP)
            await until(lambda: navigator.pose)
            assert navigator.pose is not None
            assert navigator.pose.value == pytest.approx(GOAL)
            assert not going.done()
            base.end(3)
            await soon(going)
            assert str(navigator.state) == "arrived"
            assert navigator.reading()[2:4] == (OK, {"path": "clear"})

    @pytest.mark.parametrize(
        ("code", "path", "error"),
        [(4, "none", "found no way: blocked"), (5, "clear", "refused: blocked")],
    )
    async def test_an_unreachable_goal_fails_with_a_reason(
        self, code: int, path: str, error: str
    ) -> None:
        async with navigating(1) as (server, navigator, _):
            base = MoveBase(server)
            going = asyncio.create_task(navigator.go(GOAL, 30))
            await until(lambda: base.goals)
            base.say(3, key="of somebody else")
            base.end(code, "blocked")
            with pytest.raises(DeviceError, match=error):
                await soon(going)
            assert navigator.state == "failed"
            assert navigator.reading().facts == {"path": path}
            assert not base.cancelled

    async def test_a_cancelled_goal_or_task_is_cancelled_at_the_robot(self) -> None:
        async with navigating(1) as (server, navigator, _):
            base = MoveBase(server)
            going = asyncio.create_task(navigator.go(GOAL, 30))
            await until(lambda: base.goals)
            cancelling = asyncio.create_task(navigator.cancel())
            await until(lambda: base.cancelled == list(base.goals))
            base.end(2)
            await soon(cancelling)
            with pytest.raises(DeviceError, match="was cancelled"):
                await soon(going)
            forgotten = asyncio.create_task(navigator.go(GOAL, 30))
            await until(lambda: len(base.goals) == 2)
            forgotten.cancel()
            await until(lambda: base.cancelled == list(base.goals))

    async def test_a_new_goal_replaces_the_running_one(self) -> None:
        async with navigating(1) as (server, navigator, _):
            base = MoveBase(server)
            first = asyncio.create_task(navigator.go(GOAL, 30))
            await until(lambda: base.goals)
            second = asyncio.create_task(navigator.go(Pose(0, 0, 0), 30))
            with pytest.raises(DeviceError, match="otherwise"):
                await soon(first)
            await until(lambda: len(base.goals) == 2)
            assert str(navigator.state) == "driving"
            base.end(3)
            await soon(second)
            assert str(navigator.state) == "arrived"

    async def test_a_goal_is_repeated_until_the_robot_accepts_it(self) -> None:
        async with navigating(1) as (server, navigator, _):
            deaf = list[Any]()
            server.on_message("/move_base/goal", deaf.append)
            going = asyncio.create_task(navigator.go(GOAL, 30))
            await until(lambda: deaf)
            base = MoveBase(server)
            await until(lambda: base.goals)
            assert base.newest == deaf[0]["goal_id"]["id"]
            base.end(3)
            await soon(going)

    async def test_a_goal_running_at_a_link_loss_is_cancelled_afterwards(
        self,
    ) -> None:
        async with navigating(1) as (server, navigator, bridge):
            base = MoveBase(server)
            going = asyncio.create_task(navigator.go(GOAL, 30))
            await until(lambda: base.goals)
            server.drop()
            with pytest.raises(DeviceError, match="the link was lost"):
                await soon(going)
            await until(lambda: base.cancelled == list(base.goals))
            assert bridge.connected

    async def test_a_goal_cancelled_before_acceptance_is_not_repeated(self) -> None:
        async with navigating(1) as (server, navigator, _):
            base = MoveBase(server)
            base.takes = False
            going = asyncio.create_task(navigator.go(GOAL, 30))
            await until(lambda: base.goals)
            base.goals.clear()
            cancelling = asyncio.create_task(navigator.cancel())
            await asyncio.sleep(1.2 * AGAIN_SECONDS)
            assert not base.goals and len(base.cancelled) == 1
            base.say(1, key=base.cancelled[0])  # it accepts the goal after all
            await until(lambda: len(base.cancelled) == 2)
            base.say(2, key=base.cancelled[0])
            await soon(cancelling)
            with pytest.raises(DeviceError):
                await soon(going)
            base.say(1, key=base.cancelled[0])
            base.say(1, key="of somebody else")
            await until(lambda: len(base.cancelled) == 3)
            assert len(set(base.cancelled)) == 1

    async def test_a_goal_left_by_a_killed_process_is_cancelled(self) -> None:
        async with navigating(1) as (server, _, _bridge):
            base = MoveBase(server)
            await soon(server.subscribed("/move_base/status"))
            base.say(1, key="of somebody else")
            base.say(3, key="tangy-1234-1")
            base.say(1, key="tangy-1234-2")
            await until(lambda: base.cancelled)
            assert base.cancelled == ["tangy-1234-2"]

    async def test_localisation_reports_pose_certainty_and_age(self) -> None:
        async with navigating(1) as (server, navigator, _):
            base = MoveBase(server)
            assert navigator.localisation().state == STALE
            base.place(IN_MAP, 0.2)
            await until(lambda: navigator.pose)
            place = navigator.localisation()
            assert place[2:4] == (OK, {"fit": 1.0, "spread": pytest.approx(0.2)})
            base.place(IN_MAP, 0.8)
            await until(lambda: navigator.localisation().facts["fit"] == 0.0)

    async def test_the_pose_of_a_standing_robot_is_as_old_as_the_link(self) -> None:
        async with linked() as (server, bridge, now):
            navigator = RosNavigator(bridge)
            await navigator.start()
            await soon(server.subscribed("/amcl_pose", "/move_base/status"))
            base = MoveBase(server)
            base.place(IN_MAP)
            await until(lambda: navigator.pose)
            now.time += 60
            base.idle()
            await until(lambda: navigator.reading().age == 0)
            assert navigator.localisation().age == 0
            going = asyncio.create_task(navigator.go(GOAL, 30))
            await until(lambda: base.goals)
            assert navigator.localisation().age == 0  # it has only begun to drive
            now.time += 2
            base.say(1)
            await until(lambda: navigator.reading().age == 0)
            assert navigator.localisation().age == 2
            base.feed(IN_MAP)
            await until(lambda: navigator.localisation().age == 0)
            base.end(3)
            await soon(going)
            await navigator.close()

    async def test_place_sends_the_initial_pose(self) -> None:
        async with navigating(1) as (server, navigator, _):
            told = list[Any]()
            server.on_message("/initialpose", told.append)
            navigator.place(GOAL)
            await until(lambda: told)
            assert pose_in(told[0]["pose"]) == pytest.approx(IN_MAP)
            assert len(told[0]["pose"]["covariance"]) == 36
            assert told[0]["header"]["frame_id"] == "map"


class TestNavigateToPose:
    async def test_a_drive_reports_detours_and_arrives(self) -> None:
        goals, go_on = list[Any](), asyncio.Event()

        async def drives(goal: Any, feedback: Callable[[Any], None]) -> dict[str, Any]:
            goals.append(goal)
            feedback({"current_pose": {"pose": pose_message(IN_MAP)}, "number_of_recoveries": 1})
            await go_on.wait()
            return {}

        async with navigating(2) as (server, navigator, _):
            server.provide_action("/navigate_to_pose", drives)
            going = asyncio.create_task(navigator.go(GOAL, 30))
            await until(lambda: navigator.pose)
            assert pose_in(goals[0]["pose"]) == pytest.approx(IN_MAP)
            assert navigator.pose is not None
            assert navigator.pose.value == pytest.approx(GOAL)
            assert navigator.reading().facts == {"path": "replanned"}
            go_on.set()
            await soon(going)
            assert navigator.state == "arrived"

    async def test_a_drive_without_a_path_fails_and_a_cancelled_one_ends_at_the_robot(self) -> None:
        began, ended = asyncio.Event(), asyncio.Event()

        async def drives(goal: Any, _: Any) -> dict[str, Any]:
            if goal["pose"]["pose"]["position"]["x"] > 50:
                raise RuntimeError("no path")
            began.set()
            try:
                await asyncio.sleep(60)
            finally:
                ended.set()
            return {}

        async with navigating(2) as (server, navigator, _):
            server.provide_action("/navigate_to_pose", drives)
            with pytest.raises(DeviceError, match="no path"):
                await soon(navigator.go(Pose(0, -90, 0), 30))
            assert navigator.reading().facts == {"path": "none"}
            going = asyncio.create_task(navigator.go(GOAL, 30))
            await soon(began.wait())
            await navigator.cancel()
            with pytest.raises(DeviceError):
                await soon(going)
            assert ended.is_set()
            assert navigator.state == "idle"

    async def test_a_bridge_that_blocks_during_a_goal_still_gets_a_stop(
        self,
    ) -> None:
        """Some bridges of ROS 2 read nothing more from a connection until its goal is over."""
        sought, cancelled, heard = asyncio.Event(), asyncio.Event(), list[Any]()

        async def attend(link: ServerConnection) -> None:
            async for text in link:
                message = json.loads(text)
                if message["op"] == "send_action_goal":
                    sought.set()
                    await cancelled.wait()
                    answer = {"op": "action_result", "id": message["id"], "status": 5}
                    await link.send(json.dumps({**answer, "result": True, "values": {}}))
                elif message["op"] == "cancel_action_goal":
                    cancelled.set()
                elif message["op"] == "publish":
                    heard.append(message["topic"])

        async with serve(attend, "127.0.0.1", 0) as server:
            port = next(iter(server.sockets)).getsockname()[1]
            bridge = Rosbridge(f"ws://127.0.0.1:{port}", ros=2)
            await bridge.start()
            assert await bridge.wait_connected(SOON)
            navigator = RosNavigator(bridge)
            await navigator.start()
            going = asyncio.create_task(navigator.go(GOAL, 30))
            await soon(sought.wait())
            bridge.publish("/cmd_vel", {}, urgent=True)
            await until(lambda: heard == ["/cmd_vel"])
            await navigator.cancel()
            with pytest.raises(DeviceError, match="was cancelled"):
                await soon(going)
            await navigator.close()
            await bridge.close()

    async def test_a_goal_that_ignores_its_cancellation_is_cancelled_again(self) -> None:
        cancelled = list[str]()

        async def attend(link: ServerConnection) -> None:
            async for text in link:
                message = json.loads(text)
                if message["op"] == "send_action_goal":
                    asyncio.get_running_loop().create_task(drive(link, message["id"]))
                elif message["op"] == "cancel_action_goal":
                    cancelled.append(message["id"])

        async def drive(link: ServerConnection, key: str) -> None:
            while len(cancelled) < 2:  # the first one gets lost
                fed = {"op": "action_feedback", "id": key}
                at = {"current_pose": {"pose": pose_message(IN_MAP)}}
                await link.send(json.dumps({**fed, "values": at}))
                await asyncio.sleep(0.02)
            over = {"op": "action_result", "id": key, "status": 5, "result": False, "values": {}}
            await link.send(json.dumps(over))

        async with serve(attend, "127.0.0.1", 0) as server:
            port = next(iter(server.sockets)).getsockname()[1]
            bridge = Rosbridge(f"ws://127.0.0.1:{port}", ros=2)
            navigator = RosNavigator(bridge)
            await navigator.start()
            assert await bridge.wait_connected(SOON)
            going = asyncio.create_task(navigator.go(GOAL, 30))
            await until(lambda: navigator.pose)
            await soon(navigator.cancel())
            with pytest.raises(DeviceError, match="was cancelled"):
                await soon(going)
            assert len(cancelled) == 2
            await navigator.close()
            await bridge.close()

    async def test_a_goal_is_cancelled_when_its_lost_link_returns(self) -> None:
        began, ended = asyncio.Event(), asyncio.Event()

        async def drives(_goal: Any, _feedback: Any) -> dict[str, Any]:
            began.set()
            try:
                await asyncio.sleep(60)
            finally:
                ended.set()
            return {}

        async with navigating(2) as (server, navigator, _):
            server.provide_action("/navigate_to_pose", drives)
            going = asyncio.create_task(navigator.go(GOAL, 30))
            await soon(began.wait())
            server.drop()
            with pytest.raises(DeviceError, match="link was lost"):
                await soon(going)
            await soon(ended.wait())
            assert navigator.state == "failed"
            assert navigator.reading().facts == {"path": "clear"}
