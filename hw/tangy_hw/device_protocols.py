"""The interfaces of a robot's devices, independent of their make.

Every reading has a stamp of the robot's clock and a sequence number; every command is
acknowledged, or is a `DeviceError` after a time-out. Drivers satisfy these Protocols; which driver
a robot has stands in its TOML. Lengths are metres, angles radians counter-clockwise, times seconds;
poses are in the room's frame (see `tangy_profiles.room`) unless said otherwise.
"""

from __future__ import annotations

import asyncio
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Generic, NamedTuple, Protocol, TypeVar, runtime_checkable

from tangy_profiles.errors import TangyError
from tangy_profiles.health import Reading

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

Value = TypeVar("Value", covariant=True)


class DeviceError(TangyError):
    """A device did not do what it was told, or cannot be had; one sentence that names it."""


class Pose(NamedTuple):
    """Where something stands and which way it faces; heading 0 is along x."""

    x: float
    y: float
    heading: float


class Twist(NamedTuple):
    """How fast a base drives: forward in m/s, turning in rad/s."""

    forward: float = 0.0
    turn: float = 0.0


STILL = Twist()


class Odometry(NamedTuple):
    """What the wheels report: the pose since the base was switched on, and how fast it drives."""

    pose: Pose
    twist: Twist


@dataclass(frozen=True, slots=True)
class Scan:
    """One turn of a laser scanner: beam i looks at `first` + i * `step`, from straight ahead.

    `ranges` (n,) are metres; a beam that met nothing, or of which nothing is known, is inf.
    """

    first: float
    step: float
    ranges: NDArray[np.float64]
    farthest: float


@dataclass(frozen=True, slots=True)
class Stamped(Generic[Value]):
    """A value with the time at which it came (the robot's clock, in s) and its number."""

    value: Value
    stamp: float
    seq: int


class Picture(NamedTuple):
    """What the chest screen shows: a line in large type, the number that was called, the last few.

    `asks` is for whom something is asked, "" for everybody. `file` is the path of a picture that is
    shown with the line.
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
        """Let so much of it pass, in s."""
        ...


class MachineClock:
    """The time of this machine."""

    def now(self) -> float:
        """Return the monotonic time in s."""
        return time.monotonic()

    async def sleep(self, seconds: float) -> None:
        """Wait for so many s."""
        await asyncio.sleep(seconds)


class Device(Protocol):
    """What all devices have in common; `reading` is what the diagnosis is told."""

    name: str

    async def start(self) -> None:
        """Begin; a device that cannot be reached says so in its reading, and is tried again."""
        ...

    async def close(self) -> None:
        """End for good."""
        ...

    def reading(self) -> Reading:
        """Return its state, the age of its newest data, and the facts it has of itself."""
        ...


class Base(Device, Protocol):
    """Wheels that drive, and say how far they have turned."""

    @property
    def odometry(self) -> Stamped[Odometry] | None:
        """The newest odometry; None: there was none yet."""
        ...

    async def drive(self, twist: Twist) -> None:
        """Drive so until the next command, which must come within half a second.

        Raises:
            DeviceError: the command could not be handed over.
        """
        ...

    async def stop(self) -> None:
        """Stand still now; it waits behind nothing, and never raises."""
        ...


class Laser(Device, Protocol):
    """A scanner that measures distances all around, or nearly."""

    @property
    def scan(self) -> Stamped[Scan] | None:
        """The newest scan; None: there was none yet."""
        ...


class StopButton(Device, Protocol):
    """The emergency stop."""

    @property
    def latched(self) -> bool:
        """Whether it is pressed."""
        ...


class Arms(Device, Protocol):
    """Limbs that take postures; the head is one of them."""

    async def pose(self, angles: Mapping[str, Sequence[float]], seconds: float) -> None:
        """Move limbs to joint angles (degrees, by limb) within so many s, and wait for it.

        Raises:
            DeviceError: a servo reports an error, or is not there in time.
        """
        ...

    async def hold(self) -> None:
        """Hold the current position with torque on, and drop the goal; never raises.

        A movement that is waited for ends with a DeviceError.
        """
        ...

    async def relax(self) -> None:
        """Let all of it hang without torque; never raises."""
        ...


class ChestScreen(Device, Protocol):
    """The screen on the robot's chest."""

    async def show(self, picture: Picture) -> None:
        """Show something, until the next.

        Raises:
            DeviceError: nobody took it.
        """
        ...


@runtime_checkable
class AnswersCalls(Protocol):
    """A chest screen at which people can say that they come when staff are called."""

    answered: tuple[str, ...]
    """The keys of the open calls that were answered at it."""

    def offer(self, calls: Mapping[str, str]) -> None:
        """Show a button for each open call, and none for any other: who is called, by its key."""
        ...


class Voice(Device, Protocol):
    """The robot's voice."""

    async def say(self, text: str) -> None:
        """Say something, and wait until it was said.

        Raises:
            DeviceError: it cannot be said.
        """
        ...

    async def play(self, sound: Path) -> None:
        """Play a WAV file, and wait until it was heard, or cut by `hush`.

        Raises:
            DeviceError: it cannot be heard.
        """
        ...

    async def hush(self) -> None:
        """Be quiet now; never raises."""
        ...


class OwnNavigation(Device, Protocol):
    """A robot's own navigation, which localises the robot and drives it to goals.

    The facts of its reading have the `path`: clear, replanned or none.
    """

    @property
    def pose(self) -> Stamped[Pose] | None:
        """Where the robot says that it is; None: it did not say so yet."""
        ...

    def localisation(self) -> Reading:
        """Return how long ago it said so, and as facts how sure it is: `fit` and `spread`."""
        ...

    def place(self, pose: Pose) -> None:
        """Tell it that the robot is there.

        Raises:
            DeviceError: it could not be handed over.
        """
        ...

    async def go(self, goal: Pose) -> None:
        """Drive somewhere, and wait until it is there.

        Raises:
            DeviceError: it is not taken there, or that was called off.
        """
        ...

    async def cancel(self) -> None:
        """Call off where it drives to, and wait a moment until it has heard; never raises."""
        ...
