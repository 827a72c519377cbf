"""Interfaces of a robot's devices, independent of their make.

Every reading has a stamp of the robot's clock and a sequence number; every command is acknowledged,
or raises a `DeviceError` after a timeout. Drivers implement these Protocols; the robot's TOML
selects the drivers. Lengths are in m, angles in rad counter-clockwise, times in s; poses are in the
room's frame (see `tangy_profiles.room`) unless stated otherwise.
"""

from __future__ import annotations

import asyncio
import inspect
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Generic, NamedTuple, Protocol, TypeVar, runtime_checkable

from tangy_profiles.errors import TangyError
from tangy_profiles.health import Reading
from tangy_profiles.reading import plain

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

Value = TypeVar("Value", covariant=True)


class DeviceError(TangyError):
    """A device did not execute a command, or is unavailable; one sentence that names it."""


class DeviceFailed(DeviceError):
    """A `device`, given by its name, cannot be switched on."""

    def __init__(self, device: str, text: str) -> None:
        super().__init__(text)
        self.device = device


def fails(error: Exception) -> str:
    """Return what is told about a driver that raises an error."""
    return plain(f"its driver fails: {type(error).__name__}: {error}").rstrip(".") + "."


STARTED, ANSWERED = "started", "answered"
"""Words for what a driver has not done in time."""


def hangs(seconds: float, did: str = STARTED) -> str:
    """Return what is told about a driver that has not `did` something within some s."""
    return f"its driver has not {did} within {seconds:g} s."


class Pose(NamedTuple):
    """Position and heading; heading 0 is along x."""

    x: float
    y: float
    heading: float


class Twist(NamedTuple):
    """Velocity of a base: forward in m/s, turning in rad/s."""

    forward: float = 0.0
    turn: float = 0.0


STILL = Twist()


class Odometry(NamedTuple):
    """Wheel odometry: the pose since the base was switched on, and the velocity."""

    pose: Pose
    twist: Twist


@dataclass(frozen=True, slots=True)
class Scan:
    """One turn of a laser scanner: beam i has the bearing `first` + i * `step`.

    `ranges` (n,) are in m; inf for a beam without a return, or without a valid range. A beam that
    ends at `farthest` or beyond it met nothing so far.
    """

    first: float
    step: float
    ranges: NDArray[np.float64]
    farthest: float


@dataclass(frozen=True, slots=True)
class Stamped(Generic[Value]):
    """A value with its time of arrival (the robot's clock, in s) and number.

    `measured` is when it was measured, on the same clock; None: unknown.
    """

    value: Value
    stamp: float
    seq: int
    measured: float | None = None

    @property
    def time(self) -> float:
        """When it was measured, as far as known, in s."""
        return self.stamp if self.measured is None else self.measured


class Picture(NamedTuple):
    """Content of the chest screen: a line in large type, the called number, the previous ones.

    `asks` is the person who is asked, "" for everybody. `file` is the path of a picture for the
    line.
    """

    text: str
    number: str = ""
    before: tuple[str, ...] = ()
    asks: str = ""
    file: str = ""


class Clock(Protocol):
    """The robot's time: the machine's, or that of a stepped bench."""

    def now(self) -> float:
        """Return the monotonic time in s."""
        ...

    async def sleep(self, seconds: float) -> None:
        """Sleep for a time in s of this clock."""
        ...


class MachineClock:
    """The time of this machine."""

    def now(self) -> float:
        """Return the monotonic time in s."""
        return time.monotonic()

    async def sleep(self, seconds: float) -> None:
        """Sleep for a time in s."""
        await asyncio.sleep(seconds)


class Device(Protocol):
    """Common interface of all devices; `reading` is for the diagnosis."""

    name: str

    async def start(self) -> None:
        """Start; an unreachable device reports this in its reading, and is tried again."""
        ...

    async def close(self) -> None:
        """Stop for good."""
        ...

    def reading(self) -> Reading:
        """Return its state, the age of its newest data, and its facts."""
        ...


