"""Arms of Dynamixel servos (X series, protocol 2.0) on a serial port, without ROS.

A thread talks to the bus through Robotis' package, which the extra `dynamixel` installs.
"""

from __future__ import annotations

import asyncio
import logging
import math
import time
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from functools import partial
from typing import NamedTuple

from tangy_hw.device_protocols import DeviceError
from tangy_hw.drivers.dynamixel_bus import Bus, BusError, meaning
from tangy_hw.drivers.joint_moves import TOLERANCE, JointMoves
from tangy_hw.drivers.latest_value import LatestValue
from tangy_profiles.health import ERROR, OK, Reading
from tangy_profiles.reading import plain
from tangy_profiles.robot import Limb

_LOG = logging.getLogger(__name__)

POLL_SECONDS = 0.1  # between two reads of the positions
ERRORS_EVERY = 5  # reads of the positions for each read of the hardware errors
AGAIN_SECONDS = 1.0  # until a missing port is tried again
CENTRE = 180.0  # default servo angle in degrees at which a joint is at zero


class Servo(NamedTuple):
    """Servo of a joint: its id on the bus, its direction, and its angle at the joint's zero."""

    id: int
    turns: int = 1
    zero: float = CENTRE

    def angle(self, joint: float) -> float:
        """Return the servo's angle in degrees for a joint's in rad."""
        return self.zero + self.turns * math.degrees(joint)

    def joint(self, angle: float) -> float:
        """Return the joint's angle in rad for a servo's in degrees."""
        return math.radians(self.turns * (angle - self.zero))


def servos_of(text: str) -> dict[str, Servo]:
    """Parse a profile's joints and servos: "limb/joint = 12, other/joint = -7@175".

    The number is the servo's id, with a minus if it turns the other way; after @ comes the servo's
    angle in degrees at which the joint is at zero.

    Raises:
        DeviceError: the text is invalid, or an id occurs twice.
    """
    servos: dict[str, Servo] = {}
    for part in filter(None, (part.strip() for part in text.split(","))):
        joint, _, what = (piece.strip() for piece in part.partition("="))
        number, _, zero = what.partition("@")
        try:
            servo = Servo(abs(int(number)), -1 if number.startswith("-") else 1)
            servo = servo._replace(zero=float(zero) if zero else CENTRE)
        except ValueError:
            raise DeviceError(plain(f"{part}: write LIMB/JOINT = ID, or -ID@ZERO.")) from None
        known = servo.id in (other.id for other in servos.values()) or joint in servos
        if not joint or known or not 0 <= servo.id <= 252 or not 0 <= servo.zero <= 360:
            raise DeviceError(plain(f"{part}: a joint has one servo, with an id from 0 to 252."))
        servos[joint] = servo
    return servos


