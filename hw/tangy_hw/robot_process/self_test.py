"""Tests a robot's devices: opens each driver and checks its data, without moving anything."""

from __future__ import annotations

import asyncio
import math
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, cast

import numpy as np

from tangy_hw.device_protocols import (
    PROTOCOLS,
    Base,
    Device,
    DeviceError,
    Laser,
    MachineClock,
    fails,
    hangs,
)
from tangy_hw.drivers.camera import Camera
from tangy_hw.drivers.registry import Wiring, known_drivers, open_device
from tangy_hw.navigation.limits import laser_of, reach_of
from tangy_hw.navigation.poses import up_to
from tangy_hw.perception.camera_hub import Sources
from tangy_hw.perception.requests.help_request_source import DEVICE as REQUESTS
from tangy_hw.perception.requests.source_names import requests_named
from tangy_hw.robot_process.driver_checks import (
    START_SECONDS,
    odometry_problem,
    scan_problem,
)
from tangy_profiles.activity import Activity
from tangy_profiles.errors import TangyError
from tangy_profiles.health import ERROR, NEVER, OK, WARN, Reading
from tangy_profiles.robot import Robot
from tangy_profiles.room import load_room

CLOSE_SECONDS = 5.0
SECONDS = 5.0  # for a working device to send data: cameras take longest
TICK_SECONDS = 0.05
STARTS, READS, CLOSES = "start", "read", "close"  # steps of a driver
Calls = Callable[[str, str], object]
NEEDED = ("base", "laser")
SEATED = ("1", "2", "3", "4")  # the people do not matter here


@dataclass(frozen=True, slots=True)
class SelfTestResult:
    """Result for one device: whether it works, and a sentence.

    `absent`: something is missing rather than broken: a driver, or a tablet for the screen.
    """

    device: str
    ok: bool
    text: str
    absent: bool = False


async def try_robot(
    robot: Robot,
    activity: Activity,
    cameras: Sources,
    seconds: float = SECONDS,
    *,
    pairing: Mapping[str, str] = MappingProxyType({}),
    failed: Mapping[str, str] = MappingProxyType({}),
    calls: Calls = lambda device, step: None,
) -> list[SelfTestResult]:
    """Open every driver and camera of a robot's profile, and check their data.

    Args:
        robot: the robot's profile.
        activity: the activity that it is for.
        cameras: sources of its cameras, by device.
        seconds: timeout for a device.
        pairing: secrets of paired tablets, as in `RobotSetup`.
        failed: devices that are not tried, and why.
        calls: called with a device and a step before its driver is called.

    Returns:
        The results, in the order of the profile.
    """
    wiring = Wiring(robot, activity, MachineClock(), pairing=pairing)
    found = {name: SelfTestResult(name, False, why) for name, why in failed.items()}
    opened: dict[str, Device | Camera] = {
        name: Camera(source, device=name) for name, source in cameras.items() if name not in found
    }
    for name, driver in robot.drivers.items():
        if name == REQUESTS or name in found:
            continue  # requests have no driver: tested below
        calls(name, STARTS)
        try:
            opened[name] = open_device(wiring, name, {"kind": driver.kind, **driver.settings})
        except DeviceError as error:
            found[name] = SelfTestResult(name, False, str(error))
    started: list[tuple[str, Any]] = []
    try:
        for names, one in _parts(robot, opened, wiring):
            if all(name in found for name in names):
                continue  # its connection has failed
            calls(names[0], STARTS)
            started.append((names[0], one))
            if why := await _start(one):
                found |= {name: SelfTestResult(name, False, why) for name in names}
        tested = {name: one for name, one in opened.items() if name not in found}
        until = time.monotonic() + seconds
        while time.monotonic() < until:
            if all(_works(name, one, calls) for name, one in tested.items()):
                break
            await asyncio.sleep(TICK_SECONDS)
        for name, one in tested.items():
            calls(name, READS)
            try:
                found[name] = _tried(robot, name, one, wiring, seconds)
            except Exception as error:
                found[name] = SelfTestResult(name, False, fails(error))
    finally:
        for name, one in reversed(started):
            calls(name, CLOSES)
            with suppress(Exception):  # the others must be closed as well
                async with asyncio.timeout(CLOSE_SECONDS):
                    await one.close()
    if REQUESTS in robot.devices and REQUESTS not in found:
        calls(REQUESTS, READS)
        found[REQUESTS] = await _try_requests(robot, seconds)
    for name, device in robot.devices.items():
        if device.looks_at and name not in found:
            what = "nothing says where its pictures come from; name its source in"
            found[name] = SelfTestResult(name, False, f"{what} {robot.file.name}.", absent=True)
    driven = {device for driver in known_drivers().values() for device in driver.devices}
    for name in driven - {"navigator"}:  # Tangy's own navigator replaces a missing one
        if name in robot.devices and name not in found:
            needed = name in NEEDED and bool(robot.drivers)
            without = ", and Tangy cannot drive without one" if needed else ""
            what = f"it has no driver{without}: name one under [drivers] in {robot.file.name}."
            found[name] = SelfTestResult(name, False, what, absent=not needed)
    return [found[name] for name in (*robot.devices, *(set(found) - set(robot.devices)))
            if name in found]  # fmt: skip


