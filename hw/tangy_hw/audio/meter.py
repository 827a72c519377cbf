"""Measures loudness, and names problems: no sound, too loud, too quiet."""

from __future__ import annotations

import math
import sys
import time
from array import array
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from operator import mul
from typing import Literal, TypeAlias

from tangy_hw.audio.wav import RATE

FLOOR = -60.0  # dB below full scale at which the bar is empty
FALL = 1.5  # bar lengths per second by which it falls; it rises at once
PIECE = RATE // 50  # samples, 20 ms: the bar shows the loudest piece

RAILS = 32_700  # of 32,768; larger samples are clipped, or nearly
CLIPPED = 4  # number of them in half a second that is too many
CLIPPED_SECONDS = 0.5

NO_SOUND = 2.0  # root mean square of 16-bit samples; a working microphone has more noise
NO_SOUND_SECONDS = 2.0
QUIET = 150.0  # level that the loudest 20 ms of a voice exceed (-47 dB)
QUIET_SECONDS = 2.0
MEMORY_SECONDS = 3.0  # for which the loudest level is remembered

SoundFault: TypeAlias = Literal["nothing comes", "no sound", "too loud", "very quiet"]
"""Fault of a sound: no data arrive, only silence arrives, it is clipped, or it is faint."""


@dataclass(frozen=True, slots=True)
class SoundTrouble:
    """A fault of a sound, and its duration in whole s (0: it has just begun)."""

    kind: SoundFault
    seconds: int = 0


class Meter:
    """A level meter: a bar from 0 to 1, and the problem with the sound.

    Call `feed` with every chunk of a live source on arrival; pauses between chunks count. Call
    `begin` at the start of an utterance.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        """Start to measure.

        Args:
            clock: returns a time in s.
        """
        self._clock = clock
        self.begin()

    def begin(self) -> None:
        """Reset: an utterance starts now."""
        now = self._clock()
        self._began = self._data_at = self._sound_at = now
        self._shown, self._shown_at = 0.0, now
        self._clipped: deque[tuple[float, int]] = deque()
        self._loudest: deque[tuple[float, float]] = deque()

    def feed(self, chunk: bytes) -> None:
        """Add the next samples (16-bit little-endian, one channel)."""
        samples = array("h", chunk[: len(chunk) // 2 * 2][-RATE:])  # at most the last .5 s
        if not samples:
            return
        if sys.byteorder == "big":
            samples.byteswap()
        now = self._clock()
        self._data_at = now
        loudness = max(
            _loudness(samples[place : place + PIECE]) for place in range(0, len(samples), PIECE)
        )
        if loudness >= NO_SOUND:
            self._sound_at = now
        self._shown, self._shown_at = max(self.level, _bar(loudness)), now
        self._loudest.append((now, loudness))
        _forget(self._loudest, now - MEMORY_SECONDS)
        if max(samples) >= RAILS or min(samples) <= -RAILS:
            self._clipped.append((now, sum(abs(sample) >= RAILS for sample in samples)))

    @property
    def level(self) -> float:
        """Current loudness on a dB scale: 0 is silence, 1 full scale."""
        return max(0.0, self._shown - FALL * (self._clock() - self._shown_at))

    def loudest(self, seconds: float) -> float:
        """Return the maximum loudness of the last s (at most 3), from 0 to 1."""
        since = self._clock() - seconds
        return _bar(max((loudness for at, loudness in self._loudest if at >= since), default=0.0))

    @property
    def clipping(self) -> bool:
        """Whether the last half second was clipped."""
        _forget(self._clipped, self._clock() - CLIPPED_SECONDS)
        return sum(count for _, count in self._clipped) >= CLIPPED

    @property
    def seconds_since_data(self) -> float:
        """Seconds since the last data, even silence."""
        return self._clock() - self._data_at

    @property
    def seconds_since_sound(self) -> float:
        """Seconds since the last sound above the noise of a muted microphone."""
        return self._clock() - self._sound_at

    def trouble(self, *, speaking: bool = True) -> SoundTrouble | None:
        """Return the current problem, if there is one.

        Args:
            speaking: whether somebody should be speaking; only then is quiet a problem.
        """
        if self.seconds_since_data >= NO_SOUND_SECONDS:
            return SoundTrouble("nothing comes", int(self.seconds_since_data))
        if self.seconds_since_sound >= NO_SOUND_SECONDS:
            return SoundTrouble("no sound", int(self.seconds_since_sound))
        if self.clipping:
            return SoundTrouble("too loud")
        if speaking and self._quiet():
            return SoundTrouble("very quiet")
        return None

    def _quiet(self) -> bool:
        if self._clock() - self._began < QUIET_SECONDS:
            return False
        return max((loudness for _, loudness in self._loudest), default=0.0) < QUIET


def _loudness(samples: array[int]) -> float:
    """Return the root mean square without the mean (the device's offset)."""
    count = len(samples)
    mean = sum(samples) / count
    return math.sqrt(max(0.0, sum(map(mul, samples, samples)) / count - mean * mean))


def _bar(loudness: float) -> float:
    if loudness <= 0:
        return 0.0
    return min(1.0, max(0.0, 1 - 20 * math.log10(loudness * math.sqrt(2) / 32_768) / FLOOR))


def _forget(kept: deque[tuple[float, float]] | deque[tuple[float, int]], before: float) -> None:
    while kept and kept[0][0] < before:
        kept.popleft()
