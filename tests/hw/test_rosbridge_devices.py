"""Devices behind ROS, each against a robot of the tests at the other end of the link."""

from __future__ import annotations

import asyncio
import math
from collections.abc import Iterable
from functools import partial
from typing import Any

import pytest

from tangy_hw.device_protocols import (
    Base,
    DeviceError,
    Laser,
    Pose,
    StopButton,
    Twist,
)
from tangy_hw.drivers.ros_base import RosBase
from tangy_hw.drivers.ros_laser import RosLaser
from tangy_hw.drivers.ros_messages import pose_message, twist_message
from tangy_hw.drivers.ros_status import RosDiagnostics, RosStopButton
from tangy_profiles.health import OK, STALE, WARN
from tests.hw.ros_links import diagnoses, linked, soon
from tests.support.waiting import until


def odometry(x: float, y: float = 0.0, heading: float = 0.0) -> dict[str, Any]:
    return {
        "pose": {"pose": pose_message(Pose(x, y, heading))},
        "twist": {"twist": twist_message(Twist(0.2, 0.1))},
    }


def driven(messages: Iterable[Any]) -> list[float]:
    return [message["linear"]["x"] for message in messages]


def has_come(laser: Laser, seq: int) -> bool:
    return laser.scan is not None and laser.scan.seq == seq


class TestBase:
    async def test_odometry_comes_with_its_time_and_number(self) -> None:
        async with linked() as (server, bridge, now):
            base = RosBase(bridge)
            satisfied: Base = base
            await satisfied.start()
            now.time += 0.2
            assert base.odometry is None
            assert base.reading().state == STALE
            assert base.reading().age == pytest.approx(0.2)
            await soon(server.subscribed("/odom"))
            for x in (1.0, 2.0):
                server.publish("/odom", "nav_msgs/Odometry", odometry(x, 3.0, 0.5))
            await until(lambda: base.odometry is not None and base.odometry.seq == 2)
            assert base.odometry is not None
            assert base.odometry.value.pose == pytest.approx((2.0, 3.0, 0.5))
            assert base.odometry.value.twist == (0.2, 0.1)
            assert base.odometry.stamp == now.time
            now.time += 0.3
            assert base.reading() == ("base", pytest.approx(0.3), OK, {}, None)
            await base.close()

    async def test_a_command_repeats_until_it_expires_and_becomes_zero(self) -> None:
        async with linked() as (server, bridge, now):
            base, heard = RosBase(bridge, repeat=0.01), list[Any]()
            server.on_message("/cmd_vel", heard.append)
            await base.start()
            await base.drive(Twist(0.3, 0.1))
            await until(lambda: len(heard) >= 5)
            assert set(driven(heard[1:])) == {0.3}
            now.time += 0.51
            await until(lambda: driven(heard)[-1] == 0.0)
            said = len(heard)
            await asyncio.sleep(0.05)
            assert len(heard) == said
            await base.close()

    async def test_a_stop_overtakes_queued_messages_and_drops_queued_drives(
        self,
    ) -> None:
        async with linked() as (server, bridge, _):
            base, heard = RosBase(bridge), list[Any]()
            server.on_message("/cmd_vel", heard.append)
            server.on_message("/load", heard.append)
            await base.start()
            await base.drive(Twist(0.3))
            await until(lambda: twist_message(Twist(0.3)) in heard)
            heard.clear()
            for number in range(500):
                bridge.publish("/load", {"n": number})
            await base.drive(Twist(0.4))
            await base.stop()
            await until(lambda: len(heard) == 501)
            assert heard[0] == twist_message(Twist())
            await base.close()

    async def test_a_stop_does_not_wait_for_a_frozen_robot(self) -> None:
        async with linked() as (server, bridge, now):
            base = RosBase(bridge)
            await base.start()
            await soon(server.subscribed("/odom"))
            server.publish("/odom", "", odometry(1))
            await until(lambda: base.odometry)
            server.pause()
            for _ in range(50):
                server.publish("/odom", "", odometry(2))
                await base.drive(Twist(0.3))
                await base.stop()
            now.time += 0.3
            assert base.reading().age == pytest.approx(0.3)
            assert bridge.connected
            await base.close()

    async def test_only_driving_is_an_error_without_a_link(
        self,
    ) -> None:
        async with linked() as (server, bridge, _):
            base, heard = RosBase(bridge, repeat=0.01), list[Any]()
            server.on_message("/cmd_vel", heard.append)
            await base.start()
            await base.drive(Twist(0.3))
            await until(lambda: heard)
            await server.close()
            await until(lambda: not bridge.connected)
            with pytest.raises(DeviceError, match="no link"):
                await base.drive(Twist(0.3))
            await base.stop()
            heard.clear()
            await server.start()
            await until(lambda: heard)
            await asyncio.sleep(0.03)
            assert set(driven(heard)) == {0.0}
            await base.close()

    async def test_an_invalid_speed_is_refused(self) -> None:
        async with linked() as (_, bridge, _now):
            base = RosBase(bridge)
            with pytest.raises(DeviceError, match="switched off"):
                await base.drive(Twist(0.1))
            await base.start()
            with pytest.raises(DeviceError, match="cannot drive"):
                await base.drive(Twist(math.nan))
            await base.close()

    async def test_bases_of_ros_2_may_want_a_header(self) -> None:
        async with linked(ros=2) as (server, bridge, _):
            base, heard = RosBase(bridge, stamped=True), list[Any]()
            await base.start()
            await until(lambda: not bridge.waiting)
            server.on_message("/cmd_vel", heard.append)
            await base.drive(Twist(0.3))
            await until(lambda: heard)
            assert heard[-1]["twist"] == twist_message(Twist(0.3))
            assert heard[-1]["header"]["stamp"] == {"sec": 0, "nanosec": 0}
            await base.close()

    async def test_a_restarted_base_waits_for_new_data(self) -> None:
        async with linked() as (server, bridge, now):
            base = RosBase(bridge)
            await base.start()
            await soon(server.subscribed("/odom"))
            server.publish("/odom", "", odometry(1))
            await until(lambda: base.odometry)
            await base.close()
            now.time += 1
            await base.start()
            assert base.reading() == ("base", 0.0, STALE, {}, None)
            await soon(server.subscribed("/odom"))
            server.publish("/odom", "", odometry(1))
            await until(lambda: base.reading().state == OK)
            await base.close()


