"""Arms of Dynamixel servos, by Robotis' package against a bus of the tests."""

from __future__ import annotations

import asyncio
import math
import sys
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tangy_hw.device_protocols import Arms, DeviceError
from tangy_hw.drivers import dynamixel
from tangy_hw.drivers.dynamixel import DynamixelArms, Servo, servos_of
from tangy_hw.drivers.dynamixel_bus import Bus, BusError, meaning, speed
from tangy_profiles.health import ERROR, OK, STALE
from tangy_profiles.robot import Limb
from tests.hw.ros_links import Now, soon
from tests.hw.servo_bus import ServoBus
from tests.support.waiting import until

pytest.importorskip("dynamixel_sdk", reason="the extra `dynamixel` is not installed")

LIMBS = {
    "arm": Limb("arm", ("shoulder", "elbow"), (-90, 0), (90, 140)),
    "head": Limb("head", ("neck nod", "mouth"), (-35, 0), (30, 25)),
}
SERVOS = "arm/shoulder = 1, arm/elbow = -2@90, head/neck nod = 7"


def raised(error: Exception) -> None:
    raise error


@asynccontextmanager
async def armed() -> AsyncIterator[tuple[ServoBus, DynamixelArms, Now]]:
    now = Now()
    with ServoBus(1, 2, 7) as bus:
        arms = DynamixelArms(bus.path, LIMBS, servos_of(SERVOS), clock=now)
        await arms.start()
        await until(lambda: arms.reading().state == OK)
        yield bus, arms, now
        await arms.close()


class TestServos:
    def test_servos_are_read_from_a_profile(self) -> None:
        assert servos_of(SERVOS) == {
            "arm/shoulder": Servo(1, 1, 180),
            "arm/elbow": Servo(2, -1, 90),
            "head/neck nod": Servo(7, 1, 180),
        }
        for wrong in ("arm", "arm/elbow = x", "a=1, b=1", "a=1, a=2", "a=253", "a=1@361", "=1"):
            with pytest.raises(DeviceError):
                servos_of(wrong)
        with pytest.raises(DeviceError, match="there is no joint tail/tip"):
            DynamixelArms("/dev/null", LIMBS, servos_of("tail/tip = 3"))

    @given(st.floats(-3, 3), st.sampled_from([1, -1]), st.floats(0, 360))
    def test_a_joint_s_angle_is_that_of_its_servo_and_back(
        self, angle: float, turns: int, zero: float
    ) -> None:
        servo = Servo(1, turns, zero)
        assert servo.joint(servo.angle(angle)) == pytest.approx(angle)
        assert servo.angle(0) == zero

    def test_a_speed_is_a_time_or_turns_a_minute_as_the_servo_wants_it(self) -> None:
        assert speed(90, 1.5, 4) == 1500
        # 60 degrees in 2 s are five turns a minute
        assert speed(60, 2, 0) == round(5 / 0.229)
        assert speed(0, 2, 0) == speed(0, 0, 4) == 1  # 0 would mean the greatest speed

    def test_bits_of_an_error_have_names(self) -> None:
        assert meaning(0b100100) == "overheating and overload"
        assert meaning(0b1000000) == "error 64"


