"""The bench as a process and over its links, tested with the real drivers."""

from __future__ import annotations

import asyncio
import contextlib
import json
import sys
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from math import pi
from typing import Any

import cv2
import numpy as np
import pytest

from tangy_hw.device_protocols import DeviceError, Twist
from tangy_hw.drivers.ros_arms import RosArms
from tangy_hw.drivers.ros_base import RosBase
from tangy_hw.drivers.ros_status import RosDiagnostics, RosStopButton
from tangy_hw.drivers.ros_voice import RosVoice
from tangy_hw.drivers.rosbridge import Rosbridge
from tangy_hw.drivers.scip import ScipLaser
from tangy_hw.drivers.simulated_clock import SteppedClock
from tangy_profiles.health import ERROR
from tangy_sim.device_simulator.__main__ import main
from tangy_sim.device_simulator.device_servers import DeviceServers
from tangy_sim.device_simulator.lidar import Lidar
from tangy_sim.servers.link_relay import LinkQuality
from tests.sim.bench_game import ROBOT, bench

FACES = {f"user{number}": number for number in range(1, 5)}
CHILD = (sys.executable, "-P", "-m", "tangy_sim.device_simulator", "--activity", "bingo")


class Peer:
    """A robot's drivers at a bench with stepped time."""

    def __init__(self, bench: DeviceServers, wires: dict[str, Any]) -> None:
        self.bench, self.world, self.wires = bench, bench.world, wires
        self.clock = SteppedClock()
        # Stepping the bench has its own link, which still answers when the robot's is lost.
        self.timing = Rosbridge(wires["rosbridge"], clock=self.clock.now)
        self.link = Rosbridge(wires["rosbridge"], clock=self.clock.now)
        self.diagnostics = RosDiagnostics(self.link)
        self.base = RosBase(self.link)
        self.arms = RosArms(self.link, ROBOT.limbs, diagnostics=self.diagnostics)
        self.voice = RosVoice(self.link, diagnostics=self.diagnostics)
        self.button = RosStopButton(self.link)
        self.laser = ScipLaser(wires["scip"], clock=self.clock.now, stale_after=0.25)
        self._scans = 0

    async def start(self) -> None:
        """Open every device, and wait for its first data."""
        await self.timing.start()
        for one in (self.diagnostics, self.base, self.arms, self.voice, self.button, self.laser):
            await one.start()
        assert await self.timing.wait_connected(5.0) and await self.link.wait_connected(5.0)
        self.clock.follow(self.timing, {"laser": self.counted})
        await asyncio.wait_for(self.bench.ros.subscribed("/odom", "/stop_button"), 5.0)
        async with asyncio.timeout(5.0):
            while not self.bench.scip.measuring:  # noqa: ASYNC110
                await asyncio.sleep(0.01)

    def counted(self) -> int:
        return 0 if self.laser.scan is None else self.laser.scan.seq

    async def close(self) -> None:
        """Close every device."""
        for one in (self.laser, self.button, self.voice, self.arms, self.base, self.diagnostics):
            await one.close()
        await self.link.close()
        await self.timing.close()

    async def passes(self, seconds: float, twist: Twist | None = None) -> None:
        """Step the bench while the robot drives."""
        for _ in range(round(seconds / 0.05)):
            if twist is not None:
                await self.base.drive(twist)
                await asyncio.sleep(0)
            await self.clock.sleep(0.05)

    async def while_passing(self, work: Any, most: float = 30.0) -> Any:
        """Step the bench until a task is done, and return its result."""
        task = asyncio.ensure_future(work)
        for _ in range(round(most / 0.05)):
            await self.clock.sleep(0.05)
            if task.done():
                break
        return task.result()


@asynccontextmanager
async def served(
    *, stepped: bool = True, link: LinkQuality | None = None
) -> AsyncIterator[tuple[DeviceServers, dict[str, Any]]]:
    """Serve a bench in this process."""
    one = DeviceServers(bench(3), stepped=stepped, faces=FACES, link=link)
    wires = await one.start()
    try:
        yield one, wires
    finally:
        await one.close()