class DynamixelArms:
    """Limbs of servos that take poses; they are limp until the first one."""

    def __init__(
        self,
        port: str,
        limbs: Mapping[str, Limb],
        servos: Mapping[str, Servo],
        *,
        name: str = "arms",
        baud: int = 1_000_000,
        clock: Callable[[], float] = time.monotonic,
        tolerance: float = TOLERANCE,
    ) -> None:
        """Describe the port and the servos; `start` opens the port.

        Args:
            port: path of the serial port, such as /dev/ttyUSB0.
            limbs: the limbs of the robot's profile, with their joints and limits.
            servos: the servos by "limb/joint"; a joint without one does not move.
            name: its name in the robot's profile.
            baud: bits a second on the bus.
            clock: returns the time in s.
            tolerance: position error in degrees within which a joint has arrived.

        Raises:
            DeviceError: a servo belongs to no joint.
        """
        self.name = name
        self._port, self._baud, self._clock = port, baud, clock
        self._limbs, self._servos = limbs, dict(servos)
        joints = {f"{limb.name}/{joint}" for limb in limbs.values() for joint in limb.joints}
        if unknown := self._servos.keys() - joints:
            raise DeviceError(plain(f"{name}: there is no joint {min(unknown)}."))
        self._by_id = {servo.id: joint for joint, servo in self._servos.items()}
        self._newest: LatestValue[None] = LatestValue(clock)
        self._moves = JointMoves(name, math.radians(tolerance), clock)
        self._errors: dict[int, str] = {}
        self.bus: Bus | None = None
        self._hangs = True  # intentionally: it has had no torque yet, or was relaxed
        self.unsure = False  # a servo may have lost its torque, which is switched on again then
        self._stands = False  # told to hold while the port was missing
        self._thread: ThreadPoolExecutor | None = None
        self._task: asyncio.Task[None] | None = None

    @property
    def positions(self) -> Mapping[str, float]:
        """Latest position of each joint in rad."""
        return self._moves.positions

    async def start(self) -> None:
        """Start polling positions; a missing port is tried again.

        Raises:
            DeviceError: the package for it is not installed.
        """
        if self._task is None:
            Bus.check()
            self._newest.restart()
            self._thread = ThreadPoolExecutor(1, thread_name_prefix="dynamixel")
            self._task = asyncio.create_task(self._live())

    async def close(self) -> None:
        """Switch the torque off, and close the port."""
        task, self._task = self._task, None
        if task is None or self._thread is None:
            return
        await self.relax()
        task.cancel()
        await asyncio.wait({task})
        await self._do(self._hang_up)
        self._thread.shutdown(wait=False)
        self._thread = None

    def reading(self) -> Reading:
        """Return the age of the last complete positions, and whether a servo reports an error."""
        broken = bool(self._errors)
        facts = {"hardware_error": broken}
        return self._newest.reading(self.name, ERROR if broken else OK, facts)

    @property
    def why(self) -> str:
        """Its problem, in one sentence; "" if none is known."""
        if self._errors:
            number, what = next(iter(self._errors.items()))
            return plain(f"{self.name}: the servo of {self._by_id[number]} reports {what}.")
        return "" if self.bus is not None else plain(f"{self.name}: {self._port} is not there.")

    async def pose(self, angles: Mapping[str, Sequence[float]], seconds: float) -> None:
        """Move limbs to joint angles (degrees, by limb) within `seconds` s, and wait.

        Raises:
            DeviceError: there is no such limb, a servo reports an error or cannot reach the angle,
                another pose replaces this one, or a joint does not arrive in time.
        """
        _LOG.info("poses %s within %.1f s", ", ".join(angles), seconds)
        goals: dict[str, float] = {}
        for name, degrees in angles.items():
            joints = self._limbs[name].joints if name in self._limbs else ()
            if len(joints) != len(degrees) or not all(map(math.isfinite, degrees)):
                raise DeviceError(plain(f"{self.name} cannot take {name} to {list(degrees)}."))
            for joint, angle in zip(joints, degrees, strict=True):
                if f"{name}/{joint}" in self._servos:
                    goals[f"{name}/{joint}"] = math.radians(angle)
        wanted = {self._servos[j].id: self._servos[j].angle(goal) for j, goal in goals.items()}
        if not goals:
            return
        for number, angle in wanted.items():
            if not 0 <= angle < 360:
                wrong = f"{self._by_id[number]} cannot turn to {angle:.0f} degrees of its servo."
                raise DeviceError(plain(f"{self.name}: {wrong}"))
        if self.bus is None or self._errors:
            raise DeviceError(self.why)
        was, limp = (self._hangs, self.unsure), self._hangs or self.unsure
        self._hangs = self.unsure = self._stands = False
        arriving = asyncio.create_task(self._moves.arrive(goals, seconds, self._well))
        try:
            await self._do(lambda: self._move(wanted, seconds, limp))
            await arriving
        except BusError as error:
            self._hangs, self.unsure = self._hangs or was[0], self.unsure or was[1]
            with suppress(BusError):  # a servo's error may be the cause
                await self._do(partial(self._look, errors=True))
                self._take()
            raise DeviceError(
                self.why if self._errors else plain(f"{self.name}: {error}")
            ) from None
        except DeviceError:
            if self._errors or self.bus is None:
                raise DeviceError(self.why) from None
            raise
        finally:
            arriving.cancel()

    async def hold(self) -> None:
        """Stop at the current position with the current torque; never raises."""
        self._moves.end(f"{self.name} was told to hold.")
        if not self._hangs:
            with suppress(BusError):
                await self._do(self._stand)

    async def relax(self) -> None:
        """Switch the torque off; never raises."""
        self._moves.end(f"{self.name} was let hang.")
        self._hangs, self._stands = True, False
        with suppress(BusError):
            await self._do(self._let_go)

    def _well(self) -> bool:
        return self.bus is not None and not self._errors

    async def _do(self, work: Callable[[], object]) -> None:
        """Run something in the thread of the bus, which serialises all access."""
        if self._thread is not None:
            await asyncio.get_running_loop().run_in_executor(self._thread, work)

    async def _live(self) -> None:
        turn = 0
        while True:
            try:
                await self._do(partial(self._look, errors=turn % ERRORS_EVERY == 0))
                turn += 1
                self._take()
                await asyncio.sleep(POLL_SECONDS)
            except BusError:
                await self._do(self._hang_up)
                self.unsure = True
                await asyncio.sleep(AGAIN_SECONDS)

    def _take(self) -> None:
        """Process the results of the thread."""
        bus = self.bus
        if bus is None:
            return
        self._errors = {number: meaning(bits) for number, bits in bus.errors.items() if bits}
        found = bus.angles
        self._moves.hear(
            {
                self._by_id[n]: self._servos[self._by_id[n]].joint(angle)
                for n, angle in found.items()
            }
        )
        if len(found) == len(self._by_id):
            self._newest.take(None)
        else:
            self.unsure = True  # a servo that lost its power has lost its torque

    # ---------------------------------------------------------------- in the thread of the bus

    def _look(self, *, errors: bool) -> None:
        if self.bus is None:
            self.bus = Bus(self._port, self._baud, tuple(self._by_id))
            if self._stands:
                self._stand()
        self.bus.look(errors=errors)

    def _move(self, wanted: Mapping[int, float], seconds: float, limp: bool) -> None:
        if self.bus is None:
            raise BusError(f"{self._port} is not there.")
        if limp:
            self.bus.hold()
        self.bus.move(wanted, seconds)

    def _stand(self) -> None:
        self._stands = True
        if self.bus is not None:
            self.bus.stand()
            self._stands = False

    def _let_go(self) -> None:
        if self.bus is not None:
            self.bus.torque(on=False)

    def _hang_up(self) -> None:
        bus, self.bus = self.bus, None
        if bus is not None:
            bus.close()