def _parts(
    robot: Robot, opened: Mapping[str, Device | Camera], wiring: Wiring
) -> Iterator[tuple[tuple[str, ...], Any]]:
    """Yield what is to be started, in order, with the devices that depend on it."""
    for links in (wiring.links, wiring.diagnosing):
        for at, link in links.items():
            users = (name for name in opened if name in robot.drivers)
            yield tuple(n for n in users if robot.drivers[n].settings.get("at") == at), link
    for name, device in opened.items():
        yield (name,), device


async def _start(part: Any) -> str:
    """Start a device or a connection; return why it fails, "" if it does not."""
    try:
        async with asyncio.timeout(START_SECONDS) as limit:
            await part.start()
    except Exception as error:
        return hangs(START_SECONDS) if limit.expired() else fails(error)
    return ""


async def _try_requests(robot: Robot, seconds: float) -> SelfTestResult:
    """Open the source of requests, and check that it works."""
    from tangy_hw.perception.requests.sources import open_requests

    try:
        name, corners = requests_named(robot)
        if not name:
            what = "nothing tells who asks; name a source under [drivers] in"
            return SelfTestResult(REQUESTS, False, f"{what} {robot.file.name}.", absent=True)
        opened = open_requests(name, load_room(), SEATED, corners=corners)
    except TangyError as error:
        return SelfTestResult(REQUESTS, False, str(error))
    async with opened:
        until = time.monotonic() + seconds
        while time.monotonic() < until:
            if opened.reading().state == OK:
                break
            await asyncio.sleep(TICK_SECONDS)
        works = opened.reading().state == OK
    text = f"{name} works." if works else f"{name} cannot be reached, or tells nothing."
    return SelfTestResult(REQUESTS, works, text)


def _works(name: str, device: Device | Camera, calls: Calls) -> bool:
    """Return whether a device works; one that fails need not be waited for."""
    calls(name, READS)
    try:
        reading = device.reading()
        return reading.state == OK and reading.age < NEVER and not _unsent(name, device)
    except Exception:  # its result names the error
        return True


def _unsent(name: str, device: Device | Camera) -> str:
    """Return what a base or a scanner should have sent, and has not; "" for others."""
    if name == "laser" and cast(Laser, device).scan is None:
        return "scan"
    return "odometry" if name == "base" and cast(Base, device).odometry is None else ""


