"""SCIP 2.0 with other software: MRPT and hokuyolx read Tangy's scanner; its driver over a cable."""

from __future__ import annotations

import asyncio
import os
import shutil
import subprocess
from collections.abc import AsyncIterator
from pathlib import Path

import numpy as np
import pytest

from tangy_hw.drivers.scip import ScipLaser
from tangy_sim.servers.scip_server import ScipServer
from tangy_sim.servers.scip_session import URG, UTM, Scanner
from tests.hw.waiting import until
from tests.support.terminal import PATIENCE

pytestmark = pytest.mark.slow

SEEN = np.linspace(0.1, 6.0, URG.beams)
REACHED = URG.farthest >= SEEN
needs_mrpt = pytest.mark.skipif(
    not (shutil.which("rawlog-grabber") and shutil.which("rawlog-edit")),
    reason="mrpt-apps is not installed: no rawlog-grabber to read the scanner",
)
needs_socat = pytest.mark.skipif(
    shutil.which("socat") is None, reason="socat is not installed: no pair of serial ports"
)

GRABBER = """[global]
rawlog_prefix = {folder}/scan
time_between_launches = 10
use_sensoryframes = 0
GRABBER_PERIOD_MS = 100

[LASER]
driver = CHokuyoURG
process_rate = 200
sensorLabel = LASER
IP_DIR = 127.0.0.1
PORT_DIR = {port}
preview = false
pose_x = 0
"""


def found(folder: Path, end: str) -> list[Path]:
    """Return the files whose names end with this."""
    return sorted(folder.glob("*" + end))


class Turning:
    """A scanner that turns: each scan is the same, but its first beam counts the scans."""

    def __init__(self, scanner: Scanner = URG) -> None:
        self.server = ScipServer(scanner)
        self.turns = 0
        self._task: asyncio.Task[None] | None = None

    async def start(self) -> None:
        await self.server.start()
        self._task = asyncio.create_task(self._turn())

    async def _turn(self) -> None:
        while True:
            self.server.send(self.seen(self.turns), 50 * self.turns)
            self.turns += 1
            await asyncio.sleep(0.05)

    @staticmethod
    def seen(turn: int) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
        """Its scan of one turn."""
        ranges = SEEN.copy()
        ranges[0] = 1 + turn / 1000
        return ranges

    async def close(self) -> None:
        if self._task is not None:
            self._task.cancel()
        await self.server.close()


@pytest.fixture
async def turning() -> AsyncIterator[Turning]:
    made = Turning()
    await made.start()
    yield made
    await made.close()


@needs_mrpt
async def test_mrpt_reads_every_scan_unchanged(turning: Turning, tmp_path: Path) -> None:
    settings = tmp_path / "grabber.ini"
    settings.write_text(GRABBER.format(folder=tmp_path, port=turning.server.port))
    grabber = await asyncio.create_subprocess_exec(
        "rawlog-grabber", str(settings), cwd=tmp_path, stdin=asyncio.subprocess.PIPE,
        stdout=asyncio.subprocess.PIPE, stderr=asyncio.subprocess.STDOUT,
    )  # fmt: skip
    await until(lambda: turning.server.sent >= 15, PATIENCE)
    async with asyncio.timeout(PATIENCE):
        said, _ = await grabber.communicate(b"\x1b")  # Escape ends it
    log = said.decode(errors="replace")
    assert "MODL:URG-04LX" in log, log
    (raw,) = found(tmp_path, ".rawlog")
    export = await asyncio.to_thread(
        subprocess.run,
        ["rawlog-edit", "-i", raw.name, "--export-2d-scans-txt"],
        cwd=tmp_path, capture_output=True, text=True, timeout=PATIENCE, check=False,
    )  # fmt: skip
    assert export.returncode == 0, export.stdout + export.stderr
    (text,) = found(tmp_path, "_LASER.txt")
    rows = np.loadtxt(text, comments="%", ndmin=2)
    assert len(rows) >= 10
    ranges, valid = rows[:, 1 : 1 + URG.beams], rows[:, 1 + URG.beams :]
    first = np.rint((ranges[0, 0] - 1) * 1000)
    for turn, (row, sound) in enumerate(zip(ranges, valid, strict=True)):
        wanted = Turning.seen(int(first) + turn)
        assert (sound.astype(bool) == REACHED).all()
        assert np.abs(row - wanted)[REACHED].max() < 0.0011  # it writes millimetres