class TestLaser:
    async def test_a_covered_scanner_sees_near_things_that_do_not_change(self) -> None:
        async with linked() as (server, bridge, now):
            laser = RosLaser(bridge)
            satisfied: Laser = laser
            await satisfied.start()
            await soon(server.subscribed("/scan"))
            shape = {"angle_min": -1, "angle_increment": 0.01, "range_min": 0.1, "range_max": 5}
            for number in range(24):
                now.time += 0.1
                covered = number >= 12
                ranges = [0.05 if covered else 2 + 0.01 * ((number + i) % 2) for i in range(200)]
                server.publish("/scan", "", {**shape, "ranges": ranges})
                await until(partial(has_come, laser, number + 1))
                if number == 5:
                    assert "variety" not in laser.reading().facts
                if number == 11:
                    assert laser.reading().facts == {"near_share": 0, "variety": 1}
            facts = {"near_share": 1, "variety": 0}
            assert laser.reading()[:4] == ("laser", 0.0, OK, facts)
            assert laser.reading().rate == pytest.approx(10, abs=0.5)
            assert laser.scan is not None
            assert math.isinf(laser.scan.value.ranges[0])
            await laser.close()


class TestStopButton:
    async def test_the_stop_button_reports_its_state(self) -> None:
        async with linked() as (server, bridge, now):
            button = RosStopButton(bridge)
            satisfied: StopButton = button
            await satisfied.start()
            await soon(server.subscribed("/stop_button"))
            assert button.reading() == ("stop_button", 0.0, STALE, {"latched": False}, None)
            server.publish("/stop_button", "std_msgs/Bool", {"data": True})
            await until(lambda: button.latched)
            server.publish("/stop_button", "std_msgs/Bool", {"data": False})
            await until(lambda: not button.latched)
            assert button.reading().state == OK
            server.publish("/stop_button", "std_msgs/Bool", {"data": "false"})
            now.time += 0.3
            assert button.reading().age == pytest.approx(0.3)
            await button.close()

    async def test_a_button_that_reports_only_changes_is_as_old_as_the_link(self) -> None:
        async with linked() as (server, bridge, now):
            button = RosStopButton(bridge, pressed=False, changes_only=True)
            await button.start()
            bridge.subscribe("/odom", "", lambda _: None)
            await soon(server.subscribed("/stop_button", "/odom"))
            server.publish("/stop_button", "", {"data": False})
            await until(lambda: button.latched)
            now.time += 5
            server.publish("/odom", "", {})
            await until(lambda: button.reading().age == 0)
            await button.close()


class TestDiagnostics:
    async def test_the_worst_recent_diagnosis_of_a_device_counts(self) -> None:
        async with linked() as (server, bridge, now):
            told = RosDiagnostics(bridge, names={"kobuki": "base"})
            base = RosBase(bridge, diagnostics=told)
            await told.start()
            await base.start()
            await soon(server.subscribed("/diagnostics", "/odom"))
            server.publish("/odom", "", odometry(1))
            server.publish(
                "/diagnostics",
                "diagnostic_msgs/DiagnosticArray",
                diagnoses(
                    ("/robot/Stop Button: state", 0, ""),
                    ("kobuki", 1, "hot"),
                    ("Base: right", 0, ""),
                ),
            )
            await until(lambda: base.odometry and told.reading().state == OK)
            assert base.reading().state == WARN
            button, wheels = told.of("stop_button"), told.of("base")
            assert button is not None and button.state == OK
            assert wheels is not None and wheels.says == "hot"
            assert told.of("laser") is None
            now.time += 6
            assert (told.of("base"), told.age("base"), told.age("laser")) == (None, 6, None)
            await base.close()
            await told.close()
