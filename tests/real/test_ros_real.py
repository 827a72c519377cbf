"""Drivers against a robot of ROS 1: Debian's master, rospy and actionlib, each in its process.

    apt-get install --no-install-recommends ros-base python3-rospy python3-sensor-msgs \
        python3-nav-msgs python3-geometry-msgs python3-diagnostic-msgs python3-trajectory-msgs \
        python3-move-base-msgs python3-actionlib

It also runs Tangy's server against a client of others, PyPI's roslibpy.
"""

from __future__ import annotations

import asyncio
import importlib.util
import json
import math
import os
import shutil
import signal
import socket
import subprocess
import sys
import time
from collections.abc import AsyncIterator, Callable, Iterator, Mapping
from contextlib import asynccontextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest
import websockets

from tangy_hw.device_protocols import DeviceError, Pose, Twist
from tangy_hw.drivers.ros_arms import RosArms
from tangy_hw.drivers.ros_base import RosBase
from tangy_hw.drivers.ros_laser import RosLaser
from tangy_hw.drivers.ros_navigator import RosNavigator
from tangy_hw.drivers.ros_status import RosDiagnostics, RosStopButton
from tangy_hw.drivers.ros_voice import RosVoice
from tangy_hw.drivers.rosbridge import Rosbridge
from tangy_profiles.health import ERROR, OK
from tangy_profiles.robot import Limb
from tangy_sim.servers.rosbridge_server import RosbridgeServer
from tests.support.waiting import until

HERE = Path(__file__).parent
PYTHON = "/usr/bin/python3"
NEEDS = "rospy, actionlib, move_base_msgs.msg, nav_msgs.msg, diagnostic_msgs.msg"
STALE_SECONDS = 0.25

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("ros"), pytest.mark.elsewhere]


def absent() -> str:
    """Return what these tests need and this machine lacks; "" for nothing."""
    if shutil.which("roscore", path="/usr/bin") is None:
        return "there is no ROS 1 (Debian: ros-base)"
    found = subprocess.run(  # noqa: S603
        [
            PYTHON,
            "-c",
            f"import {NEEDS}, trajectory_msgs.msg, sys; assert sys.version_info >= (3, 10)",
        ],
        capture_output=True,
        timeout=60,
        check=False,
    )
    return "" if found.returncode == 0 else f"Debian's Python lacks one of {NEEDS}"


@dataclass
class Ros:
    """A master with a robot, and a bridge that can be killed and started again."""

    environment: dict[str, str]
    processes: dict[str, subprocess.Popen[str]] = field(default_factory=dict)
    port: int = 0

    def start(self, name: str, *command: str) -> subprocess.Popen[str]:
        self.processes[name] = subprocess.Popen(  # noqa: S603
            command,
            env=self.environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
            start_new_session=True,  # so that a master ends with its children
        )
        return self.processes[name]

    def bridge(self) -> None:
        started = self.start("bridge", PYTHON, str(HERE / "ros_bridge.py"), str(self.port))
        assert started.stdout is not None
        self.port = int(started.stdout.readline())

    def end(self, name: str, how: signal.Signals = signal.SIGKILL) -> None:
        process = self.processes.pop(name)
        os.killpg(process.pid, how)
        process.wait(10)
        if process.stdout is not None:
            process.stdout.close()

    @asynccontextmanager
    async def frozen(self, name: str) -> AsyncIterator[None]:
        self.processes[name].send_signal(signal.SIGSTOP)
        try:
            yield
        finally:
            self.processes[name].send_signal(signal.SIGCONT)


