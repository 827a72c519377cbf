"""Bus of Dynamixel X-series servos through Robotis' package; blocking, for one thread.

Addresses and units are those of the control table of the X series (XL330, XL430, XM, XH).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from functools import partial
from typing import Any

from tangy_hw.device_protocols import DeviceError

TICKS = 4096  # per turn
DRIVE_MODE, TORQUE, ERRORS = (10, 1), (64, 1), (70, 1)  # address, bytes
SPEED, GOAL, POSITION = (112, 4), (116, 4), (132, 4)
TIME_BASED = 4  # bit of the drive mode: a movement's speed is its duration in ms
SPEED_UNIT = 0.229 * 360 / 60  # degrees a second
FASTEST = 32_767  # in either unit; 0 would mean no limit
STAND_SECONDS = 0.05  # in which servos brake
LISTEN_SECONDS = 0.005  # read timeout; Robotis' own loop spins until bytes come
TRIES = 2  # of a read: a bit error on the wire is not a silent servo
MEANINGS = {
    0: "a wrong voltage",
    2: "overheating",
    3: "a fault of its encoder",
    4: "a fault of its electronics",
    5: "overload",
}


class BusError(Exception):
    """The bus cannot be opened, or does not answer; the message is a sentence."""


def meaning(bits: int) -> str:
    """Return the meaning of the bits of a hardware error."""
    names = [what for bit, what in MEANINGS.items() if bits >> bit & 1]
    return " and ".join(names) or f"error {bits}"


def speed(degrees: float, seconds: float, mode: int) -> int:
    """Return the speed value for a movement (degrees, s) in the unit of the servo's drive mode."""
    if mode & TIME_BASED:
        return max(1, min(round(1000 * seconds), FASTEST))
    return max(1, min(round(degrees / max(seconds, 0.02) / SPEED_UNIT), FASTEST))


