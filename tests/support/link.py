"""A slow link to a program in a pty: with delay, jitter, a rate, and a terminal at its far end."""

from __future__ import annotations

import heapq
import os
import random
from collections.abc import Callable
from dataclasses import dataclass
from itertools import count
from time import monotonic
from typing import Literal

import pyte

from tests.support.terminal import PATIENCE, Terminal

Answerer = Literal["far", "near", "nobody"]
"""The source of replies to the program's queries: the person's terminal, a multiplexer beside
the program, or nothing."""


@dataclass(frozen=True, slots=True)
class Link:
    """The properties of a link: delay and greatest jitter in s, rate in bytes per s."""

    delay: float = 0.0
    jitter: float = 0.0
    rate: float | None = None


class Answering(pyte.Screen):
    """A screen that reports its cursor's position."""

    def __init__(self, columns: int, lines: int, answer: Callable[[str], None]) -> None:
        self._answer = answer
        super().__init__(columns, lines)

    def write_process_input(self, data: str) -> None:
        """Send a reply."""
        self._answer(data)


class FarTerminal:
    """A person's terminal at the far end of a link."""

    def __init__(
        self, terminal: Terminal, link: Link, *, answerer: Answerer = "far", seed: int = 1
    ) -> None:
        self._terminal = terminal
        self._link = link
        self._random = random.Random(seed)
        self._number = count()
        self._moving: list[tuple[float, int, str, bytes]] = []
        self._free = {"out": 0.0, "in": 0.0}
        self._moved = 0
        self.arrived = b""
        """Everything that has arrived at the person's terminal."""
        columns, lines = 80, 24
        far, near = answerer == "far", answerer == "near"
        self._screen = Answering(columns, lines, self.type if far else lambda text: None)
        self._stream = pyte.ByteStream(self._screen)
        self._near = Answering(columns, lines, self._type_near if near else lambda text: None)
        self._near_stream = pyte.ByteStream(self._near)

    @property
    def text(self) -> str:
        """The text that the person can read."""
        return "\n".join(line.rstrip() for line in self._screen.display)

    def type(self, keys: str) -> None:
        """Send keys."""
        self._send("in", keys.encode())

    def _type_near(self, keys: str) -> None:
        self._terminal.type(keys)

    def _send(self, way: str, data: bytes) -> None:
        """Let data arrive after the link's delay, in the order of sending."""
        due = monotonic() + self._link.delay + self._random.random() * self._link.jitter
        due = max(due, self._free[way])
        if self._link.rate is not None:
            due += len(data) / self._link.rate
        self._free[way] = due
        heapq.heappush(self._moving, (due, next(self._number), way, data))

    def run(self, seconds: float = 0.01) -> None:
        """Transfer data for a while."""
        until = monotonic() + seconds
        while True:
            if chunk := self._terminal.read(0.002):
                self._near_stream.feed(chunk)
                for start in range(0, len(chunk), 256):
                    self._send("out", chunk[start : start + 256])
            while self._moving and self._moving[0][0] <= monotonic():
                _, _, way, data = heapq.heappop(self._moving)
                self._moved += 1
                if way == "out":
                    self.arrived += data
                    self._stream.feed(data)
                else:
                    os.write(self._terminal.parent, data)
            if monotonic() >= until:
                return

    def until(self, found: Callable[[], bool], seconds: float = PATIENCE) -> None:
        """Run until a condition is true."""
        deadline = monotonic() + seconds
        while not found():
            if monotonic() > deadline:
                raise AssertionError(f"never came; the screen shows:\n{self.text}")
            self.run()

    def rest(self) -> None:
        """Run until no data is on its way, there or back, and no more comes."""
        moved = -1
        while self._moving or moved != self._moved:
            moved = self._moved
            self.run(0.4)
