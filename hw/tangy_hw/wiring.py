"""The wiring of a robot: from what its profile names to devices, and from devices to a robot.

Here stands which kinds of drivers there are, and which settings each takes. Devices that share a
link (a rosbridge server) share one connection.
"""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Mapping
from contextlib import AsyncExitStack
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from tangy_hw.bench_clock import SteppedClock
from tangy_hw.devices import Clock, Device, DeviceError, Laser, MachineClock, Pose
from tangy_hw.drivers.ros_status import RosDiagnostics
from tangy_hw.drivers.rosbridge import Rosbridge
from tangy_hw.navigation.navigator import Navigator
from tangy_hw.navigation.occupancy import map_of_room
from tangy_hw.perception.requests.asking import RequestSource
from tangy_hw.robot import Body, LiveRobot
from tangy_hw.robot_setup import RobotSetup, Setting
from tangy_hw.senses import Senses
from tangy_hw.sensors import Sensors, camera_sources
from tangy_profiles.activity import Activity, load_activity
from tangy_profiles.health import OK
from tangy_profiles.reading import nearest, plain
from tangy_profiles.robot import Robot, load_robot
from tangy_profiles.room import Room, load_room

WAKE_SECONDS = 8.0  # in which devices that are switched on begin to speak
PIPE_LOOKS = 3  # pictures that may have been on their way
AGREED_LOOKS = 2  # pictures in a row that show no other signs than are believed to be up
SETTLE_SECONDS = 2.0  # of real time at most


class Settings:
    """The settings of one driver, taken one by one; what nobody took is refused."""

    def __init__(self, device: str, kind: str, values: Mapping[str, Setting]) -> None:
        self.device = device
        self.kind = kind
        self._values = dict(values)

    def text(self, key: str, default: str | None = None) -> str:
        """Take a text."""
        value = self._take(key, default)
        if not isinstance(value, str):
            raise self.wrong(f"{key} must be a text.")
        return value

    def number(self, key: str, default: float | None = None) -> float:
        """Take a number."""
        value = self._take(key, default)
        if isinstance(value, str | bool):
            raise self.wrong(f"{key} must be a number.")
        return float(value)

    def joints(self, key: str) -> dict[str, str]:
        """Take how joints are named elsewhere, as the drivers of ROS have it."""
        from tangy_hw.drivers.ros_messages import joined_names

        try:
            return dict(joined_names(self.text(key, "")))
        except ValueError as error:
            raise self.wrong(f"{key}: {error}") from None

    def flag(self, key: str, default: bool) -> bool:
        """Take true or false."""
        value = self._take(key, default)
        if not isinstance(value, bool):
            raise self.wrong(f"{key} must be true or false.")
        return value

    def _take(self, key: str, default: Setting | None) -> Setting:
        value = self._values.pop(key, default)
        if value is None:
            raise self.wrong(f"{key} is missing.")
        return value

    def close(self) -> None:
        """Refuse what nobody took.

        Raises:
            DeviceError: there is something.
        """
        for key in self._values:
            raise self.wrong(f"{key} is no setting of it.")

    def wrong(self, problem: str) -> DeviceError:
        """Make the error for a driver that is set wrongly."""
        return DeviceError(plain(f"drivers.{self.device} ({self.kind}): {problem}"))


@dataclass
class Wiring:
    """What the drivers of one robot share: its clock, its links, what is told of them."""

    robot: Robot
    activity: Activity
    clock: Clock
    links: dict[str, Rosbridge] = field(default_factory=dict)
    diagnosing: dict[str, RosDiagnostics] = field(default_factory=dict)

    def link(self, at: str, ros: int) -> Rosbridge:
        """Return the link to a rosbridge server, one for all who ask for it."""
        if at not in self.links:
            self.links[at] = Rosbridge(at, clock=self.clock.now, ros=ros)
        return self.links[at]

    def diagnostics(self, at: str) -> RosDiagnostics:
        """Return what a link's server says of its devices, one for all who ask for it."""
        if at not in self.diagnosing:
            self.diagnosing[at] = RosDiagnostics(self.links[at])
        return self.diagnosing[at]


Opens = Callable[[Wiring, Settings], Device]


