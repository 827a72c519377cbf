"""A trial of a robot reports for each device whether it works, or what is missing."""

from __future__ import annotations

import asyncio
import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tangy_hw.device_protocols import MachineClock, Odometry, Pose, Scan, Stamped, Twist
from tangy_hw.drivers import registry
from tangy_hw.drivers.registry import DriverKind
from tangy_hw.drivers.rosbridge import Rosbridge
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
        (Reading("battery", 0.0, OK, {"charge": 80, "charging": True}), None, "from 0 to 1"),
        (Reading("battery", NEVER), None, "nothing"),
        (KeyError("volts"), None, "KeyError: 'volts'"),
        (Reading("battery"), OSError("no such file"), "OSError: no such file"),
    ],
    ids=["works", "lacks a fact", "percent", "no data", "reading fails", "start fails"],
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
    assert found["laser"].ok and found["laser"].text.startswith(f"scip at {server.url} works: ")
    assert (
        "beams over" in found["laser"].text
        and "the nearest thing 1.00 m away" in found["laser"].text
    )
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


class Wheels(Cell):
    """A base or a scanner of another package."""

    def __init__(self, name: str, value: object) -> None:
        super().__init__(name, Reading(name), None)
        self.odometry = self.scan = value

    async def drive(self, twist: Twist) -> None: ...

    async def stop(self) -> None: ...


def now() -> float:
    return MachineClock().now()


def scan(ranges: Sequence[float], step: float = 0.01, stamp: float | None = None) -> Stamped[Scan]:
    stamp = now() if stamp is None else stamp
    return Stamped(Scan(-1.0, step, np.array(ranges, float), 12.0), stamp, 1)


def changed(data: Stamped[Any], **changes: Any) -> Stamped[Any]:
    """Return data with changed members; those of a scan or an odometry itself count as well."""
    own = {name: value for name, value in changes.items() if hasattr(data, name)}
    inner = {name: value for name, value in changes.items() if name not in own}
    value = data.value
    value = value._replace(**inner) if isinstance(value, Odometry) else replace(value, **inner)
    return replace(data, value=value, **own)


def moved(x: float, forward: float = 0.0) -> Stamped[Odometry]:
    return Stamped(Odometry(Pose(x, 0.0, 0.0), Twist(forward)), now(), 1)


ROUND = [2.0] * 100


@pytest.mark.parametrize(
    ("device", "value", "says"),
    [
        ("laser", scan([1.0, *ROUND]), "works: 101 beams over 57°, the nearest thing 1.00 m away"),
        ("laser", scan([math.inf] * 100), "none of them meets anything"),
        ("laser", scan([math.nan, *ROUND]), "1 of 101 ranges are NaN"),
        ("laser", scan([math.nan] * 40), "sends wrong data: none of its 40 distances can be used"),
        ("laser", scan([-1.0, *ROUND]), "negative"),
        ("laser", scan([1.0, 2.0]), "too few"),
        ("laser", scan([1500.0] * 100), "in m"),
        ("laser", scan(ROUND, step=0.5), "in rad"),
        ("laser", scan(ROUND, stamp=now() + 1e9), "wiring.clock.now()"),
        ("laser", scan(ROUND, stamp=now() - 1e4), "wiring.clock.now()"),
        ("laser", changed(scan([800.0] * 100), farthest=12000.0), "farthest is above 500"),
        ("laser", changed(scan(ROUND), measured=math.nan), "must be numbers"),
        ("laser", scan([*ROUND, *[0.0] * 50]), "50 of 150 ranges are 0: a beam without a return"),
        ("laser", scan([0.0, 1.0, *ROUND]), "the nearest thing 1.00 m away"),
        ("laser", None, "says that it works, but it has sent no scan."),
        ("laser", [1, 2, 3], "no Stamped(Scan"),
        ("base", moved(1.0), "works: odometry 1.00, 0.00 m, 0°"),
        ("base", moved(math.nan), "NaN"),
        ("base", moved(0.0, 300.0), "in m/s"),
        ("base", (0, 0, 0), "no Stamped(Odometry"),
        ("base", changed(moved(0.0), measured=math.inf), "infinite"),
        ("base", changed(moved(0.0), pose=(0.0, 0.0, 0.0)), "no Odometry(Pose("),
        ("base", changed(moved(0.0), twist=()), "no Odometry(Pose("),
        ("base", None, "says that it works, but it has sent no odometry."),
    ],
)
async def test_data_that_make_no_sense_are_told_and_others_shown(
    device: str, value: object, says: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    mine = DriverKind((device,), lambda *_: Wheels(device, value))
    monkeypatch.setattr(registry, "DRIVERS", {"mine": mine})
    found = (await tried(driven(tmp_path, **{device: 'kind = "mine"'}), 0.05))[device]
    assert says in found.text
    assert found.ok is ("works:" in found.text)


@pytest.mark.parametrize("how", ["opens", "start"])
async def test_a_driver_that_raises_or_hangs_does_not_hide_the_others(
    how: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tangy_hw.robot_process.self_test.START_SECONDS", 0.02)

    class Hangs(Wheels):
        async def start(self) -> None:
            await asyncio.Event().wait()

    def opens(*_: object) -> Wheels:
        if how == "opens":
            raise ValueError("no such port")
        return Hangs("base", moved(0.0))

    good = DriverKind(("laser",), lambda *_: Wheels("laser", scan(ROUND)))
    kinds = {"mine": DriverKind(("base",), opens), "good": good}
    monkeypatch.setattr(registry, "DRIVERS", kinds)
    found = await tried(driven(tmp_path, base='kind = "mine"', laser='kind = "good"'), 0.05)
    says = "ValueError: no such port." if how == "opens" else "has not started within"
    assert says in found["base"].text and not found["base"].ok
    assert found["laser"].ok


async def test_a_robot_with_a_laser_scanner_needs_a_base(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    good = DriverKind(("laser",), lambda *_: Wheels("laser", scan(ROUND)))
    monkeypatch.setattr(registry, "DRIVERS", {**registry.DRIVERS, "good": good})
    found = await tried(driven(tmp_path, laser='kind = "good"'), 0.05)
    assert not found["base"].absent and "cannot drive without one" in found["base"].text
    assert found["stop_button"].absent


@pytest.mark.parametrize("raises", [False, True])
async def test_a_shared_connection_that_hangs_is_told_of_each_of_its_devices(
    raises: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tangy_hw.robot_process.self_test.START_SECONDS", 0.02)

    async def start(_: object) -> None:
        if raises:
            raise OSError("no such network")
        await asyncio.Event().wait()

    monkeypatch.setattr(Rosbridge, "start", start)
    good = DriverKind(("laser",), lambda *_: Wheels("laser", scan(ROUND)))
    monkeypatch.setattr(registry, "DRIVERS", {**registry.DRIVERS, "good": good})
    shared = 'kind = "rosbridge", at = "ws://127.0.0.1:9"'
    robot = driven(tmp_path, base=shared, stop_button=shared, laser='kind = "good"')
    found = await tried(robot, 0.05)
    assert "" not in found and found["laser"].ok
    says = "OSError: no such network." if raises else "has not started within"
    for name in ("base", "stop_button"):
        assert says in found[name].text and not found[name].ok