@pytest.fixture(scope="module")
def ros(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Ros]:
    if why := absent():
        pytest.skip(why)
    home = tmp_path_factory.mktemp("ros")
    # Debian's Python has no websockets; it must import nothing else from this environment.
    (home / "packages").mkdir()
    (home / "packages" / "websockets").symlink_to(Path(str(websockets.__file__)).parent)
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        master = free.getsockname()[1]
    running = Ros(
        {
            "PATH": f"/usr/bin:{os.environ['PATH']}",
            "HOME": str(home),
            "ROS_HOME": str(home),
            "ROS_LOG_DIR": str(home / "log"),
            "ROS_MASTER_URI": f"http://127.0.0.1:{master}",
            "ROS_IP": "127.0.0.1",
            "PYTHONPATH": str(home / "packages"),
            "PYTHONUNBUFFERED": "1",
        }
    )
    try:
        running.start("master", "/usr/bin/roscore", "-p", str(master))
        deadline = time.monotonic() + 30
        while True:
            try:
                socket.create_connection(("127.0.0.1", master), timeout=1).close()
                break
            except OSError:
                assert time.monotonic() < deadline, "the master did not come up"
                time.sleep(0.1)
        running.start("robot", PYTHON, str(HERE / "ros_robot.py"))
        running.bridge()
        yield running
    finally:
        for name in ("bridge", "robot"):
            if name in running.processes:
                running.end(name)
        running.end("master", signal.SIGTERM)


@asynccontextmanager
async def linked(ros: Ros) -> AsyncIterator[Rosbridge]:
    bridge = Rosbridge(f"ws://127.0.0.1:{ros.port}")
    await bridge.start()
    assert await bridge.wait_connected(10)
    yield bridge
    await bridge.close()


async def test_the_base_drives_and_stops_by_command_or_timeout(ros: Ros) -> None:
    async with linked(ros) as bridge:
        base = RosBase(bridge)
        await base.start()
        await until(lambda: base.odometry)
        assert base.odometry is not None
        before = base.odometry.value.pose

        def speed() -> float:
            assert base.odometry is not None
            return base.odometry.value.twist.forward

        await base.drive(Twist(0.4, 0.5))
        await until(lambda: speed() > 0.3)
        for _ in range(5):
            await asyncio.sleep(0.1)
            await base.drive(Twist(0.4, 0.5))
        await base.stop()
        await until(lambda: speed() == 0, 0.5)
        after = base.odometry.value.pose
        assert math.dist(before[:2], after[:2]) > 0.1
        assert after.heading != before.heading
        await base.drive(Twist(0.4))
        await until(lambda: speed() > 0.3)
        await until(lambda: speed() == 0, 2)
        assert base.reading().state == OK
        await base.close()


async def test_scans_joints_voice_and_diagnostics_work_over_ros(ros: Ros) -> None:
    async with linked(ros) as bridge:
        told, laser, button = RosDiagnostics(bridge), RosLaser(bridge), RosStopButton(bridge)
        limbs = {"head": Limb("head", ("neck nod", "neck shake"), (-35, -80), (30, 80))}
        arms, voice = RosArms(bridge, limbs, diagnostics=told), RosVoice(bridge)
        devices = (told, laser, button, arms, voice)
        for device in devices:
            await device.start()
        await until(lambda: laser.scan and told.of("arms") and button.reading().state == OK)
        assert laser.scan is not None
        scan = laser.scan.value
        assert (len(scan.ranges), scan.farthest) == (360, 10.0)
        assert [math.isinf(beam) for beam in scan.ranges[:4]] == [True, True, True, False]
        assert not button.latched
        await asyncio.sleep(1)  # topics of ROS 1 begin late: the robot must have found the client
        await arms.pose({"head": (-20, 30)}, 0.2)
        assert arms.positions["head/neck nod"] == pytest.approx(math.radians(-20))
        await voice.say("The next number is B 7")
        bridge.advertise("/test/error", "std_msgs/Bool")
        await asyncio.sleep(0.5)
        bridge.publish("/test/error", {"data": True})
        await until(lambda: arms.reading().state == ERROR)
        with pytest.raises(DeviceError, match="elbow overheated"):
            await arms.pose({"head": (0, 0)}, 0.2)
        bridge.publish("/test/error", {"data": False})
        await until(lambda: arms.reading().state == OK)
        answer = await bridge.call("/robot/get_loggers", {})
        assert answer["loggers"]
        for device in devices:
            await device.close()


