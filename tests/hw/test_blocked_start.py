"""A driver that blocks while the robot is switched on is named, and can be left out."""

from __future__ import annotations

import sys
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from typing import Any, cast

import pytest

from tangy_hw.cancellation import Cancellation, Cancelled
from tangy_hw.device_protocols import DeviceFailed
from tangy_hw.drivers import registry
from tangy_hw.drivers.registry import DriverKind
from tangy_hw.robot_client import client, starting
from tangy_hw.robot_client.client import RobotLink
from tangy_hw.robot_process.assembly import assemble
from tangy_hw.robot_process.driver_checks import START_SECONDS
from tangy_hw.robot_setup import RobotSetup
from tangy_profiles.known_devices import can_be_left_out, left_out
from tangy_profiles.robot import load_robot
from tests.hw.live_bodies import ToldBase, ToldDevice, ToldLaser
from tests.support.waiting import wait_until

GRIPPER = """
[[devices]]
name = "gripper"
label = "gripper"
stale_after = 5
"""
SECONDS = 1.5
ROBOT = Path(__file__).with_name("blocking_robot.py")


def robot_file(folder: Path) -> Path:
    path = folder / "mine.toml"
    shipped = load_robot().file.read_text(encoding="utf-8")
    kinds = "".join(f'{name} = {{ kind = "told" }}\n' for name in ("base", "laser", "gripper"))
    path.write_text(f"{shipped}\n[drivers]\n{kinds}{GRIPPER}", encoding="utf-8")
    return path


@pytest.fixture
def setup(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> RobotSetup:
    monkeypatch.setenv("PYTHONPATH", str(Path(__file__).parents[2]))
    return RobotSetup(str(robot_file(tmp_path)), "bingo", ("user_1",))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("step", "did"), [("open", "started"), ("start", "started"), ("read", "answered")]
)
def test_a_driver_that_blocks_is_named_and_the_robot_starts_without_it(
    step: str, did: str, setup: RobotSetup, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(client, "CHILD", (sys.executable, str(ROBOT), step))
    monkeypatch.setattr(starting, "DEVICE_SECONDS", SECONDS)
    link = RobotLink(setup)
    with pytest.raises(DeviceFailed) as failed:
        link.start()
    assert failed.value.device == "gripper"
    assert str(failed.value) == f"gripper: its driver has not {did} within {SECONDS:g} s."
    assert link.pid is None  # nothing is left that could drive
    assert not (tmp_path / "told.txt").exists()

    monkeypatch.setattr(starting, "DEVICE_SECONDS", 60.0)
    link = RobotLink(replace(setup, without=("gripper",)))
    try:
        link.start()
        assert link.pid is not None
        assert "gripper" not in [reading.device for reading in link.beat().health]
    finally:
        link.close()


async def test_a_device_is_named_before_each_call_of_its_driver_and_none_afterwards(
    setup: RobotSetup, monkeypatch: pytest.MonkeyPatch
) -> None:
    made = {"base": ToldBase, "laser": ToldLaser}
    kind = DriverKind(
        ("base", "laser", "gripper"),
        lambda _, settings: made.get(settings.device, ToldDevice)(settings.device, []),
    )
    monkeypatch.setattr(registry, "DRIVERS", {"told": kind})
    told: list[tuple[str, str]] = []

    def calls(device: str, did: str = "started") -> None:
        told.append((device, did))

    left = {"arms": {"kind": "told"}}  # as the bench's drivers and requests
    off = replace(setup, without=("arms", "requests"), drivers=left, requests="none such")
    runtime = assemble(off, calls)
    runtime.calls = calls
    async with runtime:
        pass
    devices = ("base", "laser", "gripper")
    opened, read = told[: len(devices) + 1], told[len(devices) + 1 :]
    assert opened == [(name, "started") for name in (*devices, "")]
    assert {device for device, did in read if did == "answered"} == set(devices)
    assert read[-1] == ("", "started")


class Clock:
    """A clock that a test sets, and a process that never answers meanwhile."""

    now = 0.0

    def monotonic(self) -> float:
        return self.now

    def result(self, timeout: float) -> dict[str, Any]:
        self.now += timeout
        raise TimeoutError


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    clock = Clock()
    monkeypatch.setattr(starting, "time", clock)
    return clock


@pytest.mark.parametrize(
    ("messages", "seconds", "told"),
    [
        ([], starting.PART_SECONDS, "The robot process does not begin."),
        ([{"starts": "program"}], starting.PART_SECONDS, "The robot process does not begin."),
        ([{"starts": "senses"}], starting.PART_SECONDS, "The robot process does not begin."),
        ([{"starts": "laser"}], starting.DEVICE_SECONDS, "laser: its driver has not started"),
        (
            [{"starts": "program"}, {"calls": "arms"}],
            starting.DEVICE_SECONDS,
            "arms: its driver has not started",
        ),
        (
            [{"starts": "first words"}, {"calls": "arms", "did": "answered"}],
            starting.DEVICE_SECONDS,
            "arms: its driver has not answered",
        ),
        (
            [{"calls": "arms", "did": "answered"}, {"calls": ""}, {"starts": "laser"}],
            starting.DEVICE_SECONDS,
            "laser: its driver has not started",
        ),
        (
            [{"starts": "first words"}, {"calls": "arms", "did": "answered"}, {"calls": ""}],
            starting.PART_SECONDS,
            "The robot process does not begin.",
        ),
    ],
)
def test_each_part_of_a_start_has_its_time_and_the_error_names_a_device(
    messages: list[dict[str, str]], seconds: float, told: str, clock: Clock
) -> None:
    start = starting.StartUp()
    for message in messages:
        clock.now += 0.9 * starting.DEVICE_SECONDS  # each part has its own time
        start.hear(message)
    began = clock.now
    with pytest.raises(TimeoutError):
        start.wait(cast("Future[dict[str, Any]]", clock))
    assert clock.now - began == pytest.approx(seconds, abs=0.3)
    assert str(start.blocked()).startswith(told)


def test_the_robot_process_itself_tells_first_of_a_driver_that_only_waits() -> None:
    assert START_SECONDS + 1.0 < starting.DEVICE_SECONDS < starting.PART_SECONDS


def test_a_robot_can_do_without_its_arms_but_not_without_what_it_drives_by() -> None:
    robot = load_robot()
    assert can_be_left_out(robot, "arms") and can_be_left_out(robot, "voice")
    for needed in ("base", "laser", "stop_button", "wings"):
        assert not can_be_left_out(robot, needed)
    without = left_out(robot, "arms")
    assert "arms" not in without.devices
    assert [device.name for device in without.undriven] == ["arms"]


def test_a_device_that_is_left_out_has_no_driver_and_does_not_hide_another(tmp_path: Path) -> None:
    robot = load_robot(str(robot_file(tmp_path)))
    without = left_out(left_out(robot, "arms"), "gripper")
    assert {*without.drivers} == {"base", "laser"}
    assert [device.name for device in without.undriven] == ["arms", "gripper"]


@pytest.mark.slow
def test_staff_leave_a_robot_off_while_a_driver_blocks(
    setup: RobotSetup, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(client, "CHILD", (sys.executable, str(ROBOT), "start"))
    cancellation = Cancellation()
    link = RobotLink(setup, cancellation=cancellation)
    with ThreadPoolExecutor(1) as thread:
        starting_it = thread.submit(link.start)
        wait_until(lambda: "gripper" in cancellation.parts, "the gripper is being started")
        cancellation.cancel()
        with pytest.raises(Cancelled):
            starting_it.result()
    link.close()
    assert link.pid is None
    assert not (tmp_path / "told.txt").exists()