@asynccontextmanager
async def played() -> AsyncIterator[Peer]:
    """Serve a bench, and open a robot's drivers on it."""
    async with served() as (one, wires):
        one.do({"do": "begin"})
        peer = Peer(one, wires)
        try:
            await peer.start()
            await peer.passes(0.3)
            yield peer
        finally:
            await peer.close()


class TestSteppedTime:
    async def test_a_step_advances_time_and_delivers_all_due_messages(self) -> None:
        async with played() as peer:
            began, scans = peer.world.now, peer.counted()
            assert peer.base.odometry is not None
            odometries = peer.base.odometry.seq
            await peer.passes(2.0)
            assert peer.world.now - began == pytest.approx(2.0)
            assert peer.clock.now() == pytest.approx(peer.world.now)
            assert peer.counted() - scans == 20
            assert peer.base.odometry.seq - odometries == 40
            await asyncio.sleep(0.15)
            assert peer.world.now - began == pytest.approx(2.0)

    async def test_an_invalid_step_is_refused(self) -> None:
        async with played() as peer:
            for seconds in (0, -1, 1e9):
                with pytest.raises(DeviceError):
                    await peer.timing.call("/bench/advance", {"seconds": seconds})


class TestDrivers:
    async def test_the_base_drives_and_sends_odometry(self) -> None:
        async with played() as peer:
            await peer.passes(1.0, Twist(0.4, 0.0))
            assert peer.base.odometry is not None
            seen, true = peer.base.odometry.value, peer.world.wheels
            assert seen.pose.x == pytest.approx(true.odometry.x, abs=1e-6) and seen.pose.x > 0.1
            assert seen.twist.forward == pytest.approx(true.forward)
            await peer.base.stop()
            await peer.passes(0.6)
            assert true.forward == 0.0

    async def test_the_laser_measures_the_room(self) -> None:
        async with played() as peer:
            assert peer.laser.scan is not None
            scan = peer.laser.scan.value
            world, exact = peer.world, Lidar(360, scan.first, scan.step, noise=0.0)
            true = exact.scan(world.wheels.pose, world.floor, np.random.default_rng(1))
            assert np.median(np.abs(scan.ranges - true)) < 0.02
            assert scan.first == pytest.approx(-0.75 * pi) and len(scan.ranges) == 360

    async def test_the_head_moves_and_people_understand_the_voice(self) -> None:
        async with played() as peer:
            down = {"head": [0, 0, 0, -15, -20, 0]}
            await peer.while_passing(peer.arms.pose(down, 0.5))
            assert peer.world.joints.angle("head/neck nod") == pytest.approx(-20, abs=3)
            words = "Hello, everybody. I am Tangy, and today we play Bingo."
            began = peer.world.now
            await peer.while_passing(peer.voice.say(words))
            assert 3.0 < peer.world.now - began < 6.0
            assert peer.bench.do({"do": "truth"})["truth"]["opened"]

    async def test_joints_stop_soon_after_hold(self) -> None:
        async with played() as peer:
            joint, joints = "right_arm/shoulder pitch", peer.world.joints
            posing = asyncio.create_task(peer.arms.pose(ROBOT.postures["wave"], 1.5))
            await peer.passes(0.7)
            assert 20 < joints.angle(joint) < 120
            before = joints.angle(joint)
            await peer.arms.hold()
            await peer.passes(0.2)
            stands = dict(joints.positions)
            assert joints.angle(joint) == pytest.approx(before, abs=10)
            assert not any(joints.speeds.values())
            await peer.passes(2.0)
            assert joints.positions == stands
            with pytest.raises(DeviceError, match="hold"):
                await posing


