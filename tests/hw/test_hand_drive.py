"""Driving by hand, and the maximum speed that no command exceeds."""

from __future__ import annotations

import asyncio
import json
import math
from dataclasses import replace
from typing import Any
from unittest.mock import patch

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tangy_hw.device_protocols import STILL, Scan, Stamped, Twist
from tangy_hw.navigation.limits import MotionLimits
from tangy_hw.navigation.navigator import Navigator
from tangy_hw.robot_process.hand_drive import FIRST_SECONDS, HOLDS_SECONDS, OVERRIDE, HandDrive
from tangy_hw.robot_process.wheels import OLD_SECONDS, Wheels
from tangy_profiles.robot import load_robot
from tests.bench.people_keys import speed_when_met
from tests.hw.live_bodies import ToldBody
from tests.hw.ros_links import soon
from tests.hw.test_robot_lines import Spoken, spoken

LIMITS = MotionLimits()
BEAMS, FIRST = 271, -math.radians(135)


def scan(**ahead: float) -> Scan:
    """Return a scan of nothing, or with an object this far off on the named sides."""
    ranges = np.full(BEAMS, np.inf)
    for side, far in ahead.items():
        ranges[{"front": 135, "left": 225, "right": 45}[side] + np.arange(-9, 10)] = far
    return Scan(FIRST, math.radians(1), ranges, 30.0)


def drive(twist: Twist, around: Scan | None) -> tuple[Twist | None, str]:
    """Return what the robot is told once it has sped up."""
    hand, told = HandDrive(LIMITS), None
    for tick in range(15):
        hand.tell(twist, tick / 10)
        told = hand.command(around, tick / 10)
    return told, hand.held


class TestHandDrive:
    def test_a_robot_with_corners_turns_only_where_they_have_room(self) -> None:
        corners = ((0.4, 0.3), (-0.4, 0.3), (-0.4, -0.3), (0.4, -0.3))
        large = replace(LIMITS, radius=0.5, corners=corners)
        for limits, result in ((LIMITS, ""), (large, "stands")):
            hand = HandDrive(limits)
            hand.tell(Twist(0.0, 0.4), 0.0)
            twist = hand.command(scan(left=0.45), 0.1)
            assert (twist == STILL) == (result == "stands") and hand.held == result
        hand.tell(Twist(0.0, 0.4), 0.2)
        assert hand.command(scan(left=1.5), 0.3) == Twist(0.0, 0.4)

    def test_a_command_expires_and_the_robot_stops(self) -> None:
        hand = HandDrive(LIMITS)
        assert hand.command(scan(), 0.0) is None
        hand.tell(Twist(0.0, 0.3), 1.0)
        assert hand.command(scan(), 1.0 + HOLDS_SECONDS - 0.01) == Twist(0.0, 0.3)
        assert hand.command(scan(), 1.0 + HOLDS_SECONDS) == STILL
        assert hand.command(scan(), 2.0) is None

    def test_each_command_is_reported_as_free_slowed_or_stopped(self) -> None:
        assert drive(Twist(0.3, 0.0), scan(front=2.9)) == (Twist(0.3, 0.0), "")
        slow, held = drive(Twist(0.5, 0.0), scan(front=0.8))
        assert slow is not None and 0 < slow.forward < 0.3 and held == "slow"
        assert drive(Twist(0.3, 0.0), scan(front=0.5)) == (STILL, "stands")
        assert drive(Twist(-0.1, 0.0), scan(front=0.3)) == (Twist(-0.1, 0.0), "")
        assert drive(Twist(0.0, 0.3), scan(front=0.3)) == (Twist(0.0, 0.3), "")

    def test_the_robot_stops_before_obstacles_known_only_from_the_map(self) -> None:
        hand = HandDrive(LIMITS)
        hand.tell(Twist(0.3, 0.0), 0.0)
        assert hand.command(scan(), 0.1, np.array([[0.35, 0.1]])) == STILL

    @pytest.mark.parametrize("forward", [0.5, -0.5, 9.0])
    def test_an_override_crawls_past_close_objects_while_the_key_is_held(
        self, forward: float
    ) -> None:
        hand = HandDrive(LIMITS)
        hand.tell(Twist(forward, 0.0), 0.0, overrides=True)
        crawl = Twist(math.copysign(OVERRIDE, forward), 0.0)
        hand.command(scan(front=0.4), 0.1)
        assert hand.command(scan(front=0.4), 0.2) == crawl and hand.held == "overridden"
        assert hand.command(None, 0.3) == STILL
        assert hand.command(scan(front=0.4), HOLDS_SECONDS) == STILL
        hand.tell(Twist(forward, 0.0), 1.0)
        assert hand.command(scan(front=0.4, left=0.4), 1.1) != crawl

    def test_the_robot_stops_without_a_scan(self) -> None:
        assert drive(Twist(0.3, 0.0), None) == (STILL, "stands")
        assert drive(Twist(0.0, 0.3), None) == (STILL, "stands")

    async def test_the_robot_uses_the_newest_scan_and_stops_for_an_old_one(self) -> None:
        async with spoken() as one:
            laser = one.parts.laser
            laser.scan = Stamped(scan(), 0.0, 1)
            await one.take(do="drive", forward=9.0, turn=0.0)
            one.robot.tick()
            laser.scan = Stamped(scan(front=0.5), 0.0, 2)
            one.robot.tick()
            assert one.state().held == "stands"
            laser.scan, laser.age = Stamped(scan(), 0.0, 3), 5.0
            one.robot.tick()
            assert one.robot.wheels.driven == STILL
            assert "laser scanner says nothing" in one.state().hazard
            laser.age = 0.0
            await asyncio.sleep(0)  # the command to stand is sent
            await one.take(do="drive", forward=9.0, turn=0.0)
            one.robot.tick()
            assert 0.0 < one.robot.wheels.driven.forward <= one.robot.robot.speed