class Bus:
    """Servos on a serial port. Angles are in degrees of the servo, by its id."""

    def __init__(self, port: str, baud: int, servos: Sequence[int]) -> None:
        """Open the port, and reboot servos with a hardware error, which only a reboot clears.

        Raises:
            BusError: the port is missing, or does not support the baud rate.
        """
        sdk = self.check()
        self._sdk, self._port_name = sdk, port
        self._servos = tuple(servos)
        self._modes: dict[int, int] = {}
        self.angles: dict[int, float] = {}
        """Angles of the servos that answered the last read."""
        self.errors: dict[int, int] = {}
        """Hardware error bits of each servo that answered."""
        self._packets = sdk.Protocol2PacketHandler()
        self._port = sdk.PortHandler(port)
        self._port.baudrate = baud
        try:
            if not self._port.setBaudRate(baud):
                raise BusError(f"{port} cannot have {baud} baud.")
            self._port.ser.timeout = LISTEN_SECONDS
        except OSError as error:
            raise BusError(f"{port} is not there: {error.strerror or error}") from None
        try:
            self.look(errors=True)
            for servo in [servo for servo, bits in self.errors.items() if bits]:
                self._asked(partial(self._packets.reboot, self._port, servo))
        except BusError:
            self.close()
            raise

    @staticmethod
    def check() -> Any:
        """Return Robotis' package.

        Raises:
            DeviceError: it is not installed.
        """
        try:
            import dynamixel_sdk  # type: ignore[import-untyped, unused-ignore]
        except ImportError:
            raise DeviceError(
                "Dynamixel arms need the extra: pip install tangy[dynamixel]"
            ) from None
        return dynamixel_sdk

    def close(self) -> None:
        """Close the port."""
        with suppress(Exception):  # a port that is gone cannot be closed
            self._port.closePort()

    def look(self, *, errors: bool) -> None:
        """Read the positions of all servos, and optionally their hardware errors.

        Raises:
            BusError: the port is gone.
        """
        ticks = self._read(POSITION)
        self.angles = {servo: _signed(value) * 360 / TICKS for servo, value in ticks.items()}
        if errors:
            self.errors = self._read(ERRORS)

    def hold(self) -> None:
        """Switch the torque of all servos on, at their current positions.

        Raises:
            BusError: the port is gone, or a servo does not answer.
        """
        here = self._read(POSITION)
        if missing := set(self._servos) - here.keys():
            raise BusError(f"servo {min(missing)} does not answer.")
        self._write(GOAL, {servo: value % (1 << 32) for servo, value in here.items()})
        self.torque(on=True)

    def stand(self) -> None:
        """Stop all servos that answer at their current positions, with their current torque.

        Raises:
            BusError: the port is gone.
        """
        here = self._read(POSITION)
        # A servo keeps the duration or speed of its movement, which would delay the stop.
        self._write(SPEED, {n: speed(0.0, STAND_SECONDS, self._modes.get(n, 0)) for n in here})
        self._write(GOAL, {servo: value % (1 << 32) for servo, value in here.items()})

    def torque(self, *, on: bool) -> None:
        """Switch the torque of all servos on or off, and verify it.

        Raises:
            BusError: the port is gone, or a servo that answers did not switch.
        """
        for _ in range(TRIES):
            self._write(TORQUE, dict.fromkeys(self._servos, int(on)))
            otherwise = [servo for servo, has in self._read(TORQUE).items() if bool(has) != on]
            if not otherwise:
                return
        raise BusError(f"servo {otherwise[0]} does not {'hold' if on else 'let go'}.")

    def move(self, goals: Mapping[int, float], seconds: float) -> None:
        """Move servos to angles in degrees, with a duration in s.

        Raises:
            BusError: the port is gone, or a servo does not answer.
        """
        if not self._modes.keys() >= goals.keys():
            self._modes = self._read(DRIVE_MODE)
        here = self._read(POSITION)
        if missing := goals.keys() - (self._modes.keys() & here.keys()):
            raise BusError(f"servo {min(missing)} does not answer.")
        speeds = {
            servo: speed(
                abs(goal - _signed(here[servo]) * 360 / TICKS), seconds, self._modes[servo]
            )
            for servo, goal in goals.items()
        }
        self._write(SPEED, speeds)
        self._write(GOAL, {servo: round(goal * TICKS / 360) for servo, goal in goals.items()})

    def _read(self, item: tuple[int, int]) -> dict[int, int]:
        """Read one item of all servos; servos that do not answer are missing in the result."""
        address, size = item
        group = self._sdk.GroupSyncRead(self._port, self._packets, address, size)
        for servo in self._servos:
            group.addParam(servo)
        for _ in range(TRIES):
            if self._asked(group.txRxPacket) == self._sdk.COMM_SUCCESS:
                return {servo: group.getData(servo, address, size) for servo in self._servos}
        # A silent servo spoils the answers of all after it, so read them one by one.
        read = {1: self._packets.read1ByteTxRx, 4: self._packets.read4ByteTxRx}[size]
        found: dict[int, int] = {}
        for servo in self._servos:
            value, result, _ = self._asked(partial(read, self._port, servo, address))
            if result == self._sdk.COMM_SUCCESS:
                found[servo] = value
        return found

    def _write(self, item: tuple[int, int], values: Mapping[int, int]) -> None:
        address, size = item
        group = self._sdk.GroupSyncWrite(self._port, self._packets, address, size)
        for servo, value in values.items():
            group.addParam(servo, list(value.to_bytes(size, "little")))
        if self._asked(group.txPacket) != self._sdk.COMM_SUCCESS:
            raise BusError(f"{self._port_name} takes nothing.")

    def _asked(self, asks: Any) -> Any:
        """Call something on the bus; any failure means that the port is gone."""
        try:
            return asks()
        except Exception as error:  # OSError, termios.error, or anything else from a lost port
            self._port.is_using = False
            raise BusError(f"{self._port_name} is gone: {error}") from None


def _signed(value: int) -> int:
    return value - (1 << 32) if value >= 1 << 31 else value
