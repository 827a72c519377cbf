"""`tangy doctor --robot` tests the devices of a robot; a frozen device is noticed by its age."""

from __future__ import annotations

import asyncio
import json
import os
import shutil
import signal
import sys
from pathlib import Path

import numpy as np
import pytest

from tangy_hw.drivers.scip import ScipLaser
from tangy_profiles.robot import load_robot
from tangy_sim.servers.mjpeg_server import MjpegServer
from tangy_sim.servers.scip_server import ScipServer
from tests.hw.pictures import encoded, room, seen
from tests.hw.waiting import until
from tests.support.terminal import PATIENCE, TANGY

pytestmark = pytest.mark.slow

SCANNER = """
import asyncio, numpy
from tangy_sim.servers.scip_server import ScipServer

async def turn():
    server = ScipServer()
    await server.start()
    print(server.url, flush=True)
    for number in range(100_000):
        server.send(numpy.full(server.scanner.beams, 1 + number % 7 / 100), 50 * number)
        await asyncio.sleep(0.05)

asyncio.run(turn())
"""


async def work(scanner: ScipServer, cameras: MjpegServer) -> None:
    """Let a scanner measure and a camera film."""
    rng = np.random.default_rng(1)
    pictures = [encoded(seen(room(1, 320, 240), rng, noise=2)).tobytes() for _ in range(10)]
    for turn in range(100_000):
        scanner.send(rng.uniform(1, 2, scanner.scanner.beams), 50 * turn)
        cameras.push("/head", pictures[turn % len(pictures)])
        await asyncio.sleep(0.05)


@pytest.mark.skipif(
    shutil.which("espeak-ng") is None, reason="espeak-ng is not installed: no voice"
)
async def test_doctor_tests_the_devices_of_a_profile(tmp_path: Path) -> None:
    scanner, cameras = ScipServer(), MjpegServer()
    await scanner.start()
    await cameras.start()
    shipped = load_robot().file.read_text(encoding="utf-8")
    looks = 'looks_at = "cards"\n'
    assert shipped.count("\n" + looks) == 1
    head = f'\n{looks}source = "{cameras.url("/head")}"\n'
    robot = tmp_path / "mine.toml"
    drivers = f"""
[drivers]
laser = {{ kind = "scip", at = "{scanner.url}" }}
base = {{ kind = "rosbridge", at = "ws://127.0.0.1:9" }}
voice = {{ kind = "spoken", sink = "null" }}
screen = {{ kind = "page", port = 0 }}
"""
    robot.write_text(shipped.replace("\n" + looks, head) + drivers, encoding="utf-8")
    working = asyncio.create_task(work(scanner, cameras))
    doctor = await asyncio.create_subprocess_exec(
        TANGY, "doctor", "--robot", str(robot), "--data", str(tmp_path / "data"), "--json",
        stdout=asyncio.subprocess.PIPE, stderr=asyncio.subprocess.PIPE,
    )  # fmt: skip
    async with asyncio.timeout(2 * PATIENCE):
        said, problem = await doctor.communicate()
    assert doctor.returncode == 1, problem  # its wheels do not answer
    found = {one["part"]: one for one in json.loads(said)}
    for part in ("laser scanner", "head camera", "voice"):
        assert found[f"Tangy's {part}"]["state"] == "ok", found
    assert "nobody answers at ws://127.0.0.1:9" in found["Tangy's wheels"]["text"]
    assert "no tablet has opened http://127.0.0.1:" in found["Tangy's chest screen"]["text"]
    assert "the code that pairs it is " in found["Tangy's chest screen"]["text"]
    assert found["Tangy's chest screen"]["state"] == "missing"  # nobody looks at it yet
    assert found["Tangy's arms"]["state"] == "missing"
    working.cancel()
    await scanner.close()
    await cameras.close()


async def test_a_frozen_scanner_is_stale_despite_its_connection() -> None:
    process = await asyncio.create_subprocess_exec(
        sys.executable, "-c", SCANNER, stdout=asyncio.subprocess.PIPE
    )
    assert process.stdout is not None
    laser = ScipLaser((await process.stdout.readline()).decode().strip())
    try:
        await laser.start()
        await until(lambda: laser.reading().state == "OK", PATIENCE)
        assert laser.connected == 1
        os.kill(process.pid, signal.SIGSTOP)
        await until(lambda: laser.reading().state == "STALE", PATIENCE)
        reading = laser.reading()
        assert 0.25 < reading.age < 2 and laser.why == ""  # it reports no lost connection
        os.kill(process.pid, signal.SIGCONT)
        await until(lambda: laser.reading().state == "OK", PATIENCE)
    finally:
        process.kill()
        await process.wait()
        await laser.close()
