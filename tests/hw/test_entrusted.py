"""Robots with their own navigation: goals are sent, and cancelled if driving is unsafe."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from dataclasses import replace
from math import pi
from pathlib import Path

import numpy as np
import pytest

from tangy_hw.device_protocols import (
    STILL,
    DeviceError,
    ExternalNavigation,
    MachineClock,
    Odometry,
    Pose,
    Scan,
    Stamped,
    Twist,
)
from tangy_hw.drivers.ros_navigator import RosNavigator
from tangy_hw.drivers.rosbridge import Rosbridge
from tangy_hw.navigation import external_navigator
from tangy_hw.navigation.external_navigator import ExternalNavigator
from tangy_hw.navigation.limits import MotionLimits
from tangy_hw.navigation.navigator import Navigator
from tangy_hw.robot_process import controller as robots
from tangy_hw.robot_process.assembly import assemble
from tangy_hw.robot_process.controller import LiveRobot
from tangy_hw.robot_process.self_test import try_robot
from tangy_hw.robot_process.stop_latch import Preempted
from tangy_hw.robot_setup import RobotSetup
from tangy_profiles.activity import load_activity
from tangy_profiles.health import STALE
from tangy_profiles.robot import load_robot
from tangy_sim.servers.rosbridge_server import RosbridgeServer
from tests.hw.live_bodies import ToldBody
from tests.hw.move_base import MoveBase
from tests.hw.ros_links import SOON, soon
from tests.support.waiting import until

GOAL = Pose(2.0, 1.0, 0.5)
START = Pose(1.0, 1.0, 0.0)


class Living:
    """A robot with its own navigation, and that navigation at the other end of the link."""

    def __init__(
        self, robot: LiveRobot, parts: ToldBody, base: MoveBase, living: asyncio.Task[None]
    ) -> None:
        self.robot, self.parts, self.base, self.living = robot, parts, base, living

    def facts(self, device: str) -> object:
        return next(r.facts for r in self.robot.health() if r.device == device)


@asynccontextmanager
async def living(monkeypatch: pytest.MonkeyPatch) -> AsyncIterator[Living]:
    monkeypatch.setattr(robots, "BLOCKED_SECONDS", 0.1)
    monkeypatch.setattr(robots, "HAZARD_SECONDS", 0.4)
    monkeypatch.setattr(external_navigator, "AGAIN_SECONDS", 0.1)
    server, parts = RosbridgeServer(), ToldBody()
    await server.start()
    bridge = Rosbridge(server.url)
    navigation = RosNavigator(bridge)
    satisfied: ExternalNavigation = navigation
    robot = LiveRobot(
        load_robot(), parts.body(bridge, navigation), ExternalNavigator(satisfied), MachineClock()
    )
    await robot.start()
    assert await bridge.wait_connected(SOON)
    await soon(server.subscribed("/amcl_pose", "/move_base/status"))
    base = MoveBase(server)

    async def live() -> None:
        while True:
            base.idle()
            await asyncio.sleep(0.05)

    task = asyncio.create_task(live())
    base.place(START)
    await until(lambda: not robot.hazard)
    try:
        yield Living(robot, parts, base, task)
    finally:
        task.cancel()
        await robot.close()
        await server.close()


async def test_a_goal_is_driven_and_the_pose_reported(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    async with living(monkeypatch) as one:
        assert one.robot.pose == pytest.approx(START)
        going = asyncio.create_task(one.robot.go(GOAL, "user1"))
        await until(lambda: one.base.goals)
        one.base.feed(Pose(1.5, 1.0, 0.0))
        await until(lambda: one.robot.pose.x == pytest.approx(1.5))
        assert one.robot.going == "user1" and not going.done()
        one.base.end(3)
        assert await soon(going) is True
        assert one.facts("navigator") == {"path": "clear"}
        assert not one.base.cancelled and one.parts.told == []  # only its navigation drives it


async def test_no_goal_is_sent_while_the_robot_must_not_drive(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    async with living(monkeypatch) as one:
        await one.robot.stop("not yet")
        with pytest.raises(Preempted, match="not yet"):
            await soon(one.robot.go(GOAL))
        one.robot.release()
        one.parts.laser.age = 1.0
        with pytest.raises(Preempted, match="laser"):
            await soon(one.robot.go(GOAL))
        one.parts.laser.age = 0.0
        navigator = one.robot.navigator
        await asyncio.sleep(0.2)
        navigator.go(GOAL)
        navigator.tick(Odometry(START, STILL), None, 0.05)
        assert navigator.drives
        navigator.held()
        await until(lambda: not navigator.drives)
        navigator.cancel()
        await asyncio.sleep(0.1)
        assert not one.base.goals


async def go_without_a_way(one: Living) -> None:
    """Send the robot off, and let its navigation find no path."""
    going = asyncio.create_task(one.robot.go(GOAL))
    await until(lambda: one.base.goals)
    one.base.end(4, "no path")
    assert await soon(going) is False
    assert one.facts("navigator") == {"path": "none"}


async def test_a_blocked_path_is_retried_after_time_to_clear_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(external_navigator, "CLEARING_SECONDS", 0.5)
    async with living(monkeypatch) as one:
        await go_without_a_way(one)
        one.robot.replan()
        assert one.facts("navigator") == {"path": "none"}
        await asyncio.sleep(0.6)
        one.robot.replan()
        assert one.facts("navigator") == {"path": "clear"}


async def test_a_stop_does_not_shorten_the_time_to_clear_a_path(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(external_navigator, "CLEARING_SECONDS", 1e9)
    async with living(monkeypatch) as one:
        await go_without_a_way(one)
        await one.robot.stop("the laser scanner is silent")
        one.robot.release()
        assert one.facts("navigator") == {"path": "none"}
        monkeypatch.setattr(external_navigator, "CLEARING_SECONDS", 0.0)
        await one.robot.stop("the laser scanner is silent")
        one.robot.release()
        assert one.facts("navigator") == {"path": "clear"}


async def test_a_refused_goal_is_no_blocked_path(monkeypatch: pytest.MonkeyPatch) -> None:
    async with living(monkeypatch) as one:
        going = asyncio.create_task(one.robot.go(GOAL))
        await until(lambda: one.base.goals)
        one.base.end(5, "no such frame")
        assert await soon(going) is False
        assert one.facts("navigator") == {"path": "clear"}


async def test_a_stop_holds_the_base_until_the_goal_has_ended(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    async with living(monkeypatch) as one:
        going = asyncio.create_task(one.robot.go(GOAL))
        await until(lambda: one.base.goals)
        await one.robot.stop("a hand was in the way")
        assert one.parts.told[0] == "stop"
        await until(lambda: one.base.cancelled == list(one.base.goals))
        with pytest.raises(Preempted, match="a hand"):
            await soon(going)
        told = len(one.parts.told)
        await until(lambda: len(one.parts.told) > told + 2)
        assert set(one.parts.told[told:]) == {"stop"}
        one.base.end(2)
        await until(lambda: not one.robot.navigator.drives)
        await asyncio.sleep(0.05)
        told = len(one.parts.told)
        await asyncio.sleep(0.1)
        assert len(one.parts.told) == told


async def test_a_drive_pauses_while_a_sensor_is_silent(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    async with living(monkeypatch) as one:
        going = asyncio.create_task(one.robot.go(GOAL))
        await until(lambda: one.base.goals)
        one.parts.laser.age = 1.0
        await until(lambda: one.base.cancelled)
        one.base.end(2)
        one.parts.laser.age = 0.0
        await until(lambda: len(one.base.goals) == 2)
        one.base.end(3)
        assert await soon(going) is True


async def test_a_drive_ends_if_a_sensor_stays_silent(monkeypatch: pytest.MonkeyPatch) -> None:
    async with living(monkeypatch) as one:
        going = asyncio.create_task(one.robot.go(GOAL))
        await until(lambda: one.base.goals)
        one.parts.laser.age = 1.0
        await until(lambda: one.base.cancelled)
        one.base.end(2)
        with pytest.raises(Preempted, match="laser scanner says nothing"):
            await soon(going)
        assert len(one.base.goals) == 1


async def test_a_silent_navigation_ends_the_drive(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    async with living(monkeypatch) as one:
        going = asyncio.create_task(one.robot.go(GOAL))
        await until(lambda: one.base.goals)
        one.living.cancel()
        one.base.feed(START)
        with pytest.raises(Preempted, match="says nothing"):
            await soon(going)
        assert one.base.cancelled and "stop" in one.parts.told


async def test_a_cancelled_drive_cancels_the_goal_at_the_robot(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    async with living(monkeypatch) as one:
        going = asyncio.create_task(one.robot.go(GOAL))
        await until(lambda: one.base.goals)
        going.cancel()
        await until(lambda: one.base.cancelled == list(one.base.goals))
        one.base.end(2)
        second = asyncio.create_task(one.robot.go(GOAL))
        await until(lambda: len(one.base.goals) == 2)
        one.robot.drive_by_hand(Twist(0.1, 0.0))
        await until(lambda: len(one.base.cancelled) >= 2)
        assert await soon(second) is False
        await until(lambda: Twist(0.1, 0.0) in one.parts.told)


async def test_a_robot_with_an_uncertain_pose_turns_to_localise(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    async with living(monkeypatch) as one:
        one.base.place(START, 0.9)
        await until(lambda: one.facts("localisation") == {"fit": 0.0, "spread": pytest.approx(0.9)})
        turning = Odometry(START, Twist(0.0, 10.0))
        one.parts.base.odometry = Stamped(turning, 0.0, 1)
        spinning = asyncio.create_task(one.robot.spin())
        await until(lambda: any(isinstance(t, Twist) and t.turn > 0 for t in one.parts.told))
        one.base.place(START, 0.1)
        assert await soon(spinning) is True
        assert one.facts("localisation") == {"fit": 1.0, "spread": pytest.approx(0.1)}
        assert not one.base.goals


async def test_a_drive_without_a_link_fails() -> None:
    async with living_silent() as (way, _):
        way.go(GOAL)
        way.tick(Odometry(START, STILL), None, 0.05)
        await until(lambda: way.state != "driving")
        assert way.state == "failed" and "link" in way.why and not way.drives


@asynccontextmanager
async def living_silent() -> AsyncIterator[tuple[ExternalNavigator, Rosbridge]]:
    bridge = Rosbridge("ws://127.0.0.1:9")
    navigation = RosNavigator(bridge)
    await navigation.start()
    try:
        yield ExternalNavigator(navigation), bridge
    finally:
        await navigation.close()
        await bridge.close()


async def test_a_silent_navigation_is_stale_and_has_no_pose() -> None:
    async with living_silent() as (way, _):
        place, navigator = way.readings()
        assert (place.state, navigator.state, way.estimate) == (STALE, STALE, None)
        assert way.tick(Odometry(START, STILL), None, 0.1) == STILL
        with pytest.raises(DeviceError):
            way.place(START)
        way.place(None)
        assert len(way.obstacles) == len(way.particles) == 0 and way.path is None


def robot_file(folder: Path, navigator: str) -> Path:
    """Write the profile of a robot that has its own navigation."""
    path = folder / "mine.toml"
    at = 'kind = "rosbridge", at = "ws://127.0.0.1:9"'
    drivers = f"base = {{ {at} }}\nlaser = {{ {at} }}\nnavigator = {{ {at}{navigator} }}"
    shipped = load_robot().file.read_text(encoding="utf-8")
    path.write_text(f"{shipped}\n[drivers]\n{drivers}\n", encoding="utf-8")
    return path


class TestProfiles:
    def test_a_profile_names_it_and_where_its_map_lies(self, tmp_path: Path) -> None:
        path = robot_file(tmp_path, ', ros = 2, origin = "10, 20, 1.57", place = "/pose"')
        wired = assemble(RobotSetup(str(path), "bingo", ("user1",)))
        assert isinstance(wired.robot.navigator, ExternalNavigator)

    def test_a_bench_with_another_base_leaves_the_navigation_out(self, tmp_path: Path) -> None:
        path = robot_file(tmp_path, "")
        base = {"base": {"kind": "rosbridge", "at": "ws://127.0.0.1:10"}}
        wired = assemble(RobotSetup(str(path), "bingo", ("user1",), drivers=base))
        assert isinstance(wired.robot.navigator, Navigator)

    @pytest.mark.parametrize("origin", ["1, 2", "a, b, c", "1, 2, nan", "1, 2, 3, 4"])
    def test_an_invalid_map_origin_is_refused(self, tmp_path: Path, origin: str) -> None:
        path = robot_file(tmp_path, f', origin = "{origin}"')
        with pytest.raises(DeviceError, match=r"navigator \(rosbridge\): origin must be X, Y"):
            assemble(RobotSetup(str(path), "bingo", ("user1",)))

    async def test_a_robot_without_its_own_navigation_lacks_nothing(self, tmp_path: Path) -> None:
        path = robot_file(tmp_path, "")
        text = path.read_text(encoding="utf-8")
        found = await try_robot(load_robot(str(path)), load_activity("bingo"), {}, 0.1)
        assert "nobody answers" in next(one.text for one in found if one.device == "navigator")
        path.write_text(text[: text.index("navigator = ")], encoding="utf-8")
        found = await try_robot(load_robot(str(path)), load_activity("bingo"), {}, 0.1)
        assert "navigator" not in [one.device for one in found]


async def test_a_robot_with_corners_turns_to_localise_only_where_they_have_room() -> None:
    corners = ((0.4, 0.3), (-0.4, 0.3), (-0.4, -0.3), (0.4, -0.3))
    limits = replace(MotionLimits(), radius=0.5, corners=corners)
    ranges = np.full(271, np.inf)
    free = Scan(-0.75 * pi, pi / 180, ranges, 30.0)
    beside = Scan(free.first, free.step, np.where(np.arange(271) > 200, 0.45, ranges), 30.0)
    way = ExternalNavigator(RosNavigator(Rosbridge("ws://127.0.0.1:9")), limits)
    way.spin()
    for scan, turns, blocker in ((free, True, ""), (beside, False, "object")):
        twist = way.tick(Odometry(START, STILL), scan, 0.05)
        assert (twist != STILL) == turns and way.yields_to == blocker