def _rosbridge(wiring: Wiring, settings: Settings) -> Device:
    from tangy_hw.drivers.ros_arms import RosArms
    from tangy_hw.drivers.ros_base import REPEAT_SECONDS, RosBase
    from tangy_hw.drivers.ros_laser import RosLaser
    from tangy_hw.drivers.ros_status import RosStopButton
    from tangy_hw.drivers.ros_voice import RosVoice

    at = settings.text("at")
    link = wiring.link(at, int(settings.number("ros", 1)))
    diagnostics = wiring.diagnostics(at)
    match settings.device:
        case "base":
            return RosBase(
                link,
                drive=settings.text("drive", "/cmd_vel"),
                odometry=settings.text("odometry", "/odom"),
                stamped=settings.flag("stamped", False),
                # A bench in a hurry is told by its own time; the machine's would make runs differ.
                repeat=0.0 if isinstance(wiring.clock, SteppedClock) else REPEAT_SECONDS,
                diagnostics=diagnostics,
            )
        case "laser":
            return RosLaser(
                link,
                topic=settings.text("topic", "/scan"),
                turned=settings.number("turned", 0.0),
                diagnostics=diagnostics,
            )
        case "stop_button":
            return RosStopButton(
                link,
                topic=settings.text("topic", "/stop_button"),
                changes_only=settings.flag("changes_only", False),
            )
        case "voice":
            return RosVoice(
                link,
                say=settings.text("say", "/voice/say"),
                said=settings.text("said", "/voice/said"),
                hush=settings.text("hush", "/voice/hush"),
                with_id=settings.flag("with_id", False),
                diagnostics=diagnostics,
            )
    return RosArms(
        link,
        wiring.robot.limbs,
        trajectory=settings.text("trajectory", "/joint_trajectory"),
        states=settings.text("states", "/joint_states"),
        torque=settings.text("torque", "/joint_torque"),
        names=settings.joints("names"),
        diagnostics=diagnostics,
    )


def _scip(wiring: Wiring, settings: Settings) -> Device:
    from tangy_hw.drivers.scip import ScipLaser

    return ScipLaser(
        settings.text("at"),
        name=settings.device,
        clock=wiring.clock.now,
        stale_after=wiring.robot.devices[settings.device].stale_after,
        turned=settings.number("turned", 0.0),
        flipped=settings.flag("flipped", False),
        skip=int(settings.number("skip", 0)),
        baud=int(settings.number("baud", 115_200)),
    )


def _page(wiring: Wiring, settings: Settings) -> Device:
    from tangy_hw.drivers.chest import PORT, WebChestScreen

    return WebChestScreen(
        settings.text("host", "127.0.0.1"),
        int(settings.number("port", PORT)),
        name=settings.device,
        stale_after=wiring.robot.devices[settings.device].stale_after,
    )


def _spoken(wiring: Wiring, settings: Settings) -> Device:
    from tangy_hw.drivers.espeak_voice import SpokenVoice

    return SpokenVoice(
        name=settings.device,
        sink=settings.text("sink", "auto"),
        deck=wiring.activity.deck,
    )


def _dynamixel(wiring: Wiring, settings: Settings) -> Device:
    from tangy_hw.drivers.dynamixel import DynamixelArms, servos_of

    try:
        servos = servos_of(settings.text("servos"))
    except ValueError as error:
        raise settings.wrong(f"servos: {error}") from None
    return DynamixelArms(
        settings.text("at"),
        wiring.robot.limbs,
        servos,
        name=settings.device,
        baud=int(settings.number("baud", 1_000_000)),
        clock=wiring.clock.now,
    )


DRIVERS: Mapping[str, tuple[tuple[str, ...], Opens]] = {
    "rosbridge": (("base", "laser", "stop_button", "arms", "voice"), _rosbridge),
    "scip": (("laser",), _scip),
    "page": (("screen",), _page),
    "spoken": (("voice",), _spoken),
    "dynamixel": (("arms",), _dynamixel),
}
"""The kinds of drivers: for which devices each is, and what opens it."""


def open_device(wiring: Wiring, device: str, values: Mapping[str, Setting]) -> Device:
    """Open the driver of a device; it is not started yet.

    Raises:
        DeviceError: there is no such kind, or it is set wrongly.
    """
    kind = str(values.get("kind", ""))
    known = {name for name, (devices, _) in DRIVERS.items() if device in devices}
    if kind not in known:
        raise DeviceError(
            plain(f"drivers.{device}: {kind!r} drives no {device}; {nearest(kind, known)}")
        )
    settings = Settings(device, kind, {k: v for k, v in values.items() if k != "kind"})
    opened = DRIVERS[kind][1](wiring, settings)
    settings.close()
    return opened


def drivers_of(robot: Robot, given: Mapping[str, Mapping[str, Setting]]) -> dict[str, Any]:
    """Return the settings of each driver: the given ones go before those of the profile."""
    own = {name: {"kind": d.kind, **d.settings} for name, d in robot.drivers.items()}
    return {**own, **given}