class Base(Device, Protocol):
    """A drive base with wheel odometry."""

    @property
    def odometry(self) -> Stamped[Odometry] | None:
        """The newest odometry; None before the first."""
        ...

    async def drive(self, twist: Twist) -> None:
        """Drive at a twist until the next command, which must come within half a second.

        Raises:
            DeviceError: the command could not be sent.
        """
        ...

    async def stop(self) -> None:
        """Stop now, ahead of all queued commands; never raises."""
        ...


class Laser(Device, Protocol):
    """A scanner that measures distances all around, or nearly."""

    @property
    def scan(self) -> Stamped[Scan] | None:
        """The newest scan; None before the first."""
        ...


class StopButton(Device, Protocol):
    """The emergency stop."""

    @property
    def latched(self) -> bool:
        """Whether it is pressed."""
        ...


class Arms(Device, Protocol):
    """Limbs that take poses; the head is one of them."""

    async def pose(self, angles: Mapping[str, Sequence[float]], seconds: float) -> None:
        """Move limbs to joint angles (degrees, by limb) within `seconds` s, and wait.

        Raises:
            DeviceError: a servo reports an error, or a joint does not arrive in time.
        """
        ...

    async def hold(self) -> None:
        """Hold the current position with torque on, and drop the goal; never raises.

        A movement in progress ends with a DeviceError.
        """
        ...

    async def relax(self) -> None:
        """Switch the torque of all joints off; never raises."""
        ...


class ChestScreen(Device, Protocol):
    """The screen on the robot's chest."""

    async def show(self, picture: Picture) -> None:
        """Show a picture until the next one.

        Raises:
            DeviceError: no page has drawn it.
        """
        ...


@runtime_checkable
class AnswersCalls(Protocol):
    """A chest screen on which people can answer a call for staff."""

    answered: tuple[str, ...]
    """Keys of the open calls that were answered at it."""

    def offer(self, calls: Mapping[str, str]) -> None:
        """Show a button for each open call, and only for these: the called person's name by key."""
        ...


class Voice(Device, Protocol):
    """The robot's voice."""

    async def say(self, text: str) -> None:
        """Speak, and wait until the speech has ended.

        Raises:
            DeviceError: it cannot be spoken.
        """
        ...

    async def play(self, sound: Path) -> None:
        """Play a WAV file, and wait until it has ended or `hush` has cut it.

        Raises:
            DeviceError: it cannot be heard.
        """
        ...

    async def hush(self) -> None:
        """Stop speaking now; never raises."""
        ...


class ExternalNavigation(Device, Protocol):
    """A robot's own navigation, which localises the robot and drives it to goals.

    The facts of its reading include `path`: clear, replanned or none.
    """

    @property
    def pose(self) -> Stamped[Pose] | None:
        """Pose that the robot reports; None before the first."""
        ...

    def localisation(self) -> Reading:
        """Return the age of the pose, with its certainty as the facts `fit` and `spread`."""
        ...

    def place(self, pose: Pose) -> None:
        """Set the robot's pose.

        Raises:
            DeviceError: it could not be sent.
        """
        ...

    async def go(self, goal: Pose) -> None:
        """Drive to a pose, and wait for the arrival.

        Raises:
            DeviceError: the robot does not arrive, or the goal was cancelled.
        """
        ...

    async def cancel(self) -> None:
        """Cancel the goal, and wait a moment for the confirmation; never raises."""
        ...


PROTOCOLS: Mapping[str, type] = {
    "base": Base,
    "laser": Laser,
    "stop_button": StopButton,
    "arms": Arms,
    "screen": ChestScreen,
    "voice": Voice,
    "navigator": ExternalNavigation,
}
"""The Protocol of each device; all others, such as a battery, implement `Device` only."""


def members_of(device: str) -> tuple[str, ...]:
    """Return the names of the members that the driver of a device must have."""
    ours = [one for one in PROTOCOLS.get(device, Device).__mro__ if one.__module__ == __name__]
    names = (name for one in reversed(ours) for name in (*inspect.get_annotations(one), *vars(one)))
    return tuple(dict.fromkeys(name for name in names if not name.startswith("_")))
