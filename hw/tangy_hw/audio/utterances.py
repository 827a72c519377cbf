"""Splits a recording into utterances at its pauses, by loudness.

Samples are 16-bit little-endian, 16,000 a second, one channel.
"""

from __future__ import annotations

from collections import deque

from tangy_hw.audio.wav import RATE

FRAME = 320  # samples, 20 ms: unit of the loudness decision
LONGEST = 6.0  # s; a longer utterance is cut here, because babble has no pauses
PAUSE = 0.5  # s of quiet that end an utterance
MARGIN = 0.2  # s of sound kept before and after it
SHORTEST = 0.12  # s of loud frames; less is a click
AFTER = round(MARGIN * RATE / FRAME)  # frames
BEFORE = AFTER + 5  # the last five decide that it has begun

QUIETEST = 40.0  # of 32,768 (-58 dB); anything below is silence in every room
LOUDER = 2.5  # a loud frame is 8 dB above the floor
FLOOR_SECONDS = 3.0  # the floor is the tenth percentile of this window


def split(pcm: bytes) -> list[bytes]:
    """Split a recording into its utterances by loudness; quiet recordings have none.

    The noise floor is tracked, so a steady hum is quiet, and so are people who talk further away,
    which a voice activity detector would join to one endless utterance.
    """
    levels = deque[float](maxlen=round(FLOOR_SECONDS * RATE / FRAME))
    levels.extend([_floor_of(pcm)] * (levels.maxlen or 1))
    found: list[bytes] = []
    begin, loud, quiet = -1, 0, 0  # start of an utterance; its loud and trailing quiet frames
    recent: deque[bool] = deque(maxlen=BEFORE)
    place = 0
    for place, level in enumerate(frame_levels(pcm), 1):
        levels.append(level)
        is_loud = level > max(QUIETEST, LOUDER * sorted(levels)[len(levels) // 10])
        if begin < 0:
            recent.append(is_loud)
            loud = sum([*recent][-5:])
            if loud >= 3:
                begin, quiet = place - len(recent), 0
            continue
        loud += is_loud
        quiet = 0 if is_loud else quiet + 1
        if quiet * FRAME >= PAUSE * RATE or (place - begin) * FRAME >= LONGEST * RATE:
            found += _utterance(pcm, begin, place, loud, quiet)
            begin = -1
            recent.clear()
    return found + (_utterance(pcm, begin, place, loud, quiet) if begin >= 0 else [])


def _utterance(pcm: bytes, begin: int, end: int, loud: int, quiet: int) -> list[bytes]:
    """Return an utterance between two frames, without most of its trailing quiet; drop clicks."""
    end -= max(0, quiet - AFTER)
    return [pcm[2 * FRAME * begin : 2 * FRAME * end]] if loud * FRAME >= SHORTEST * RATE else []


def frame_levels(pcm: bytes) -> list[float]:
    """Return the root mean square of each frame (20 ms), 0 to 32,768.

    The mean, which is the device's offset, is left out.
    """
    import numpy as np

    whole = len(pcm) // (2 * FRAME) * (2 * FRAME)
    frames = np.frombuffer(pcm[:whole], "<i2").reshape(-1, FRAME).astype(np.float64)
    levels: list[float] = frames.std(axis=1).tolist()
    return levels


def _floor_of(pcm: bytes) -> float:
    """Estimate the noise floor of a recording: its quietest tenth, but far below its loudest frame.

    A recording of even loudness is all hum: no voice is that even.
    """
    levels = sorted(frame_levels(pcm)) or [0.0]
    quiet, loudest = levels[len(levels) // 10], levels[-1]
    return max(1.0, quiet if quiet > loudest / 3 else min(quiet, loudest / 10))
