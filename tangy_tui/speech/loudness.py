"""The loudness of a voice above its room, and advice about it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Literal, TypeAlias

from tangy_hw.audio.meter import CLIPPED, QUIET, RAILS
from tangy_hw.audio.utterances import frame_levels

LOUD = 0.9  # quantile of the frames that defines the loudness of a voice or a room
CLEAR, FAIR = 20.0, 12.0  # dB of a voice above the room
LEAST = 0.33  # quantisation steps; the least possible loudness
SILENT = -99.0  # dB; digital silence is below that

SoundAdvice: TypeAlias = Literal[
    "turn down", "turn up", "room as loud", "room rather loud", "speak soon", "without a pause"
]
"""Advice about the sound: the microphone's level, the room, or the way of speaking."""


def loudness(pcm: bytes, share: float) -> float:
    """Return a quantile (`share`) of the loudness of a sound's frames, in dB below full scale."""
    import numpy as np

    frames = frame_levels(pcm)
    if not frames:
        return -100.0
    level = float(np.quantile(frames, share))
    return 20 * math.log10(max(level, LEAST) / 32_768)


def advice(room: float, voice: float, sounds: Sequence[bytes], perfect: bool) -> list[SoundAdvice]:
    """Return advice by the levels in dB; empty if the sound is good."""
    said: list[SoundAdvice] = []
    if sum(_cut_off(pcm) for pcm in sounds) > 1:
        said.append("turn down")
    elif voice < 20 * math.log10(QUIET / 32_768):
        said.append("turn up")
    if voice - room < FAIR:
        said.append("room as loud")
    elif voice - room < CLEAR and not perfect:
        said.append("room rather loud")
    if sum(not pcm for pcm in sounds) > 1:
        said.append("speak soon")
    if not said and not perfect:
        said.append("without a pause")
    return said


def _cut_off(pcm: bytes) -> bool:
    import numpy as np

    samples = np.frombuffer(pcm, "<i2").astype(np.int32)
    return int((abs(samples) >= RAILS).sum()) >= CLIPPED
