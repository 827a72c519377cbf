"""A laptop's microphone with a speaker, in another process."""

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
    """`tangy mic` in another process, with sound at the speed of speech."""

    def __init__(self, tangy: str, data: Path) -> None:
        self.process = subprocess.Popen(  # noqa: S603 - our own program
            [tangy, "mic", "--data", str(data)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
        )

    def say(self, terminal: Terminal, pcm: bytes) -> float:
        """Send sound at the speed of speech, reading the terminal; return when the sound began."""
        assert self.process.stdin is not None
        size = round(2 * RATE * PIECE)
        began = monotonic()
        for place in range(0, len(pcm), size):
            piece = pcm[place : place + size]
            over = began + (place + len(piece)) / 2 / RATE
            while (left := over - monotonic()) > 0:
                terminal.read(left)
            self.process.stdin.write(piece)  # as from a microphone: after it was said
            self.process.stdin.flush()
        return began

    def end(self) -> None:
        self.process.kill()
        self.process.communicate()
