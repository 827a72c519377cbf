"""Arms and voices behind ROS, against a body of the tests at the other end of the link."""

from __future__ import annotations

import asyncio
import json
import math
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

import pytest

from tangy_hw.device_protocols import (
    Arms,
    DeviceError,
    Voice,
)
from tangy_hw.drivers.ros_arms import RosArms
from tangy_hw.drivers.ros_status import RosDiagnostics
from tangy_hw.drivers.ros_voice import RosVoice
from tangy_profiles.health import ERROR, OK
from tangy_profiles.robot import Limb
from tangy_sim.servers.rosbridge_server import RosbridgeServer
from tests.hw.ros_links import Now, diagnoses, linked, soon
from tests.support.media import make_sound
from tests.support.waiting import until

LIMBS = {
    "arm": Limb("arm", ("shoulder", "elbow"), (-90, 0), (90, 140)),
    "head": Limb("head", ("neck nod",), (-35,), (30,)),
}


class Body:
    """Joints at the other end that follow commands, one position in each `step`."""

    def __init__(self, server: RosbridgeServer) -> None:
        self.server = server
        self.positions = {"arm/shoulder": 0.0, "arm/elbow": 0.0, "neck": 0.0}
        self.goals: dict[str, float] = {}
        self.torque: list[bool] = []
        self.told: list[int] = []  # points of each trajectory
        server.on_message("/joint_trajectory", self.take)
        server.on_message("/joint_torque", lambda message: self.torque.append(message["data"]))

    def take(self, message: Any) -> None:
        self.told.append(len(message["points"]))
        if not message["points"]:
            self.goals.clear()
            return
        (point,) = message["points"]
        self.goals.update(zip(message["joint_names"], point["positions"], strict=True))

    def step(self, share: float = 1.0) -> None:
        for name, goal in self.goals.items():
            self.positions[name] += share * (goal - self.positions[name])
        names, positions = zip(*self.positions.items(), strict=True)
        self.server.publish("/joint_states", "", {"name": names, "position": positions})


@asynccontextmanager
async def armed() -> AsyncIterator[tuple[RosbridgeServer, Body, RosArms, Now]]:
    async with linked() as (server, bridge, now):
        told = RosDiagnostics(bridge)
        arms = RosArms(bridge, LIMBS, names={"head/neck nod": "neck"}, diagnostics=told)
        body = Body(server)
        await told.start()
        await arms.start()
        await soon(server.subscribed("/joint_states", "/diagnostics"))
        yield server, body, arms, now
        await arms.close()
        await told.close()


class TestArms:
    async def test_a_posture_in_degrees_is_sent_in_radians_and_awaited(self) -> None:
        async with armed() as (_, body, arms, _now):
            satisfied: Arms = arms
            posing = asyncio.create_task(
                satisfied.pose({"arm": (90, 45), "head": (-20,)}, seconds=1)
            )
            await until(lambda: body.goals)
            assert body.goals == pytest.approx(
                {"arm/shoulder": math.pi / 2, "arm/elbow": math.pi / 4, "neck": math.radians(-20)}
            )
            body.step(0.5)
            await until(lambda: arms.positions)
            assert not posing.done()
            body.step()
            await soon(posing)
            assert arms.reading().facts == {"hardware_error": False}
            assert arms.positions["neck"] == pytest.approx(math.radians(-20))

    async def test_late_or_silent_joints_are_named(self) -> None:
        async with armed() as (_, body, arms, now):
            for told, error in (
                (False, "arm/shoulder says nothing"),
                (True, "arm/elbow is not there"),
            ):
                body.goals.clear()
                posing = asyncio.create_task(arms.pose({"arm": (10, 80)}, seconds=1))
                await until(lambda: body.goals)
                if told:
                    body.positions["arm/shoulder"] = math.radians(10)
                    body.step(0)
                    await until(lambda: arms.positions)
                now.time += 3.6
                with pytest.raises(DeviceError, match=error):
                    await soon(posing)

    async def test_a_servo_error_ends_the_movement_and_blocks_the_next(self) -> None:
        async with armed() as (server, body, arms, _):
            posing = asyncio.create_task(arms.pose({"arm": (10, 80)}, seconds=1))
            await until(lambda: body.goals)
            server.publish("/diagnostics", "", diagnoses(("arms", 2, "elbow overheated")))
            with pytest.raises(DeviceError, match="elbow overheated"):
                await soon(posing)
            body.step()
            await until(lambda: arms.reading().state == ERROR)
            assert arms.reading().facts == {"hardware_error": True}
            body.goals.clear()
            with pytest.raises(DeviceError, match="elbow overheated"):
                await arms.pose({"arm": (0, 0)}, seconds=1)
            assert not body.goals

    async def test_the_newer_of_two_postures_counts_but_limbs_move_apart(self) -> None:
        async with armed() as (_, body, arms, _now):
            first = asyncio.create_task(arms.pose({"arm": (90, 45)}, seconds=1))
            await until(lambda: body.goals)
            head = asyncio.create_task(arms.pose({"head": (5,)}, seconds=1))
            second = asyncio.create_task(arms.pose({"arm": (10, 20)}, seconds=1))
            with pytest.raises(DeviceError, match="otherwise"):
                await soon(first)
            await until(lambda: body.goals.get("arm/elbow") == pytest.approx(math.radians(20)))
            body.step()
            await soon(asyncio.gather(head, second))

    async def test_limp_arms_get_torque_for_the_next_posture(self) -> None:
        async with armed() as (_, body, arms, _now):
            posing = asyncio.create_task(arms.pose({"head": (5,)}, seconds=1))
            await until(lambda: body.goals)
            await arms.relax()
            with pytest.raises(DeviceError, match="hang"):
                await soon(posing)
            await until(lambda: body.torque == [False])
            posing = asyncio.create_task(arms.pose({"head": (5,)}, seconds=1))
            await until(lambda: body.torque == [False, True])
            body.step()
            await soon(posing)

    async def test_hold_stops_the_arms_in_mid_movement(self) -> None:
        async with armed() as (_, body, arms, _now):
            posing = asyncio.create_task(arms.pose({"arm": (90, 45), "head": (-20,)}, seconds=1))
            await until(lambda: body.goals)
            body.step(0.5)
            await until(lambda: arms.positions)
            here = dict(body.positions)
            await arms.hold()
            with pytest.raises(DeviceError, match="hold"):
                await soon(posing)
            await until(lambda: body.told == [1, 1, 0])
            body.step()
            assert body.positions == here and body.torque == []

    async def test_hold_in_ros_2_sends_a_trajectory_to_the_current_angles(self) -> None:
        async with linked(ros=2) as (server, bridge, now):
            arms, body = RosArms(bridge, LIMBS, names={"head/neck nod": "neck"}), Body(server)
            await arms.start()
            await soon(server.subscribed("/joint_states"))
            body.positions["neck"] = 0.25
            body.step()
            await until(lambda: arms.positions)
            await arms.hold()
            await until(lambda: body.goals)
            assert (body.goals, body.told) == (body.positions, [1])
            body.goals.clear()
            now.time += 1  # their position is no longer known
            await arms.hold()
            await arms.relax()
            await until(lambda: body.torque == [False])
            await arms.hold()
            assert not body.goals
            await arms.close()

    @pytest.mark.parametrize("angles", [{"tail": (1,)}, {"arm": (1,)}, {"head": (math.nan,)}])
    async def test_unknown_limbs_and_angles_beyond_limits_are_refused(self, angles: Any) -> None:
        async with armed() as (_, _body, arms, _now):
            with pytest.raises(DeviceError, match="arms cannot take"):
                await arms.pose(angles, seconds=1)


