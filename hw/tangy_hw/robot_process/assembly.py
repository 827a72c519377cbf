"""Assembles a robot: devices from its profile, and a controller from the devices."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Mapping
from contextlib import AsyncExitStack
from pathlib import Path
from typing import Any

import numpy as np

from tangy_hw.device_protocols import (
    ANSWERED,
    Clock,
    DeviceError,
    ExternalNavigation,
    MachineClock,
    Pose,
)
from tangy_hw.drivers.registry import Wiring, open_device
from tangy_hw.drivers.rosbridge import Rosbridge
from tangy_hw.drivers.simulated_clock import SteppedClock
from tangy_hw.navigation.dead_reckoning import DeadReckoning
from tangy_hw.navigation.external_navigator import ExternalNavigator
from tangy_hw.navigation.limits import MotionLimits, laser_of
from tangy_hw.navigation.map_files import read_map
from tangy_hw.navigation.navigator import Navigator
from tangy_hw.navigation.navigator_protocol import NavigatorProtocol
from tangy_hw.navigation.occupancy import map_of_room, with_feet
from tangy_hw.navigation.poses import IDENTITY
from tangy_hw.navigation.scan_recorder import ScanRecorder
from tangy_hw.perception.camera_hub import CameraHub, camera_sources
from tangy_hw.perception.card_and_face_perception import CardAndFacePerception
from tangy_hw.perception.requests.help_request_source import DEVICE as REQUESTS
from tangy_hw.perception.requests.help_request_source import RequestSource
from tangy_hw.robot_process.body import Body
from tangy_hw.robot_process.controller import LiveRobot
from tangy_hw.robot_process.driver_checks import safe_reading
from tangy_hw.robot_setup import RobotSetup, Setting
from tangy_profiles.activity import load_activity
from tangy_profiles.health import OK, WARN, Reading
from tangy_profiles.known_devices import left_out
from tangy_profiles.robot import Robot, load_robot
from tangy_profiles.room import Room, load_room

Calls = Callable[..., object]
"""Takes the device whose driver is called next, "" for none, and what it has to do in time."""
WAKE_SECONDS = 8.0  # for devices that were switched on to send first data
PIPE_LOOKS = 3  # frames that may still be in a pipe
AGREED_LOOKS = 2  # successive frames that show exactly the confirmed signs
SETTLE_SECONDS = 2.0  # of real time at most


def drivers_of(robot: Robot, given: Mapping[str, Mapping[str, Setting]]) -> dict[str, Any]:
    """Return the settings of each driver: given ones override those of the profile.

    If a base is given, the profile's own navigation is dropped, because it drives the profile's
    base. The source of requests is not a driver (see `perception.requests.source_names`).
    """
    own = {name: {"kind": d.kind, **d.settings} for name, d in robot.drivers.items()}
    own.pop(REQUESTS, None)
    if "base" in given:
        own.pop("navigator", None)
    return {**own, **given}


class RobotRuntime:
    """A robot with everything that belongs to it; switched on within `async with`."""

    def __init__(
        self,
        robot: LiveRobot,
        sensors: CameraHub,
        senses: CardAndFacePerception,
        bench: Rosbridge | None = None,
    ) -> None:
        self.robot = robot
        self._bench = bench
        self._sensors = sensors
        self._senses = senses
        self.starts: Callable[[str], object] = lambda part: None
        """Called with the name of each part during start-up."""
        self.calls: Calls = lambda device, did="": None
        """Called before each driver is read for the first time."""
        self._open = AsyncExitStack()

    async def __aenter__(self) -> RobotRuntime:
        try:
            if self._bench is not None:
                self._open.push_async_callback(self._bench.close)
                await self._bench.start()
            for camera in self._sensors.cameras:
                self.starts(camera)
            await self._open.enter_async_context(self._sensors)
            self._open.callback(self._senses.close)
            self._open.push_async_callback(self.robot.close)
            await self.robot.start(self.starts)
            self.starts("senses")
            await self._senses.prepare()
            self.starts("first words")
            self._read()
            await self._wake()
            self.robot.watch_ticks()  # slow steps of the start are over
        except BaseException:
            await self._open.aclose()
            raise
        return self

    async def __aexit__(self, *_: object) -> None:
        await self._open.aclose()

    def _read(self) -> None:
        """Read each device once: a driver that blocks is the one that was named last."""
        for device in self.robot.body.all:
            self.calls(device.name, ANSWERED)
            safe_reading(device)
        self.calls("")

    async def _wake(self) -> None:
        """Wait until every device has sent data; the readings show those that have not."""
        robot = self.robot

        def speaks(reading: Reading) -> bool:  # a chest screen without a tablet warns
            return reading.state == WARN or robot.watchdogs.state(reading) == OK

        await self._sensors.settled(WAKE_SECONDS)
        await robot.passing.until(lambda: all(map(speaks, robot.health())), WAKE_SECONDS)
        await self.settle()

    async def settle(self) -> None:
        """Wait, in real time, until signs that are up or down now are confirmed."""
        requests = self.robot.requests
        if requests is None:
            return
        first, until = requests.looks + PIPE_LOOKS, time.monotonic() + SETTLE_SECONDS
        while time.monotonic() < until:
            if requests.looks >= first and requests.agreed >= AGREED_LOOKS:
                return
            await asyncio.sleep(0.01)


def assemble(setup: RobotSetup, calls: Calls = lambda device, did="": None) -> RobotRuntime:
    """Assemble a robot from a setup, without switching it on.

    Args:
        setup: the setup.
        calls: called before each driver is opened.

    Raises:
        TangyError: a profile has a mistake, or a driver's settings are invalid.
    """
    robot, activity = load_robot(setup.robot), load_activity(setup.activity)
    for name in setup.without:
        robot = left_out(robot, name)
    room = load_room(setup.room)
    clock: Clock = SteppedClock() if setup.stepped else MachineClock()
    wiring = Wiring(robot, activity, clock, pairing=setup.pairing)
    devices: dict[str, Any] = {}
    for name, values in drivers_of(robot, setup.drivers).items():
        if name not in setup.without:
            calls(name)
            devices[name] = open_device(wiring, name, values)
    calls("")
    body = _body(devices, wiring)
    sensors = CameraHub(
        robot,
        camera_sources(robot, [f"{name}={source}" for name, source in setup.cameras.items()]),
        activity.deck,
        deck_seed=setup.deck_seed,
        log=Path(setup.log) if setup.log else None,
    )
    senses = CardAndFacePerception(
        sensors,
        activity,
        deck_seed=setup.deck_seed,
        faces={person: np.array(rows) for person, rows in setup.faces.items()},
        models=robot.faces,
    )
    live = LiveRobot(
        robot,
        body,
        _wayfinder(setup, robot, room, devices.get("navigator")),
        clock,
        senses=senses,
        requests=_requests(setup, room),
        stepped=setup.stepped,
        wait_explanations=setup.courtesies,
    )
    bench = None
    if isinstance(clock, SteppedClock):
        # A separate link, whose messages must not count as signs of life of the robot.
        bench = Rosbridge(next(iter(wiring.links)), clock=clock.now)
        clock.follow(bench, _counted(body))
    return RobotRuntime(live, sensors, senses, bench)


def _body(devices: Mapping[str, Any], wiring: Wiring) -> Body:
    for needed in ("base", "laser"):
        if needed not in devices:
            raise DeviceError(
                f"{wiring.robot.title} has no driver for {needed}: it must drive and see where."
            )
    served = ("base", "laser", "stop_button", "arms", "voice", "screen")
    own = [device for name, device in devices.items() if name not in served]
    return Body(
        base=devices["base"],
        laser=devices["laser"],
        stop_button=devices.get("stop_button"),
        arms=devices.get("arms"),
        voice=devices.get("voice"),
        screen=devices.get("screen"),
        others=(*wiring.links.values(), *wiring.diagnosing.values(), *own),
    )


def _counted(body: Body) -> dict[str, Callable[[], int]]:
    """Return counters of received scans and odometry messages, by the bench's names."""
    return {
        "laser": lambda: 0 if body.laser.scan is None else body.laser.scan.seq,
        "base": lambda: 0 if body.base.odometry is None else body.base.odometry.seq,
    }


def _wayfinder(
    setup: RobotSetup, robot: Robot, room: Room, own: ExternalNavigation | None
) -> NavigatorProtocol:
    """Return the navigation: the robot's own if it has one, otherwise Tangy's."""
    limits, laser = MotionLimits.of(robot), laser_of(robot)
    start = None if setup.start is None else Pose(*setup.start)
    if setup.record:
        return DeadReckoning(ScanRecorder(Path(setup.record)), start or IDENTITY, laser)
    if own is not None:
        return ExternalNavigator(own, limits, laser)
    count = len(setup.people)
    known = map_of_room(room, people=count)
    if setup.map:
        known = with_feet(read_map(Path(setup.map)), room, count)
    seats = room.seated(count)
    return Navigator(
        known,
        np.random.default_rng(setup.seed),
        start,
        limits=limits,
        laser=laser,
        people=np.array([(seat.x, seat.y) for seat in seats]),
    )


def _requests(setup: RobotSetup, room: Room) -> RequestSource | None:
    if not setup.requests or REQUESTS in setup.without:
        return None
    from tangy_hw.perception.requests.sources import open_requests

    return open_requests(setup.requests, room, setup.people, corners=setup.corners)