async def test_hokuyolx_reads_single_and_continuous_scans(turning: Turning) -> None:
    hokuyolx = pytest.importorskip("hokuyolx", reason="hokuyolx is not installed")

    def use() -> None:
        # One read takes a whole reply: the client would not separate two that came together.
        scanner = hokuyolx.HokuyoLX(
            addr=("127.0.0.1", turning.server.port), tsync=False, convert_time=False, buf=1 << 16
        )
        assert (scanner.model, scanner.dmin, scanner.dmax) == ("URG-04LX", 20, 5600)
        assert (scanner.ares, scanner.amin, scanner.amax, scanner.aforw) == (540, 0, 359, 180)
        assert scanner.scan_freq == 10
        assert scanner.laser_state()[0] == 3
        stamp, distances = scanner.get_dist()
        assert np.abs(distances / 1000 - Turning.seen(stamp // 50))[REACHED].max() <= 0.0005
        assert not distances[~REACHED].any()
        assert np.abs(scanner.get_angles()[[0, -1]] - URG.first - [0, 359 * URG.step]).max() < 1e-9
        for distances, stamp, _ in scanner.iter_dist(3, start=100, end=199, grouping=2):
            wanted = Turning.seen(stamp // 50)[100:200].reshape(-1, 2).min(axis=1)
            assert np.abs(distances / 1000 - wanted).max() <= 0.0005
        scanner.standby()
        scanner.tsync_enter()
        assert 0 <= scanner.tsync_get() <= 50 * turning.turns
        scanner.tsync_exit()
        scanner.close()

    async with asyncio.timeout(PATIENCE):
        await asyncio.to_thread(use)


@needs_socat
@pytest.mark.parametrize("scanner", [URG, UTM])
async def test_the_driver_survives_a_pulled_serial_cable(scanner: Scanner, tmp_path: Path) -> None:
    pytest.importorskip("serial", reason="pyserial is not installed")
    ends = [tmp_path / "scanner", tmp_path / "robot"]
    server = ScipServer(scanner)
    ranges = np.linspace(0.2, 5.0, scanner.beams)
    laser = ScipLaser(str(ends[1]))
    for plugged in range(2):
        cable = await asyncio.create_subprocess_exec(
            "socat", *(f"pty,raw,echo=0,link={end}" for end in ends)
        )
        async with asyncio.timeout(PATIENCE):
            await until(lambda: all(end.exists() for end in ends))
            server.serve_serial(str(ends[0]))
            await laser.start()
            for turn in range(20):
                await server.somebody()
                server.send(ranges + turn / 1000, round(1000 * turn / scanner.rate))
                scan = await laser.after(20 * plugged + turn)
                assert np.abs(scan.value.ranges - ranges - turn / 1000).max() <= 0.00051
        assert laser.reading().state == "OK"
        assert (laser.connected, laser.spoilt, laser.missed) == (plugged + 1, 0, 0)
        cable.terminate()
        async with asyncio.timeout(PATIENCE):
            await cable.wait()
        await until(lambda: laser.reading().state == "STALE" and not server.measuring)
    await laser.close()
    await server.close()


async def test_the_driver_takes_over_a_measuring_scanner() -> None:
    pytest.importorskip("serial", reason="pyserial is not installed")
    server = ScipServer(URG)
    path = server.serve_serial()
    # The earlier client was killed in the middle of a command, while scans kept coming.
    before = os.open(path, os.O_RDWR | os.O_NOCTTY)
    os.write(before, b"BM\nMD0000035901000\nVV;half a comm")
    async with asyncio.timeout(PATIENCE):
        await server.somebody()
    for turn in range(3):
        server.send(SEEN * 0.5, 100 * turn)
    laser = ScipLaser(path)
    await laser.start()
    await until(lambda: bool(laser.about) and server.measuring == 1)
    async with asyncio.timeout(PATIENCE):
        while laser.scan is None:
            server.send(SEEN, 1000)
            await asyncio.sleep(0.01)
    assert (np.isfinite(laser.scan.value.ranges) == REACHED).all()
    assert np.abs(laser.scan.value.ranges - SEEN)[REACHED].max() <= 0.0005
    assert laser.connected == 1
    os.close(before)
    await laser.close()
    await server.close()


async def test_the_driver_reads_over_a_pseudo_terminal() -> None:
    pytest.importorskip("serial", reason="pyserial is not installed")
    server = ScipServer(URG)
    laser = ScipLaser(server.serve_serial())
    await laser.start()
    async with asyncio.timeout(PATIENCE):
        await server.somebody()
        server.send(SEEN, 0)
        scan = await laser.after(0)
    assert (np.isfinite(scan.value.ranges) == REACHED).all()
    await laser.close()
    await server.close()