async def test_a_frozen_robot_or_bridge_is_noticed_by_age(ros: Ros) -> None:
    async with linked(ros) as bridge:
        base = RosBase(bridge)
        await base.start()
        for what in ("robot", "bridge"):
            await until(lambda: base.odometry and base.reading().age < 0.1)
            async with ros.frozen(what):
                await until(lambda: base.reading().age > STALE_SECONDS, 1)
                assert bridge.connected
                await base.stop()
            await until(lambda: base.reading().age < 0.1)
        await base.close()


async def test_a_killed_bridge_is_reconnected(ros: Ros) -> None:
    async with linked(ros) as bridge:
        base = RosBase(bridge)
        await base.start()
        await until(lambda: base.odometry)
        await base.drive(Twist(0.2))
        ros.end("bridge")
        await until(lambda: not bridge.connected)
        with pytest.raises(DeviceError, match="no link"):
            await base.drive(Twist(0.2))
        await base.stop()
        ros.bridge()
        await until(lambda: bridge.connected and base.reading().age < 0.1)
        assert base.odometry is not None
        await until(lambda: base.odometry and base.odometry.value.twist.forward == 0)
        await base.close()


async def test_move_base_reaches_cancels_and_rejects_goals(ros: Ros) -> None:
    async with linked(ros) as bridge:
        navigator, base = RosNavigator(bridge), RosBase(bridge)
        await navigator.start()
        await base.start()
        await until(lambda: navigator.reading().state == OK and base.odometry)
        assert base.odometry is not None
        here = base.odometry.value.pose
        await navigator.go(Pose(here.x + 1, here.y, 0), 30)
        assert str(navigator.state) == "arrived"
        await until(lambda: base.odometry and base.odometry.value.pose.x > here.x + 0.9)
        assert navigator.pose is not None
        assert navigator.pose.value.x == pytest.approx(here.x + 1, abs=0.15)
        far = asyncio.create_task(navigator.go(Pose(here.x + 1, here.y + 40, 0), 60))
        await until(lambda: base.odometry and base.odometry.value.pose.y > here.y + 0.5)
        await navigator.cancel()
        with pytest.raises(DeviceError):
            await far
        await asyncio.sleep(0.2)
        stood = base.odometry.value.pose
        await asyncio.sleep(0.3)
        assert base.odometry.value.pose[:2] == stood[:2]
        assert navigator.state == "idle"
        with pytest.raises(DeviceError, match="no way: Failed to find a valid plan"):
            await navigator.go(Pose(60, 0, 0), 30)
        assert navigator.reading().facts == {"path": "none"}
        await navigator.close()
        await base.close()


async def test_roslibpy_understands_our_server() -> None:
    if importlib.util.find_spec("roslibpy") is None:
        pytest.skip("roslibpy is not installed")

    async def add(arguments: Mapping[str, Any]) -> dict[str, Any]:
        return {"sum": arguments["a"] + arguments["b"]}

    async def drives(_: Any, feedback: Callable[[Any], None]) -> dict[str, Any]:
        feedback({"left": 1})
        return {"there": True}

    async def publish() -> None:
        while True:
            server.publish("/odom", "nav_msgs/Odometry", {"at": [1.5, math.inf]})
            await asyncio.sleep(0.05)

    server, driven = RosbridgeServer(), list[Any]()
    server.on_message("/cmd_vel", driven.append)
    server.provide("/add", add)
    server.provide_action("/navigate_to_pose", drives)
    await server.start()
    publishing = asyncio.create_task(publish())
    client = await asyncio.create_subprocess_exec(
        sys.executable, str(HERE / "ros_client.py"), str(server.port), stdout=subprocess.PIPE
    )
    said, _ = await asyncio.wait_for(client.communicate(), 60)
    publishing.cancel()
    await server.close()
    assert json.loads(said) == {
        "odometry": {"at": [1.5, None]},
        "sum": 3,
        "refused": "service /none does not exist",
        "feedback": [{"left": 1}],
        "result": {"status": 4, "values": {"there": True}},
    }
    assert driven == [{"linear": {"x": 0.5}, "angular": {"z": 0.1}}]
