"""The live robot: a stop reaches every device, even if one of them fails."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from dataclasses import replace
from pathlib import Path
from time import monotonic
from typing import Any
from unittest.mock import Mock, patch

import numpy as np
import pytest

from tangy_hw.device_protocols import (
    STILL,
    DeviceError,
    MachineClock,
    Odometry,
    Pose,
    Scan,
    Stamped,
    Twist,
)
from tangy_hw.navigation.localisation import Estimate
from tangy_hw.navigation.navigator import Navigator
from tangy_hw.navigation.people_tracker import Track
from tangy_hw.robot_process import controller as robots
from tangy_hw.robot_process import performer
from tangy_hw.robot_process.control_loop import ControlLoop
from tangy_hw.robot_process.controller import LiveRobot
from tangy_hw.robot_process.stop_latch import Preempted
from tangy_profiles.health import ERROR, OK
from tangy_profiles.robot import load_robot
from tests.hw.live_bodies import HERE, ToldBody
from tests.hw.navigated import MAP
from tests.hw.ros_links import soon
from tests.support.waiting import until

POSTURE = {"head": (0, 0, 0, 0, 5, 0)}


@asynccontextmanager
async def living() -> AsyncIterator[tuple[LiveRobot, ToldBody]]:
    parts = ToldBody()
    navigator = Navigator(MAP, np.random.default_rng(1), HERE)
    robot = LiveRobot(load_robot(), parts.body(), navigator, MachineClock())
    await robot.start()
    try:
        yield robot, parts
    finally:
        await robot.close()


async def test_a_sound_is_played_after_the_speech() -> None:
    async with living() as (robot, parts):
        doing = asyncio.create_task(robot.perform(text="Hello", sound=Path("bell.wav")))
        await until(lambda: "say" in parts.told)
        assert "play bell.wav" not in parts.told
        parts.voice.hushed.set()  # it has spoken
        assert (await soon(doing)) == {"said": True, "played": True}
        assert parts.told.index("play bell.wav") > parts.told.index("say")


async def test_navigation_sees_as_far_as_the_robots_file_says(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    robot, parts = load_robot(), ToldBody()
    body = replace(robot.body, laser=replace(robot.body.laser, reach=3.0))
    parts.laser.scan = Stamped(Scan(-1.5, 0.1, np.full(31, 5.0), 30.0), 0.0, 2)
    navigator = Navigator(MAP, np.random.default_rng(1), HERE)
    live = LiveRobot(replace(robot, body=body), parts.body(), navigator, MachineClock())
    ticked = Mock(wraps=navigator.tick)
    monkeypatch.setattr(navigator, "tick", ticked)
    live.tick()
    scan: Scan = ticked.call_args.args[1]
    assert scan.farthest == 3.0 and (scan.ranges == 3.0).all()


class TestStop:
    async def test_a_stop_halts_the_base_then_the_arms_then_the_voice(self) -> None:
        async with living() as (robot, parts):
            doing = asyncio.create_task(robot.perform(text="Hello", posture=POSTURE))
            await until(lambda: {"say", "pose"} <= set(parts.told))
            parts.told.clear()
            await robot.stop("a hand was in the way")
            assert parts.told == ["stop", "hold", "hush"]
            with pytest.raises(Preempted, match="a hand"):
                await soon(doing)
            assert robot.hazard == "a hand was in the way"

    @pytest.mark.parametrize("broken", ["arms", "voice"])
    async def test_a_failing_device_does_not_keep_the_others_from_stopping(
        self, broken: str
    ) -> None:
        async with living() as (robot, parts):
            getattr(parts, broken).breaks = True
            await robot.stop("enough")
            assert parts.told == ["stop", "hold", "hush"]
            assert robot.stopped == "enough"

    async def test_a_hanging_voice_does_not_delay_a_stop(self) -> None:
        async with living() as (robot, parts):
            parts.voice.hangs = True
            began = monotonic()
            with patch.object(performer, "STOP_SECONDS", 0.05):
                await soon(robot.stop("enough"))
            assert monotonic() - began < 1 and parts.told[:2] == ["stop", "hold"]

    async def test_a_stop_prevents_a_pending_posture(self) -> None:
        async with living() as (robot, parts):
            doing = asyncio.create_task(robot.perform(posture=POSTURE))
            stopping = asyncio.create_task(robot.stop("enough"))
            with pytest.raises(Preempted):
                await soon(doing)
            await stopping
            assert parts.told[:3] == ["stop", "hold", "hush"] and "pose" not in parts.told

    async def test_a_stop_prevents_a_pending_command(self) -> None:
        async with living() as (robot, parts):
            assert robot.hazard == ""
            robot.drive_by_hand(Twist(0.3, 0.0))
            robot.tick()
            await robot.stop("enough")
            assert parts.told[0] == "stop"
            await until(lambda: parts.told.count("stop") == 2)  # once more, at the next tick
            await asyncio.sleep(0.1)
            assert Twist(0.3, 0.0) not in parts.told and parts.told.count("stop") == 2


class TestOwnersOfStops:
    async def test_the_robot_moves_again_after_every_owner_releases_its_stop(self) -> None:
        async with living() as (robot, _):
            await robot.stop("staff stopped it")
            await robot.stop("base-runaway", "fault")
            robot.release("fault")
            assert robot.stopped == robot.hazard == "staff stopped it"
            robot.release("staff")
            assert robot.stopped == robot.hazard == ""

    async def test_the_robot_shows_the_reason_of_the_remaining_stop(self) -> None:
        async with living() as (robot, _):
            await robot.stop("staff stopped it")
            await robot.stop("base-runaway", "fault")
            robot.release("staff")
            assert robot.stopped == "base-runaway"
            await robot.stop("staff stopped it")
            robot.release()
            assert robot.stopped == ""


class TestFailure:
    async def test_a_failed_control_loop_stops_the_robot_for_good(self) -> None:
        async with living() as (robot, parts):
            with patch.object(robot.navigator, "tick", side_effect=ZeroDivisionError):
                await until(lambda: robot.failed)
            await until(lambda: parts.told[:3] == ["stop", "hold", "hush"])
            robot.release()
            assert "its control has failed (ZeroDivisionError" in robot.hazard
            assert robot.stopped == robot.failed == robot.hazard
            robot.fail("navigator", OK)
            said = {reading.device: reading.state for reading in robot.health()}
            assert said["navigator"] == ERROR
            with pytest.raises(DeviceError):
                await soon(robot.perform(text="Hello"))


class TestLeftAlone:
    async def test_an_abandoned_robot_falls_quiet_without_a_stop(self) -> None:
        with patch.object(robots, "HAZARD_SECONDS", 0.2):
            async with living() as (robot, parts):
                left: list[str] = []
                robot.left = left.append
                doing = asyncio.create_task(robot.perform(text="Hello", posture=POSTURE))
                await until(lambda: {"say", "pose"} <= set(parts.told))
                robot.alone = lambda: "nobody is there"
                await asyncio.sleep(0.1)
                assert not doing.done() and "hold" not in parts.told  # it may only be for a moment
                with pytest.raises(Preempted, match="nobody is there"):
                    await soon(doing)
                await until(lambda: "hush" in parts.told)
                await asyncio.sleep(0.3)
                assert [parts.told.count(one) for one in ("hold", "hush")] == [1, 1]
                assert left == ["nobody is there"]
                robot.alone = str
                assert robot.stopped == robot.hazard == ""
                assert (await soon(robot.perform(text="Hello")))["said"]


class TestSpin:
    @pytest.mark.parametrize(
        ("fit", "spread", "settled", "found"),
        [
            (1.0, 0.1, True, True),
            (0.5, 0.1, True, True),  # a person stands before it
            (1.0, 0.1, False, False),
            (1.0, 0.6, True, False),  # it might be elsewhere as well
            (0.5, 0.6, True, False),
        ],
    )
    async def test_a_spin_succeeds_when_the_pose_is_certain(
        self, fit: float, spread: float, settled: bool, found: bool
    ) -> None:
        estimate = Estimate(HERE, np.eye(3), spread, fit, 300, settled)
        async with living() as (robot, _):
            with (
                patch.object(Navigator, "estimate", estimate),
                patch.object(Navigator, "state", "idle", create=True),
                patch.object(Navigator, "tick", return_value=STILL),
                patch.object(robot.navigator, "spin"),
            ):
                assert await soon(robot.spin()) is found


class TestArms:
    """Gestures while a person is within the reach of the arms."""

    @pytest.mark.parametrize(
        ("x", "posture", "moves"),
        [(0.6, "cheer", False), (1.2, "cheer", True), (0.6, "drive", True)],
    )
    async def test_a_gesture_is_skipped_if_a_person_is_within_reach(
        self, x: float, posture: str, moves: bool, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        robot = load_robot()
        robot = replace(robot, body=replace(robot.body, arms=0.7))
        parts = ToldBody()
        near = (Track(x, 0.0, 0.0, 0.0, 0.1, 5.0, 5.0, person=True, hidden=False),)
        clock = MachineClock()
        navigator = Navigator(MAP, np.random.default_rng(1), HERE)
        monkeypatch.setattr(Navigator, "tracks", near)
        acts = performer.Performer(
            parts.body(), ControlLoop(clock, lambda: False), robot, navigator, str
        )
        doing = asyncio.create_task(acts.perform(text="Hello", posture=robot.postures[posture]))
        await until(lambda: "say" in parts.told and ("pose" in parts.told or not moves))
        assert ("pose" in parts.told) is moves
        await acts.be_still()
        doing.cancel()


async def test_localisation_gets_the_odometry_of_the_scan_time() -> None:
    async with living() as (robot, parts):
        told: list[Pose | None] = []
        tick = robot.navigator.tick

        def note(*data: Any) -> Twist:
            told.append(data[3])
            return tick(*data)

        turns, scan, now = Twist(0.5, 0.0), parts.laser.scan, monotonic() - 0.4
        with patch.object(robot.navigator, "tick", note):
            parts.base.odometry = Stamped(Odometry(Pose(0.0, 0.0, 0.0), turns), now, 2, now)
            robot.tick()
            late = now + 0.4
            parts.laser.scan = replace(scan, stamp=late, seq=2, measured=now + 0.1)
            parts.base.odometry = Stamped(Odometry(Pose(0.1, 0.0, 0.0), turns), late, 3, now + 0.2)
            robot.tick()
        at_scan = told[-1]
        assert at_scan is not None and at_scan.x == pytest.approx(0.05)
