"""The kinds of drivers, the devices that each serves, and the settings that it takes.

Devices on the same link (a rosbridge server) share one connection.
"""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from tangy_hw.device_protocols import Clock, Device, DeviceError, Pose, fails, members_of
from tangy_hw.drivers.ros_status import RosDiagnostics
from tangy_hw.drivers.rosbridge import Rosbridge
from tangy_hw.drivers.simulated_clock import SteppedClock
from tangy_hw.robot_setup import Setting
from tangy_hw.watchdogs import DRIVES_BY
from tangy_profiles.activity import Activity
from tangy_profiles.errors import ProfileError, TangyError
from tangy_profiles.extensions import Extension, extensions
from tangy_profiles.reading import nearest, plain
from tangy_profiles.robot import Robot


class DriverSettings:
    """Settings of one driver; `close` rejects those that no driver took.

    Every reader raises a `DeviceError` with the device and the key if the value is missing and has
    no default, or is invalid.
    """

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
        """Take the robot's own names of joints, as the ROS drivers use them."""
        from tangy_hw.drivers.ros_messages import joined_names

        try:
            return dict(joined_names(self.text(key, "")))
        except ValueError as error:
            raise self.wrong(f"{key}: {error}") from None

    def pose(self, key: str) -> Pose:
        """Take a pose "X, Y, HEADING" in m and rad; the default is 0, 0, 0."""
        try:
            x, y, heading = map(float, self.text(key, "0, 0, 0").split(","))
        except ValueError:
            x = y = heading = math.nan
        if not all(map(math.isfinite, (x, y, heading))):
            raise self.wrong(f"{key} must be X, Y, HEADING.")
        return Pose(x, y, heading)

    def flag(self, key: str, default: bool) -> bool:
        """Take a boolean."""
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
        """Reject settings that were not taken.

        Raises:
            DeviceError: there are some.
        """
        for key in self._values:
            raise self.wrong(f"there is no setting '{key}'.")

    def wrong(self, problem: str) -> DeviceError:
        """Return an error about the driver's settings."""
        return DeviceError(plain(f"drivers.{self.device} ({self.kind}): {problem}"))


@dataclass
class Wiring:
    """Shared by the drivers of one robot: its clock, connections and diagnostics."""

    robot: Robot
    activity: Activity
    clock: Clock
    links: dict[str, Rosbridge] = field(default_factory=dict)
    diagnosing: dict[str, RosDiagnostics] = field(default_factory=dict)
    shared: dict[str, Any] = field(default_factory=dict)
    """What drivers of other packages share, such as a connection of base and battery, by name."""
    pairing: Mapping[str, str] = field(default_factory=dict)
    """Contents of the file of paired tablets (see `chest_pairing`); empty: a temporary pairing."""

    def link(self, at: str, ros: int, device: str) -> Rosbridge:
        """Return the link to a rosbridge server, shared by all its devices."""
        drives = device in DRIVES_BY
        if at not in self.links:
            self.links[at] = Rosbridge(at, clock=self.clock.now, ros=ros)
            self.links[at].drives = drives
        self.links[at].drives |= drives
        return self.links[at]

    def diagnostics(self, at: str) -> RosDiagnostics:
        """Return the diagnostics of a link's server, shared by all its devices."""
        if at not in self.diagnosing:
            self.diagnosing[at] = RosDiagnostics(self.links[at])
        return self.diagnosing[at]


Opens = Callable[[Wiring, DriverSettings], Device]


def _rosbridge(wiring: Wiring, settings: DriverSettings) -> Device:
    from tangy_hw.drivers.ros_arms import RosArms
    from tangy_hw.drivers.ros_battery import RosBattery
    from tangy_hw.drivers.ros_laser import RosLaser
    from tangy_hw.drivers.ros_navigator import RosNavigator
    from tangy_hw.drivers.ros_status import RosStopButton
    from tangy_hw.drivers.ros_voice import RosVoice

    at = settings.text("at")
    link = wiring.link(at, int(settings.number("ros", 1)), settings.device)
    diagnostics = wiring.diagnostics(at)
    match settings.device:
        case "base":
            return _ros_base(wiring, settings, link, diagnostics)
        case "laser":
            return RosLaser(
                link,
                topic=settings.text("topic", "/scan"),
                turned=settings.number("turned", 0.0),
                diagnostics=diagnostics,
            )
        case "battery":
            return RosBattery(link, topic=settings.text("topic", "/battery_state"))
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
                play=settings.text("play", ""),
                with_id=settings.flag("with_id", False),
                diagnostics=diagnostics,
            )
        case "navigator":
            return RosNavigator(
                link,
                action=settings.text("action", ""),
                frame=settings.text("frame", "map"),
                origin=settings.pose("origin"),
                place=settings.text("place", "/amcl_pose"),
                initial=settings.text("initial", "/initialpose"),
            )
        case "arms":
            return RosArms(
                link,
                wiring.robot.limbs,
                trajectory=settings.text("trajectory", "/joint_trajectory"),
                states=settings.text("states", "/joint_states"),
                torque=settings.text("torque", "/joint_torque"),
                names=settings.joints("names"),
                diagnostics=diagnostics,
            )
        case other:
            raise settings.wrong(f"rosbridge drives no device named {other!r}.")


