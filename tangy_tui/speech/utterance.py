"""The sound of one utterance on its way from the microphone to the decoder."""

from __future__ import annotations

import asyncio
from typing import Literal, TypeAlias

from tangy_tui.speech.evidence import RATE

LONGEST_TALK = 6.0  # s after which push-to-talk ends
MOST_TALK = LONGEST_TALK + 0.5  # s of wall-clock time: also if no more sound arrives
PIECE = 3_200  # bytes, 0.1 s: small chunks give early partial results
STALLED = 3.0  # s without any sound, after which a new utterance begins
QUIET = bytes(2 * RATE)  # 1 s, which ends an utterance
MOST_WAITING = 60  # s of a stream queued for the decoder


State: TypeAlias = Literal["starting", "off", "listening", "speaking", "thinking", "shut", "over"]
"""off: waiting for the key; listening: waiting for speech; speaking: speech is in progress."""


class _Chunks(asyncio.Queue[bytes]):
    """A queue of chunks that knows its size in bytes."""

    held = 0

    def _put(self, chunk: bytes) -> None:
        self.held += len(chunk)
        super()._put(chunk)

    def _get(self) -> bytes:
        chunk: bytes = super()._get()
        self.held -= len(chunk)
        return chunk


class Utterance:
    """The sound of an utterance, or a stream in which one is to be detected."""

    def __init__(self, *, found: bool, begun: bytes = b"") -> None:
        """Begin; `found`: detect its end in a stream, `begun`: the sound so far."""
        self.chunks = _Chunks()
        self.over = False
        self.dropped = False
        """Whether the result is ignored."""
        self._found = found
        self._came: float | None = None  # when the last chunk arrived
        self._left = round(LONGEST_TALK * RATE) * 2
        self.add(begun)

    def add(self, chunk: bytes, came: float | None = None) -> None:
        """Add a chunk. Push-to-talk ends at its limit; a stream drops its oldest chunks.

        Args:
            chunk: 16 kHz mono s16le.
            came: its arrival time, in s of any clock. A gap in a stream becomes quiet.
        """
        if self.over or not chunk:
            return
        if self._found:
            if came is not None and self._came is not None and came - self._came > STALLED:
                self.chunks.put_nowait(QUIET)
            self._came = came
            for place in range(0, len(chunk), PIECE):
                self.chunks.put_nowait(chunk[place : place + PIECE])
            while self.chunks.held > 2 * RATE * MOST_WAITING:
                self.chunks.get_nowait()
            return
        self.chunks.put_nowait(chunk[: self._left])
        self._left -= len(chunk)
        if self._left <= 0:
            self.end()

    def end(self, *, dropped: bool = False) -> None:
        """End the utterance."""
        self.dropped = self.dropped or dropped
        if not self.over:
            self.over = True
            self.chunks.put_nowait(b"")

    def rest(self) -> bytes:
        """Remove and return the chunks that were not decoded."""
        return b"".join(self.chunks.get_nowait() for _ in range(self.chunks.qsize()))
