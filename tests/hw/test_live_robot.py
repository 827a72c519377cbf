"""The robot that is there: what a stop does to all of its body, whatever fails of it."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from time import monotonic
from unittest.mock import patch

import numpy as np
import pytest

from tangy_hw import robot as robots
from tangy_hw.devices import STILL, MachineClock
from tangy_hw.navigation.localisation import Estimate
from tangy_hw.navigation.navigator import Navigator
from tangy_hw.robot import BrokenOff, LiveRobot
from tangy_profiles.robot import load_robot
from tests.hw.live_bodies import HERE, ToldBody
from tests.hw.navigated import MAP
from tests.hw.ros_links import soon, until

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


class TestStop:
    async def test_it_stands_holds_its_arms_and_is_quiet_in_this_order(self) -> None:
        async with living() as (robot, parts):
            doing = asyncio.create_task(robot.perform(text="Hello", posture=POSTURE))
            await until(lambda: {"say", "pose"} <= set(parts.told))
            parts.told.clear()
            await robot.stop("a hand was in the way")
            assert parts.told == ["stop", "hold", "hush"]
            with pytest.raises(BrokenOff, match="a hand"):
                await soon(doing)
            assert robot.hazard == "a hand was in the way"

    @pytest.mark.parametrize("broken", ["arms", "voice"])
    async def test_what_fails_of_the_rest_keeps_nothing_from_being_stopped(
        self, broken: str
    ) -> None:
        async with living() as (robot, parts):
            getattr(parts, broken).breaks = True
            await robot.stop("enough")
            assert parts.told == ["stop", "hold", "hush"]
            assert robot.stopped == "enough"

    async def test_a_voice_that_hangs_holds_nobody_up(self) -> None:
        async with living() as (robot, parts):
            parts.voice.hangs = True
            began = monotonic()
            with patch.object(robots, "STOP_SECONDS", 0.05):
                await soon(robot.stop("enough"))
            assert monotonic() - began < 1 and parts.told[:2] == ["stop", "hold"]

    async def test_a_posture_that_was_about_to_be_taken_is_not(self) -> None:
        async with living() as (robot, parts):
            doing = asyncio.create_task(robot.perform(posture=POSTURE))
            stopping = asyncio.create_task(robot.stop("enough"))
            with pytest.raises(BrokenOff):
                await soon(doing)
            await stopping
            assert parts.told[-2:] == ["hold", "hush"]


class TestSpin:
    @pytest.mark.parametrize(
        ("fit", "spread", "settled", "found"),
        [
            (1.0, 0.1, True, True),
            (0.5, 0.1, True, True),  # somebody stands before it
            (1.0, 0.1, False, False),
            (1.0, 0.6, True, False),  # it might be elsewhere as well
            (0.5, 0.6, True, False),
        ],
    )
    async def test_it_has_found_its_place_when_it_believes_in_one(
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