def _ros_base(
    wiring: Wiring, settings: DriverSettings, link: Rosbridge, diagnostics: RosDiagnostics
) -> Device:
    from tangy_hw.drivers.ros_base import LIVES_SECONDS, MOST_SECONDS, REPEAT_SECONDS, RosBase
    from tangy_hw.drivers.velocity_watchdog import VelocityWatchdog

    # An accelerated bench has its own time; the machine's time would make runs differ.
    stepped = isinstance(wiring.clock, SteppedClock)
    drive, stamped = settings.text("drive", "/cmd_vel"), settings.flag("stamped", False)
    lives = settings.number("lives", LIVES_SECONDS)
    if not REPEAT_SECONDS < lives <= MOST_SECONDS:
        raise settings.wrong(f"lives must be above {REPEAT_SECONDS:g} s, up to {MOST_SECONDS:g}.")
    return RosBase(
        link,
        drive=drive,
        odometry=settings.text("odometry", "/odom"),
        stamped=stamped,
        lives=lives,
        repeat=0.0 if stepped else REPEAT_SECONDS,
        watchdog=None
        if stepped
        else VelocityWatchdog(link.url, ros=link.ros, drive=drive, stamped=stamped, lives=lives),
        diagnostics=diagnostics,
    )


def _scip(wiring: Wiring, settings: DriverSettings) -> Device:
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


def _page(wiring: Wiring, settings: DriverSettings) -> Device:
    from tangy_hw.drivers.chest import PORT, WebChestScreen
    from tangy_hw.drivers.chest_pairing import Pairing

    names = (name.strip().lower() for name in settings.text("names", "").split(","))
    return WebChestScreen(
        settings.text("host", "127.0.0.1"),
        int(settings.number("port", PORT)),
        name=settings.device,
        names=[name for name in names if name],
        pairing=Pairing.from_json(wiring.pairing) if wiring.pairing else None,
        stale_after=wiring.robot.devices[settings.device].stale_after,
    )


def _spoken(wiring: Wiring, settings: DriverSettings) -> Device:
    from tangy_hw.drivers.espeak_voice import SpokenVoice

    return SpokenVoice(
        name=settings.device,
        sink=settings.text("sink", "auto"),
        deck=wiring.activity.deck,
    )


def _dynamixel(wiring: Wiring, settings: DriverSettings) -> Device:
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


class DriverKind(NamedTuple):
    """A kind of driver: the devices that it serves, and its factory.

    `opens(wiring, settings)` returns a device (see `device_protocols`) that is not started yet.
    """

    devices: tuple[str, ...]
    opens: Opens


DRIVERS: Mapping[str, DriverKind] = {
    "rosbridge": DriverKind(
        ("base", "laser", "stop_button", "arms", "voice", "battery", "navigator"), _rosbridge
    ),
    "scip": DriverKind(("laser",), _scip),
    "page": DriverKind(("screen",), _page),
    "spoken": DriverKind(("voice",), _spoken),
    "dynamixel": DriverKind(("arms",), _dynamixel),
}
"""Tangy's own kinds of drivers; other packages add theirs by the entry points `tangy.drivers`."""


def driver_kind(extension: Extension) -> DriverKind:
    """Return the kind of driver that another package adds.

    Raises:
        ProfileError: it cannot be loaded, or is not a `DriverKind`.
    """
    kind = extension.load()
    if not isinstance(kind, DriverKind):
        raise ProfileError(plain(f"{extension}: {extension.value} is not a DriverKind."))
    return kind


def known_drivers() -> dict[str, DriverKind]:
    """Return all kinds of drivers that can be loaded, with those of other packages."""
    known = dict(DRIVERS)
    for name, extension in extensions("drivers").items():
        if name not in known:
            with suppress(ProfileError):  # `tangy doctor` reports why
                known[name] = driver_kind(extension)
    return known


def open_device(wiring: Wiring, device: str, values: Mapping[str, Setting]) -> Device:
    """Create the driver of a device, without starting it.

    Raises:
        DeviceError: there is no such kind, its settings are invalid, or the driver lacks members of
            the device's Protocol.
    """
    kind = str(values.get("kind", ""))
    if device in wiring.robot.devices and wiring.robot.devices[device].looks_at:
        raise DeviceError(
            f"drivers.{device}: a camera has no driver; write its source under [[devices]]."
        )
    drivers = DRIVERS if kind in DRIVERS else known_drivers()
    if kind not in drivers and kind in extensions("drivers"):
        try:
            driver_kind(extensions("drivers")[kind])
        except ProfileError as error:
            raise DeviceError(f"drivers.{device}: {error}") from None
    if kind not in drivers or device not in drivers[kind].devices:
        known = {name for name, driver in known_drivers().items() if device in driver.devices}
        meant = nearest(kind, known)
        if kind in known_drivers() or "did you mean" in meant:
            raise DeviceError(plain(f"drivers.{device}: {kind!r} drives no {device}; {meant}"))
        which = f"there is no driver {kind!r} (is its package installed beside Tangy?); {meant}"
        raise DeviceError(plain(f"drivers.{device}: {which}"))
    settings = DriverSettings(device, kind, {k: v for k, v in values.items() if k != "kind"})
    try:
        opened = drivers[kind].opens(wiring, settings)
    except TangyError:
        raise
    except Exception as error:  # of another package
        raise settings.wrong(fails(error)) from error
    settings.close()
    lacks = [name for name in members_of(device) if not _has(opened, name)]
    if lacks:
        raise settings.wrong(f"its driver has no {', '.join(lacks)}.")
    return opened


def _has(driver: Device, member: str) -> bool:
    """Return whether a driver has a member, without calling its properties."""
    missing = object()
    return inspect.getattr_static(driver, member, missing) is not missing