class TestVoice:
    async def test_say_returns_when_the_robot_has_spoken(self) -> None:
        async with linked() as (server, bridge, _):
            voice, heard = RosVoice(bridge), list[Any]()
            satisfied: Voice = voice
            server.on_message("/voice/say", lambda message: heard.append(message["data"]))
            await satisfied.start()
            await soon(server.subscribed("/voice/said"))
            saying = asyncio.create_task(voice.say("The number is\n B 7. "))
            await until(lambda: heard)
            assert heard == ["The number is B 7."]
            server.publish("/voice/said", "", {"data": "something else"})
            server.publish("/voice/said", "", {"data": "The number is B 7. "})
            await soon(saying)
            await voice.say("  ")
            assert heard == ["The number is B 7."]

    @pytest.mark.parametrize("answer", ["1", '{"id": 1}'])
    async def test_a_robot_that_changes_texts_acknowledges_by_number(self, answer: str) -> None:
        async with linked() as (server, bridge, _):
            voice, heard = RosVoice(bridge, with_id=True), list[Any]()
            server.on_message(
                "/voice/say", lambda message: heard.append(json.loads(message["data"]))
            )
            await voice.start()
            await soon(server.subscribed("/voice/said"))
            saying = asyncio.create_task(voice.say("Hello"))
            await until(lambda: heard)
            assert heard == [{"id": 1, "text": "Hello"}]
            server.publish("/voice/said", "", {"data": answer})
            await soon(saying)

    async def test_a_dead_voice_is_an_error_until_it_speaks_again(self) -> None:
        async with linked() as (server, bridge, now):
            voice, heard = RosVoice(bridge), list[Any]()
            server.on_message("/voice/say", heard.append)
            await voice.start()
            await soon(server.subscribed("/voice/said"))
            saying = asyncio.create_task(voice.say("Hello"))
            await until(lambda: heard)
            now.time += 6
            with pytest.raises(DeviceError, match="voice did not say 'Hello'"):
                await soon(saying)
            assert voice.reading().state == ERROR
            saying = asyncio.create_task(voice.say("Hello"))
            await until(lambda: len(heard) == 2)
            server.publish("/voice/said", "", {"data": "Hello"})
            await soon(saying)
            assert voice.reading().state == OK

    async def test_play_returns_when_the_sound_has_played(self, tmp_path: Path) -> None:
        async with linked() as (server, bridge, _):
            voice, heard = RosVoice(bridge, play="/voice/play"), list[Any]()
            server.on_message("/voice/play", heard.append)
            await voice.start()
            await soon(server.subscribed("/voice/said"))
            sound = make_sound(tmp_path / "bell.wav")
            playing = asyncio.ensure_future(voice.play(sound))
            await until(lambda: bool(heard))
            assert heard == [{"data": str(sound)}] and not playing.done()
            server.publish("/voice/said", "", {"data": str(sound)})
            await soon(playing)
            with pytest.raises(DeviceError, match="plays no sounds"):
                await RosVoice(bridge).play(sound)

    async def test_hush_ends_the_current_sentence(self) -> None:
        async with linked() as (server, bridge, _):
            voice, hushed = RosVoice(bridge), list[Any]()
            server.on_message("/voice/hush", hushed.append)
            await voice.start()
            saying = asyncio.create_task(voice.say("A long story"))
            await asyncio.sleep(0)
            await voice.hush()
            await soon(saying)
            await until(lambda: hushed)