class TestFaults:
    async def test_the_button_latches_until_the_expert_resets_it(self) -> None:
        async with played() as peer:
            assert not peer.button.latched
            peer.bench.do({"do": "inject", "kind": "emergency-stop"})
            await peer.passes(0.3, Twist(0.4, 0.0))
            assert peer.button.latched and peer.world.wheels.forward == 0.0
            peer.bench.do({"do": "mend", "fault": "emergency-stop"})
            await peer.passes(0.3)
            assert not peer.button.latched

    @pytest.mark.parametrize(
        ("kind", "silent"),
        [
            ("base-failed", {"base"}),
            ("stop-button-silent", {"stop_button"}),
            ("laser-disconnected", {"laser"}),
            ("link-lost", {"base", "stop_button", "laser", "link", "arms", "voice"}),
        ],
    )
    async def test_only_the_silent_device_becomes_stale(self, kind: str, silent: set[str]) -> None:
        async with played() as peer:
            peer.bench.do({"do": "inject", "kind": kind})
            await peer.passes(1.5)
            devices = (peer.base, peer.button, peer.laser, peer.link, peer.arms, peer.voice)
            old = {one.reading().device for one in devices if one.reading().age > 0.6}
            assert old == silent
            peer.bench.do({"do": "lift", "kind": kind})
            await peer.passes(0.5)
            assert all(one.reading().age < 0.6 for one in devices)

    async def test_a_servo_s_error_is_diagnosed(self) -> None:
        async with played() as peer:
            peer.bench.do({"do": "inject", "kind": "arm-failed"})
            await peer.passes(0.5)
            assert peer.arms.reading().state == ERROR
            with pytest.raises(DeviceError):
                await peer.arms.pose({"left_arm": [0, 5, 0, 10, 0, 0]}, 0.5)

    @pytest.mark.slow
    async def test_a_dead_voice_says_nothing(self) -> None:
        async with played() as peer:
            peer.bench.do({"do": "inject", "kind": "voice-dead"})
            with pytest.raises(DeviceError):
                await peer.while_passing(peer.voice.say("Let us go on."))
            assert peer.voice.reading().state == ERROR


class TestCameras:
    @pytest.mark.slow
    async def test_streams_show_the_current_scene_until_the_camera_is_unplugged(self) -> None:
        async with served() as (one, wires):
            world = one.world
            seat = world.room.stand("user2", world.people.ids)
            world.wheels.pose = world.wheels.pose._replace(x=seat.x, y=seat.y)
            reader, writer = await _look(wires["head"])
            face = await _frame(reader)
            assert face.shape == (720, 1280, 3)
            world.faults.inject("camera-occluded", 0.0)
            async with asyncio.timeout(5.0):
                while (await _frame(reader)).mean() > 20:
                    pass
            one.do({"do": "inject", "kind": "camera-disconnected"})
            async with asyncio.timeout(5.0):
                with contextlib.suppress(OSError):
                    while await reader.read(1 << 16):
                        pass
            writer.close()

    async def test_signs_are_bright_in_the_infrared_stream(self) -> None:
        async with served() as (one, wires):
            reader, writer = await _look(wires["infrared"])
            dark = await _frame(reader)
            one.world.people.sitters["user3"].asks_since = 0.0
            async with asyncio.timeout(5.0):
                while (await _frame(reader)).max() < 180:
                    pass
            assert dark.shape[:2] == (240, 320) and dark.max() < 120
            one.do({"do": "inject", "kind": "requests-silent"})
            with pytest.raises(TimeoutError):
                async with asyncio.timeout(0.4):
                    while True:
                        await _frame(reader)
            writer.close()


class TestMachineTime:
    async def test_time_passes_by_the_machine_clock(self) -> None:
        async with served(stepped=False) as (one, wires):
            passing = asyncio.create_task(one.run())
            link = Rosbridge(wires["rosbridge"])
            base = RosBase(link)
            await base.start()
            async with asyncio.timeout(5.0):
                while base.odometry is None or base.odometry.seq < 5:  # noqa: ASYNC110
                    await asyncio.sleep(0.02)
            assert one.world.now > 0.1
            with pytest.raises(DeviceError):
                await link.call("/bench/advance", {"seconds": 0.1})
            passing.cancel()
            await base.close()
            await link.close()