class Wired:
    """A robot with all that belongs to it; within `async with` it is switched on."""

    def __init__(
        self, robot: LiveRobot, sensors: Sensors, senses: Senses, bench: Rosbridge | None = None
    ) -> None:
        self.robot = robot
        self._bench = bench
        self._sensors = sensors
        self._senses = senses
        self._open = AsyncExitStack()

    async def __aenter__(self) -> Wired:
        try:
            if self._bench is not None:
                self._open.push_async_callback(self._bench.close)
                await self._bench.start()
            await self._open.enter_async_context(self._sensors)
            self._open.callback(self._senses.close)
            self._open.push_async_callback(self.robot.close)
            await self.robot.start()
            await self._senses.prepare()
            await self._wake()
        except BaseException:
            await self._open.aclose()
            raise
        return self

    async def __aexit__(self, *_: object) -> None:
        await self._open.aclose()

    async def _wake(self) -> None:
        """Wait until every device has said something; what does not is seen by its reading."""
        robot = self.robot
        await self._sensors.settled(WAKE_SECONDS)
        await robot.passing.until(
            lambda: all(robot.state_of(reading) == OK for reading in robot.health()), WAKE_SECONDS
        )
        await self.settle()

    async def settle(self) -> None:
        """Wait, in real time, until signs that are up or down now have been believed."""
        requests = self.robot.requests
        if requests is None:
            return
        first, until = requests.looks + PIPE_LOOKS, time.monotonic() + SETTLE_SECONDS
        while time.monotonic() < until:
            if requests.looks >= first and requests.agreed >= AGREED_LOOKS:
                return
            await asyncio.sleep(0.01)


def wire(setup: RobotSetup) -> Wired:
    """Put a robot together as a setup says; nothing is switched on yet.

    Raises:
        TangyError: a profile has a mistake, or a driver is set wrongly.
    """
    robot, activity = load_robot(setup.robot), load_activity(setup.activity)
    room = load_room(setup.room)
    clock: Clock = SteppedClock() if setup.stepped else MachineClock()
    wiring = Wiring(robot, activity, clock)
    devices = {
        name: open_device(wiring, name, values)
        for name, values in drivers_of(robot, setup.drivers).items()
    }
    body = _body(devices, wiring)
    sensors = Sensors(
        robot,
        camera_sources(robot, [f"{name}={source}" for name, source in setup.cameras.items()]),
        activity.deck,
        deck_seed=setup.deck_seed,
        log=Path(setup.log) if setup.log else None,
    )
    senses = Senses(
        sensors,
        activity,
        deck_seed=setup.deck_seed,
        faces={person: np.array(rows) for person, rows in setup.faces.items()},
        models=robot.faces,
    )
    live = LiveRobot(
        robot,
        body,
        _navigator(setup, robot, room, body.laser),
        clock,
        senses=senses,
        requests=_requests(setup, room),
        stepped=setup.stepped,
    )
    bench = None
    if isinstance(clock, SteppedClock):
        # A link of its own: what it says is not to be taken for a word of the robot's.
        bench = Rosbridge(next(iter(wiring.links)), clock=clock.now)
        clock.follow(bench, _counted(body.laser))
    return Wired(live, sensors, senses, bench)


def _body(devices: Mapping[str, Any], wiring: Wiring) -> Body:
    for needed in ("base", "laser"):
        if needed not in devices:
            raise DeviceError(
                f"{wiring.robot.title} has no driver for {needed}: it must drive and see where."
            )
    return Body(
        base=devices["base"],
        laser=devices["laser"],
        stop_button=devices.get("stop_button"),
        arms=devices.get("arms"),
        voice=devices.get("voice"),
        screen=devices.get("screen"),
        others=(*wiring.links.values(), *wiring.diagnosing.values()),
    )


def _counted(laser: Laser) -> dict[str, Callable[[], int]]:
    def count() -> int:
        return 0 if laser.scan is None else laser.scan.seq

    return {"laser": count}


def _navigator(setup: RobotSetup, robot: Robot, room: Room, laser: Laser) -> Navigator:
    from tangy_hw.navigation.pursuit import Limits

    known = map_of_room(room)
    start = None if setup.start is None else Pose(*setup.start)
    seats = room.seated(len(setup.people))
    return Navigator(
        known,
        np.random.default_rng(setup.seed),
        start,
        limits=Limits(speed=robot.speed),
        people=np.array([(seat.x, seat.y) for seat in seats]),
    )


def _requests(setup: RobotSetup, room: Room) -> RequestSource | None:
    if not setup.requests:
        return None
    from tangy_hw.perception.requests.sources import open_requests

    return open_requests(setup.requests, room, setup.people, corners=setup.corners)
