"""A bus of servos for tests: protocol 2.0 of Dynamixel on a pseudo-terminal.

Servos have the control table of the X series. With torque, they reach their goal at once.
"""

from __future__ import annotations

import os
import pty
import threading
import tty
from dataclasses import dataclass, field
from select import select
from struct import pack_into, unpack_from

HEADER = b"\xff\xff\xfd\x00"
PING, READ, WRITE, REBOOT, STATUS, SYNC_READ, SYNC_WRITE = 1, 2, 3, 8, 0x55, 0x82, 0x83
ALERT = 0x80


def checksum(data: bytes) -> int:
    """Return the CRC-16 of a packet: polynomial 0x8005, initial value 0."""
    register = 0
    for byte in data:
        register ^= byte << 8
        for _ in range(8):
            register = (register << 1) ^ (0x8005 if register & 0x8000 else 0)
            register &= 0xFFFF
    return register


@dataclass
class Servo:
    """One servo: its memory, whether it is there, stuck, or has a lasting fault."""

    memory: bytearray = field(default_factory=lambda: bytearray(256))
    there: bool = True
    sticks: bool = False
    restarts: int = 0

    @property
    def position(self) -> int:
        return int(unpack_from("<i", self.memory, 132)[0])

    @position.setter
    def position(self, ticks: int) -> None:
        pack_into("<i", self.memory, 132, ticks)

    @property
    def goal(self) -> int:
        return int(unpack_from("<i", self.memory, 116)[0])

    @property
    def speed(self) -> int:
        return int(unpack_from("<I", self.memory, 112)[0])

    @property
    def torque(self) -> bool:
        return bool(self.memory[64])

    @property
    def error(self) -> int:
        return self.memory[70]

    @error.setter
    def error(self, bits: int) -> None:
        self.memory[70] = bits
        self.memory[64] = 0  # a servo with an error turns its torque off

    def write(self, address: int, data: bytes) -> None:
        self.memory[address : address + len(data)] = data
        if self.error:
            self.memory[64] = 0
        if self.torque and not self.sticks and address == 116:
            self.position = self.goal


class ServoBus:
    """Servos by their id, on the port `path`."""

    def __init__(self, *ids: int) -> None:
        self.servos = {number: Servo() for number in ids}
        for servo in self.servos.values():
            servo.position = 2048
        self._master, self._slave = pty.openpty()
        tty.setraw(self._slave)
        self.path = os.ttyname(self._slave)
        self._rest = b""
        self._unplugged, self._unplug = os.pipe()
        self._thread = threading.Thread(target=self._serve, daemon=True)

    def __enter__(self) -> ServoBus:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.unplug()

    def unplug(self) -> None:
        """Remove the port."""
        if self._thread.is_alive():
            os.write(self._unplug, b".")
            self._thread.join()
            for one in (self._master, self._slave, self._unplug, self._unplugged):
                os.close(one)

    def _serve(self) -> None:
        """Answer on a separate thread: a bus waits for nobody's event loop."""
        while self._unplugged not in (ready := select([self._master, self._unplugged], [], [])[0]):
            if ready:
                self._hear(os.read(self._master, 4096))

    def _hear(self, data: bytes) -> None:
        self._rest += data
        while (start := self._rest.find(HEADER)) >= 0:
            packet = self._rest[start:]
            if len(packet) < 7 or len(packet) < 7 + (size := int.from_bytes(packet[5:7], "little")):
                return
            packet, self._rest = packet[: 7 + size], packet[7 + size :]
            if checksum(packet[:-2]) == int.from_bytes(packet[-2:], "little"):
                body = packet[7:-2].replace(b"\xff\xff\xfd\xfd", b"\xff\xff\xfd")
                self._do(packet[4], body[0], body[1:])

    def _do(self, number: int, what: int, body: bytes) -> None:
        servo = self.servos.get(number)
        if what == SYNC_READ:
            address, size = unpack_from("<HH", body)
            for one in body[4:]:
                if not self.servos[one].there:
                    continue
                self._answer(one, bytes(self.servos[one].memory[address : address + size]))
        elif what == SYNC_WRITE:
            address, size = unpack_from("<HH", body)
            for place in range(4, len(body), 1 + size):
                told = self.servos[body[place]]
                if told.there:
                    told.write(address, body[place + 1 : place + 1 + size])
        elif servo is None or not servo.there:
            return
        elif what == READ:
            address, size = unpack_from("<HH", body)
            self._answer(number, bytes(servo.memory[address : address + size]))
        elif what == WRITE:
            servo.write(unpack_from("<H", body)[0], body[2:])
            self._answer(number)
        elif what == REBOOT:
            servo.restarts += 1
            servo.error = 0
            self._answer(number)
        elif what == PING:
            self._answer(number, b"\x06\x04\x2d")

    def _answer(self, number: int, data: bytes = b"") -> None:
        error = ALERT if self.servos[number].error else 0
        body = bytes((STATUS, error)) + data
        body = body.replace(b"\xff\xff\xfd", b"\xff\xff\xfd\xfd")
        packet = HEADER + bytes((number,)) + (len(body) + 2).to_bytes(2, "little") + body
        os.write(self._master, packet + checksum(packet).to_bytes(2, "little"))
