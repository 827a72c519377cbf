"""A microphone of somebody who speaks into a laptop, in a process of its own."""

from __future__ import annotations

import subprocess
from pathlib import Path
from time import monotonic
from typing import TYPE_CHECKING

from tangy_hw.audio.wav import RATE

if TYPE_CHECKING:
    from tests.support.terminal import Terminal

PIECE = 0.05  # s


class Laptop:
    """`tangy mic` in a process of its own, into which somebody speaks at the speed of speech."""

    def __init__(self, tangy: str, data: Path) -> None:
        self.process = subprocess.Popen(  # noqa: S603 - our own program
            [tangy, "mic", "--data", str(data)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
        )

    def say(self, terminal: Terminal, pcm: bytes) -> float:
        """Speak at the speed of speech, looking at the terminal; return when the sound began."""
        assert self.process.stdin is not None
        size = round(2 * RATE * PIECE)
        began = monotonic()
        for place in range(0, len(pcm), size):
            piece = pcm[place : place + size]
            over = began + (place + len(piece)) / 2 / RATE
            while (left := over - monotonic()) > 0:
                terminal.read(left)
            self.process.stdin.write(piece)  # as a microphone gives it: when it has been said
            self.process.stdin.flush()
        return began

    def end(self) -> None:
        self.process.kill()
        self.process.communicate()