class TestArms:
    async def test_arms_are_limp_until_the_first_posture_and_then_move_together(self) -> None:
        async with armed() as (bus, arms, _):
            satisfied: Arms = arms
            assert not any(servo.torque for servo in bus.servos.values())
            bus.servos[2].position = 1000
            await soon(satisfied.pose({"arm": (45, 30), "head": (-10, 20)}, 0.5))
            assert all(servo.torque for servo in bus.servos.values())
            goals = {number: servo.goal for number, servo in bus.servos.items()}
            assert goals == {1: 2048 + 512, 2: round((90 - 30) * 4096 / 360), 7: 2048 - 114}
            # 45 degrees in .5 s are fifteen turns a minute
            assert bus.servos[1].speed == pytest.approx(15 / 0.229, abs=1)
            assert arms.positions["arm/shoulder"] == pytest.approx(math.radians(45), abs=0.01)
            assert arms.reading().facts == {"hardware_error": False}

    async def test_torque_switches_on_smoothly_and_off_at_the_end(self) -> None:
        async with armed() as (bus, arms, _):
            bus.servos[1].position = 1234
            await soon(arms.pose({"head": (0, 0)}, 0.2))
            assert (bus.servos[1].goal, bus.servos[1].position) == (1234, 1234)
            await arms.relax()
            assert not any(servo.torque for servo in bus.servos.values())
            await soon(arms.pose({"head": (5, 0)}, 0.2))
            assert bus.servos[7].torque
            await arms.close()
            assert not any(servo.torque for servo in bus.servos.values())

    async def test_a_servo_error_ends_the_movement_until_a_restart(self) -> None:
        async with armed() as (bus, arms, _):
            bus.servos[2].sticks = True
            posing = asyncio.create_task(arms.pose({"arm": (45, 30)}, 5))
            await until(lambda: bus.servos[1].position == 2048 + 512)
            bus.servos[2].error = 1 << 5
            with pytest.raises(DeviceError, match="the servo of arm/elbow reports overload"):
                await soon(posing)
            assert arms.reading().state == ERROR
            assert arms.reading().facts == {"hardware_error": True}
            with pytest.raises(DeviceError, match="overload"):
                await arms.pose({"head": (0, 0)}, 0.2)
            await arms.close()
            bus.servos[2].sticks = False
            await arms.start()
            await until(lambda: arms.reading().state == OK)
            assert bus.servos[2].restarts == 1
            await soon(arms.pose({"arm": (45, 30)}, 0.2))

    async def test_a_servo_error_before_the_movement_is_reported(self) -> None:
        async with armed() as (bus, arms, _):
            bus.servos[2].error = 1 << 2
            with pytest.raises(DeviceError, match="the servo of arm/elbow reports overheating"):
                await soon(arms.pose({"arm": (45, 30)}, 0.2))
            assert arms.reading().state == ERROR

    async def test_hold_stops_the_arms_in_place_with_torque(self) -> None:
        async with armed() as (bus, arms, _):
            bus.servos[2].sticks = True
            posing = asyncio.create_task(arms.pose({"arm": (45, 30)}, 5))
            await until(lambda: bus.servos[2].goal == round(60 * 4096 / 360))
            bus.servos[2].position = 1500  # on its way
            await arms.hold()
            with pytest.raises(DeviceError, match="hold"):
                await soon(posing)
            await until(lambda: bus.servos[2].goal == 1500)
            assert bus.servos[2].torque and bus.servos[1].goal == 2048 + 512
            assert bus.servos[2].speed == 1  # the slowest speed, in case it has gone too far
            bus.servos[7].there = False
            bus.servos[2].position = 1400
            await arms.hold()
            await until(lambda: bus.servos[2].goal == 1400)
            await arms.relax()
            await arms.hold()
            assert not any(servo.torque for servo in bus.servos.values() if servo.there)

    async def test_hold_works_after_a_servo_was_silent(self) -> None:
        async with armed() as (bus, arms, _):
            bus.servos[2].sticks = True
            posing = asyncio.create_task(arms.pose({"arm": (45, 30)}, 5))
            await until(lambda: bus.servos[2].goal == round(60 * 4096 / 360))
            bus.servos[2].position = 1500  # on its way
            bus.servos[7].there = False
            await until(lambda: arms.unsure)
            await arms.hold()
            with pytest.raises(DeviceError, match="hold"):
                await soon(posing)
            await until(lambda: bus.servos[2].goal == 1500)
            assert bus.servos[2].torque
            bus.servos[7].there, bus.servos[2].sticks = True, False
            bus.servos[7].write(64, b"\x00")  # it had no power
            await soon(arms.pose({"head": (5, 0)}, 0.2))
            assert bus.servos[7].torque

    async def test_hold_takes_effect_when_a_lost_port_returns(
        self, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setattr(dynamixel, "AGAIN_SECONDS", 0.3)
        async with armed() as (bus, arms, _):
            bus.servos[2].sticks = True
            posing = asyncio.create_task(arms.pose({"arm": (45, 30)}, 5))
            await until(lambda: bus.servos[2].goal == round(60 * 4096 / 360))
            bus.servos[2].position = 1500
            with monkeypatch.context() as gone:
                gone.setattr(Bus, "look", lambda *_, **__: raised(BusError("gone")))
                await until(lambda: arms.bus is None)
            await arms.hold()
            with pytest.raises(DeviceError):
                await soon(posing)
            await until(lambda: bus.servos[2].goal == 1500)

    async def test_a_stuck_joint_is_named_in_time(self) -> None:
        async with armed() as (bus, arms, now):
            bus.servos[2].sticks = True
            posing = asyncio.create_task(arms.pose({"arm": (45, 30)}, 1))
            await until(lambda: bus.servos[2].goal)
            await until(lambda: arms.positions["arm/shoulder"] > 0.5)
            now.time += 3.6
            with pytest.raises(DeviceError, match="arm/elbow is not there in time"):
                await soon(posing)

    async def test_a_silent_servo_is_named_and_makes_the_data_stale(self) -> None:
        async with armed() as (bus, arms, now):
            bus.servos[2].there = False
            now.time += 1
            await asyncio.sleep(0.3)
            bus.servos[1].position = 2148
            await until(lambda: arms.positions["arm/shoulder"] > 0.1)
            assert arms.reading().age == 1
            with pytest.raises(DeviceError, match="servo 2 does not answer"):
                await soon(arms.pose({"arm": (0, 10)}, 0.2))
            bus.servos[2].there = True
            await soon(arms.pose({"arm": (0, 10)}, 0.2))
            assert bus.servos[2].torque

    async def test_a_port_that_vanishes_is_an_error_and_no_crash(self) -> None:
        async with armed() as (bus, arms, now):
            bus.unplug()
            now.time += 1
            await until(lambda: "is not there" in arms.why)
            with pytest.raises(DeviceError, match="is not there"):
                await arms.pose({"head": (0, 0)}, 0.2)
            assert arms.reading().age == 1
            await arms.relax()

    @pytest.mark.parametrize(
        "angles", [{"tail": (1,)}, {"arm": (1,)}, {"head": (math.nan, 0)}, {"arm": (0, 120)}]
    )
    async def test_angles_beyond_the_limits_of_the_arms_are_refused(self, angles: Any) -> None:
        async with armed() as (_, arms, _now):
            with pytest.raises(DeviceError, match="cannot"):
                await arms.pose(angles, 0.2)

    async def test_a_missing_port_is_no_error_at_the_start(self) -> None:
        arms = DynamixelArms("/dev/no-such-port", LIMBS, servos_of(SERVOS))
        await arms.start()
        await asyncio.sleep(0.02)
        assert arms.reading().state == STALE
        assert arms.why == "arms: /dev/no-such-port is not there."
        await arms.close()

    async def test_a_missing_package_is_reported_with_the_install_command(
        self, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setitem(sys.modules, "dynamixel_sdk", None)
        with pytest.raises(DeviceError, match=r"pip install tangy\[dynamixel\]"):
            await DynamixelArms("/dev/ttyUSB0", LIMBS, {}).start()