class TestBadLink:
    async def test_drivers_work_with_delay_over_a_bad_link(self) -> None:
        async with served(stepped=False, link=LinkQuality(0.1, 0.05)) as (one, wires):
            assert wires["rosbridge"] != one.ros.url and wires["scip"] != one.scip.url
            assert wires["head"] != one.film.url("/head")
            passing = asyncio.create_task(one.run())
            link = Rosbridge(wires["rosbridge"])
            base, laser = RosBase(link), ScipLaser(wires["scip"], stale_after=5.0)
            await base.start()
            await laser.start()
            async with asyncio.timeout(20.0):
                while base.odometry is None or laser.scan is None:  # noqa: ASYNC110
                    await asyncio.sleep(0.02)
                told = asyncio.get_running_loop().time()
                while one.world.wheels.forward == 0.0:
                    await base.drive(Twist(0.2, 0.0))
                    await asyncio.sleep(0.02)
            assert asyncio.get_running_loop().time() - told >= 0.1
            passing.cancel()
            await laser.close()
            await base.close()
            await link.close()


class TestProcess:
    @pytest.mark.slow
    async def test_the_process_prints_its_addresses_obeys_and_ends_with_stdin(self) -> None:
        process = await asyncio.create_subprocess_exec(
            *CHILD, "--seed", "5", "--stepped", "--person", "ann=Ann", "--person", "bo",
            stdin=asyncio.subprocess.PIPE, stdout=asyncio.subprocess.PIPE,
        )  # fmt: skip
        assert process.stdin is not None and process.stdout is not None

        async def told(**what: Any) -> dict[str, Any]:
            assert process.stdin is not None and process.stdout is not None
            process.stdin.write(json.dumps(what).encode() + b"\n")
            return dict(json.loads(await process.stdout.readline()))

        async with asyncio.timeout(30.0):
            ready = json.loads(await process.stdout.readline())["ready"]
            assert ready["rosbridge"].startswith("ws://127.0.0.1:")
            assert ready["scip"].startswith("tcp://127.0.0.1:")
            assert set(ready["faces"]) == {"ann", "bo"} and len(ready["corners"]) == 4
            began = await told(do="begin", id=7)
            assert began["id"] == 7 and set(began["cards"]) == {"ann", "bo"}
            assert (await told(do="inject", kind="camera-frozen"))["code"] == "camera-frozen"
            assert (await told(do="truth"))["truth"]["faults"]
            assert (await told(do="mend", fault="camera-frozen"))["lifted"] == ["camera-frozen"]
            for wrong in ({"do": "dance"}, {"do": "inject", "kind": "rain"}, {}):
                assert "does not understand" in (await told(**wrong))["failed"]
            process.stdin.close()
            assert await process.wait() == 0

    @pytest.mark.parametrize("wrong", [["--users", "40"], ["--room", "no such"],
                                       ["--person", "a=A", "--person", "a=B"]])  # fmt: skip
    def test_an_invalid_option_is_refused_in_one_sentence(
        self, wrong: list[str], capsys: pytest.CaptureFixture[str]
    ) -> None:
        assert main([*wrong, "--activity", "bingo"]) == 2
        told = capsys.readouterr()
        assert told.out == "" and len(told.err.splitlines()) == 1


async def _look(url: str) -> tuple[asyncio.StreamReader, asyncio.StreamWriter]:
    host, _, path = url.removeprefix("http://").partition("/")
    name, _, port = host.partition(":")
    reader, writer = await asyncio.open_connection(name, int(port), limit=1 << 22)
    writer.write(f"GET /{path} HTTP/1.0\r\n\r\n".encode())
    return reader, writer


async def _frame(reader: asyncio.StreamReader) -> Any:
    head = await reader.readuntil(b"\r\n\r\n")
    while b"Content-Length" not in head:
        head = await reader.readuntil(b"\r\n\r\n")
    length = int(head.split(b"Content-Length:")[1].split(b"\r\n")[0])
    packed = np.frombuffer(await reader.readexactly(length), np.uint8)
    return cv2.imdecode(packed, cv2.IMREAD_COLOR)
