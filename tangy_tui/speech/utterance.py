"""The sound of one utterance on its way from the microphone to the decoder."""

from __future__ import annotations

import asyncio
from typing import Literal, TypeAlias

from tangy_tui.speech.evidence import RATE

LONGEST_TALK = 6.0  # s after which push-to-talk ends by itself
MOST_TALK = LONGEST_TALK + 0.5  # s, by the clock: also where no more sound comes
PIECE = 3_200  # bytes, 0.1 s: words are shown as they come if they come in pieces
STALLED = 3.0  # s without any sound, after which what comes continues nothing
QUIET = bytes(2 * RATE)  # 1 s: with it an utterance is over
MOST_WAITING = 60  # s of a stream that wait for the decoder


State: TypeAlias = Literal["starting", "off", "listening", "speaking", "thinking", "shut", "over"]
"""off: waiting for the key; listening: for an utterance to begin; speaking: somebody speaks."""


class _Chunks(asyncio.Queue[bytes]):
    """Chunks that wait to be heard, and how many bytes they are."""

    held = 0

    def _put(self, chunk: bytes) -> None:
        self.held += len(chunk)
        super()._put(chunk)

    def _get(self) -> bytes:
        chunk: bytes = super()._get()
        self.held -= len(chunk)
        return chunk


class Utterance:
    """The sound of an utterance as it comes, or of a stream in which one is to be found."""

    def __init__(self, *, found: bool, begun: bytes = b"") -> None:
        """Begin; `found` says that its end is to be found, `begun` is what is there already."""
        self.chunks = _Chunks()
        self.over = False
        self.dropped = False
        """It counts for nothing."""
        self._found = found
        self._came: float | None = None  # when the last chunk came
        self._left = round(LONGEST_TALK * RATE) * 2
        self.add(begun)

    def add(self, chunk: bytes, came: float | None = None) -> None:
        """Take the next chunk. Push-to-talk ends in time; of a stream the oldest is forgotten.

        Args:
            chunk: 16 kHz mono s16le.
            came: when it came, in s by any clock. A stream that has stalled is parted by quiet.
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
        """Take no more of it."""
        self.dropped = self.dropped or dropped
        if not self.over:
            self.over = True
            self.chunks.put_nowait(b"")

    def rest(self) -> bytes:
        """Take out what nobody has heard yet."""
        return b"".join(self.chunks.get_nowait() for _ in range(self.chunks.qsize()))