class TestAcceleration:
    def test_the_robot_speeds_up_as_its_body_can_and_slows_down_at_once(self) -> None:
        hand = HandDrive(replace(LIMITS, acceleration=0.2))
        hand.tell(Twist(0.5, 0.2), 0.0)
        first = hand.command(scan(), 0.0)
        assert first == pytest.approx((0.02, 0.008))  # on the same arc
        assert hand.command(scan(), 0.3) == pytest.approx((0.08, 0.032))
        hand.tell(Twist(0.05, 0.0), 0.35)
        assert hand.command(scan(), 0.35) == Twist(0.05, 0.0)
        hand.tell(Twist(-0.5, 0.0), 0.4)
        assert hand.command(scan(), 0.4) == pytest.approx((-0.01, 0.0))

    @given(st.lists(st.tuples(st.floats(-1.0, 1.0), st.floats(0.01, 0.6)), max_size=20))
    def test_no_two_commands_differ_by_more_than_the_acceleration(
        self, keys: list[tuple[float, float]]
    ) -> None:
        hand, now, before = HandDrive(LIMITS), 0.0, 0.0
        for forward, seconds in keys:
            now += seconds
            hand.tell(Twist(forward, 0.0), now)
            told = hand.command(scan(), now)
            after = 0.0 if told is None else told.forward
            most = LIMITS.acceleration * max(seconds, FIRST_SECONDS) + 1e-9
            assert abs(after) <= (abs(before) if after * before > 0 else 0.0) + most
            before = after


class TestPeopleWhoSetOff:
    """A person stands ahead, and walks at the robot once it is within `gap` m."""

    @pytest.mark.parametrize("walks", [1.0, 1.2])
    @pytest.mark.parametrize("gap", [0.64, 0.76, 0.88])
    def test_the_robot_stops_before_it_meets_a_walking_person(
        self, gap: float, walks: float
    ) -> None:
        assert speed_when_met(gap, walks) == 0.0