def _tried(
    robot: Robot, name: str, device: Device | Camera, wiring: Wiring, seconds: float
) -> SelfTestResult:
    where = _where(robot, name, device)
    reading = device.reading()
    if reading.state == OK and reading.age < NEVER:
        if unsent := _unsent(name, device):
            text = f"{where} says that it works, but it has sent no {unsent}."
            return SelfTestResult(name, False, text)
        if problem := _data_problem(robot, name, device, reading):
            return SelfTestResult(name, False, f"{where} sends wrong data: {problem}")
        if not (lacks := _missing_facts(robot, name, device, reading)):
            measured = _measured(robot, name, device, reading)
            return SelfTestResult(name, True, f"{where} works{measured and f': {measured}'}.")
        text = f"{where} reports no {' and no '.join(lacks)}, which {robot.file.name} lists."
        return SelfTestResult(name, False, text)
    if isinstance(device, Camera):
        return SelfTestResult(name, False, device.sight.why or f"{where} gives no pictures.")
    why = str(getattr(device, "why", ""))
    if why:  # without the device's name; a screen that waits for a tablet is not broken
        said = why.removeprefix(f"{name}: ")
        return SelfTestResult(name, False, said, absent=reading.state == WARN)
    link = wiring.links.get(str(robot.drivers[name].settings.get("at", "")))
    if link is not None and not link.connected:
        return SelfTestResult(name, False, f"nobody answers at {link.url}.")
    if reading.state == ERROR:
        return SelfTestResult(name, False, f"{where} reports an error.")
    if reading.state == WARN:
        return SelfTestResult(name, False, f"{where} warns that something is wrong with it.")
    return SelfTestResult(name, False, f"{where} has sent nothing within {seconds:g} s.")


def _data_problem(robot: Robot, name: str, device: Device | Camera, reading: Reading) -> str:
    """Return what is wrong with the data of a device, "" if nothing is."""
    now = MachineClock().now()
    if name == "laser" and (scan := cast(Laser, device).scan) is not None:
        return scan_problem(scan, now)
    if name == "base" and (odometry := cast(Base, device).odometry) is not None:
        return odometry_problem(odometry, now)
    known = robot.devices[name].facts if name in robot.devices else {}
    for fact, value in reading.facts.items():
        measure = known.get(fact)
        if measure is not None and value == value and (why := measure.wrong(value)):
            return f"{fact} = {value} {why}"
    return ""


def _measured(robot: Robot, name: str, device: Device | Camera, reading: Reading) -> str:
    """Return what a device measures, to compare it with the robot: "" if nothing is known."""
    if name == "laser" and (stamped := cast(Laser, device).scan) is not None:
        scan = up_to(stamped.value, reach_of(robot))
        span = math.degrees(abs(scan.step) * (len(scan.ranges) - 1))
        told = f"{len(scan.ranges)} beams over {span:.0f}°"
        met = np.where((scan.ranges > 0) & (scan.ranges < scan.farthest), scan.ranges, np.inf)
        if not np.isfinite(met).any():
            return f"{told}, and none of them meets anything"
        nearest = int(np.argmin(met))
        bearing = scan.first + scan.step * nearest + laser_of(robot).heading
        side = round(math.degrees(math.atan2(math.sin(bearing), math.cos(bearing))))
        where = f"{abs(side)}° to its {'left' if side > 0 else 'right'}" if side else "ahead"
        return f"{told}, the nearest thing {scan.ranges[nearest]:.2f} m away, {where}"
    if name == "base" and (moved := cast(Base, device).odometry) is not None:
        x, y, heading = moved.value.pose
        return f"odometry {x:.2f}, {y:.2f} m, {math.degrees(heading):.0f}°"
    if isinstance(device, Camera) or name in PROTOCOLS:
        return ""
    words = {True: "yes", False: "no"}
    facts = [
        f"{fact} {words[value] if isinstance(value, bool) else value}"
        if isinstance(value, str | bool)
        else f"{fact} {value:.3g}"
        for fact, value in reading.facts.items()
    ]
    return ", ".join(facts)


def _missing_facts(robot: Robot, name: str, device: Device | Camera, reading: Reading) -> list[str]:
    """Return the facts of the robot's file that only this driver can report, and does not.

    Faults that need them would never be found. Tangy itself adds facts of a base, for example.
    """
    if isinstance(device, Camera) or name in PROTOCOLS or name not in robot.devices:
        return []
    return [fact for fact in robot.devices[name].facts if fact not in reading.facts]


def _where(robot: Robot, name: str, device: Device | Camera) -> str:
    if isinstance(device, Camera):
        return device.name
    driver = robot.drivers[name]
    at = driver.settings.get("at", "")
    return f"{driver.kind} at {at}" if at else driver.kind
