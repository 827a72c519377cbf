"""A trial of a robot reports for each device whether it works, or what is missing."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest

from tangy_hw.drivers import registry
from tangy_hw.drivers.registry import DriverKind
from tangy_hw.robot_process.self_test import SelfTestResult, try_robot
from tangy_profiles.activity import load_activity
from tangy_profiles.health import NEVER, OK, Reading
from tangy_profiles.robot import Robot, load_robot
from tangy_sim.servers.scip_server import ScipServer

SECONDS = 0.4


def driven(folder: Path, **drivers: str) -> Robot:
    """Return the shipped robot with other drivers."""
    path = folder / "mine.toml"
    lines = [f"{name} = {{ {settings} }}" for name, settings in drivers.items()]
    shipped = load_robot().file.read_text(encoding="utf-8")
    path.write_text(f"{shipped}\n[drivers]\n" + "\n".join(lines), encoding="utf-8")
    return load_robot(str(path))


async def tried(robot: Robot, seconds: float = SECONDS) -> dict[str, SelfTestResult]:
    """Return the result for each device."""
    found = await try_robot(robot, load_activity("bingo"), {}, seconds)
    assert len({one.device for one in found}) == len(found)
    return {one.device: one for one in found}


@contextmanager
def turning(server: ScipServer) -> Iterator[None]:
    """Let a scanner measure."""

    async def turn() -> None:
        for number in range(1000):
            server.send(np.linspace(1, 2, server.scanner.beams), 100 * number)
            await asyncio.sleep(0.02)

    task = asyncio.create_task(turn())
    yield
    task.cancel()


class Cell:
    """A battery of another package; `start` and `reading` raise what they are told to."""

    def __init__(self, name: str, reading: Reading | Exception, start: Exception | None) -> None:
        self.name, self._reading, self._start = name, reading, start

    async def start(self) -> None:
        if self._start is not None:
            raise self._start

    async def close(self) -> None:
        pass

    def reading(self) -> Reading:
        if isinstance(self._reading, Exception):
            raise self._reading
        return self._reading


@pytest.mark.parametrize(
    ("reading", "start", "says"),
    [
        (Reading("battery", 0.0, OK, {"charge": 0.5, "charging": True}), None, ""),
        (Reading("battery", 0.0, OK, {"charging": True}), None, "charge"),
        (Reading("battery", NEVER), None, "nothing"),
        (KeyError("volts"), None, "KeyError: 'volts'"),
        (Reading("battery"), OSError("no such file"), "OSError: no such file"),
    ],
    ids=["works", "lacks a fact", "no data", "reading fails", "start fails"],
)
async def test_a_driver_of_another_package_that_fails_is_told(
    reading: Reading | Exception,
    start: Exception | None,
    says: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    cell = DriverKind(("battery",), lambda *_: Cell("battery", reading, start))
    monkeypatch.setattr(registry, "DRIVERS", {"cell": cell})
    path = tmp_path / "mine.toml"
    shipped = load_robot("turtlebot4").file.read_text(encoding="utf-8")
    before, _, after = shipped.partition("[drivers]\n")
    others = after[after.index("\n[[devices]]") :]
    path.write_text(f'{before}[drivers]\nbattery = {{ kind = "cell" }}\n{others}')
    found = (await tried(load_robot(str(path)), 0.05))["battery"]
    assert found.ok is (says == "")
    assert says in found.text


async def test_each_device_gets_one_sentence(tmp_path: Path) -> None:
    server = ScipServer()
    await server.start()
    robot = driven(
        tmp_path,
        base='kind = "rosbridge", at = "ws://127.0.0.1:9"',
        laser=f'kind = "scip", at = "{server.url}"',
        arms='kind = "rosbrige", at = "ws://127.0.0.1:9"',
    )
    with turning(server):
        found = await tried(robot)
    assert found["laser"] == SelfTestResult("laser", True, f"scip at {server.url} works.")
    assert found["base"] == SelfTestResult("base", False, "nobody answers at ws://127.0.0.1:9.")
    assert "did you mean 'rosbridge'?" in found["arms"].text
    assert found["stop_button"].absent
    assert "[drivers] in mine.toml" in found["stop_button"].text
    assert list(found)[:2] == ["stop_button", "laser"]  # in the profile's order
    await asyncio.sleep(0)
    assert not server.measuring  # opened devices are closed
    await server.close()


@pytest.mark.parametrize(
    ("fault", "says"),
    [("70", "cannot measure"), ("", "nothing any more"), ("closed", "broke off")],
    ids=["broken", "silent", "closed"],
)
async def test_a_scanner_that_does_not_measure_gives_its_reason(
    tmp_path: Path, fault: str, says: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tangy_hw.drivers.scip.ANSWER_SECONDS", 0.05)
    monkeypatch.setattr("tangy_hw.drivers.scip.SILENT_SECONDS", 0.1)
    server = ScipServer()
    await server.start()
    if fault == "closed":
        server.closed = True
    else:
        server.fault = fault
    found = await tried(driven(tmp_path, laser=f'kind = "scip", at = "{server.url}"'))
    assert not found["laser"].ok and not found["laser"].absent
    assert says in found["laser"].text and server.url in found["laser"].text
    await server.close()


async def test_a_robot_without_drivers_lacks_every_device() -> None:
    found = await tried(load_robot())
    assert {"base", "laser", "arms", "voice", "stop_button"} <= set(found)
    assert all(one.absent and not one.ok for one in found.values())
    assert "name its source in tangy.toml" in found["camera"].text