NUMBERS = st.floats() | st.sampled_from([5.0, -5.0, 0.51, 1e308, math.nan, math.inf, -math.inf])
TWISTS = st.builds(Twist, NUMBERS, NUMBERS)


def may_drive(told: list[Any], speed: float) -> None:
    """Check that no command to a base exceeds the maximum speed."""
    for twist in told:
        if twist == "stop":
            continue
        assert all(map(math.isfinite, twist))
        assert abs(twist.forward) <= speed and abs(twist.turn) <= LIMITS.max_turn


class TestClamp:
    @given(TWISTS, st.floats(0.05, 3.0))
    def test_a_twist_is_slowed_down_on_its_own_arc(self, twist: Twist, speed: float) -> None:
        limits = replace(LIMITS, max_speed=speed)
        clamped = limits.clamped(twist)
        may_drive([clamped], speed)
        if all(map(math.isfinite, twist)) and clamped != twist and clamped != STILL:
            assert clamped.forward * twist.turn == pytest.approx(clamped.turn * twist.forward)
        if not all(map(math.isfinite, twist)):
            assert clamped == STILL

    @given(TWISTS)
    async def test_the_wheels_get_no_command_above_the_maximum_speed(self, twist: Twist) -> None:
        parts = ToldBody()
        wheels = Wheels(parts.base, LIMITS)
        wheels.send(twist)
        if wheels.sent is not None:
            await soon(wheels.sent)
        assert len(parts.told) == 1
        may_drive(parts.told, LIMITS.max_speed)
        may_drive([wheels.driven], LIMITS.max_speed)

    @pytest.mark.parametrize(("command", "told"), [(Twist(0.3, 0.0), []), (STILL, ["stop"])])
    async def test_a_command_decided_before_a_freeze_moves_nothing_after_it(
        self, command: Twist, told: list[object]
    ) -> None:
        parts, now = ToldBody(), 0.0
        wheels = Wheels(parts.base, LIMITS, clock=lambda: now)
        wheels.send(command)
        now = OLD_SECONDS  # frozen before the command was written
        assert wheels.sent is not None
        await soon(wheels.sent)
        assert parts.told == told
        wheels.send(Twist(0.2, 0.0))
        await soon(wheels.sent)
        assert parts.told == [*told, Twist(0.2, 0.0)]

    async def test_a_stop_drops_the_command_that_is_on_its_way(self) -> None:
        parts, way = ToldBody(), asyncio.Event()

        async def drive(twist: Twist) -> None:
            await way.wait()
            parts.told.append(twist)

        wheels = Wheels(parts.base, LIMITS)
        with patch.object(parts.base, "drive", drive):
            for command in (Twist(0.3, 0.0), Twist(0.2, 0.0), STILL):
                wheels.send(command)
                await asyncio.sleep(0)
        way.set()
        assert wheels.sent is not None
        await soon(wheels.sent)
        await asyncio.sleep(0)
        assert parts.told == ["stop"] and wheels.stand

    @pytest.mark.slow
    @given(TWISTS, TWISTS, st.sampled_from(["line", "hand", "navigator", "both"]))
    async def test_no_source_of_commands_exceeds_the_maximum_speed(
        self, one: Twist, other: Twist, way: str
    ) -> None:
        process = Spoken()
        process.parts.laser.scan = Stamped(scan(), 0.0, 1)
        robot, told = process.robot, process.parts.told
        driver = other if way in ("navigator", "both") else STILL
        with patch.object(Navigator, "tick", return_value=driver):
            if way == "line":
                line = json.dumps({"do": "drive", "forward": one.forward, "turn": one.turn})
                await process.process.take(line.encode())
            elif way in ("hand", "both"):
                robot.drive_by_hand(one)
            robot.tick()
        if robot.wheels.sent is not None:
            await soon(robot.wheels.sent)
        may_drive(told, load_robot().speed)
