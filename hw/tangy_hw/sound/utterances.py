"""Where a voice begins and ends in a stream of samples: utterances, cut at the pauses.

Samples are 16-bit little-endian, 16,000 a second, one channel.
"""

from __future__ import annotations

from collections import deque

from tangy_hw.sound.wav import RATE

FRAME = 320  # samples, 20 ms: the pieces that are called loud or quiet
LONGEST = 6.0  # s; a longer utterance is cut here, because babble never pauses
PAUSE = 0.5  # s of quiet that end an utterance
MARGIN = 0.2  # s of sound that are kept before and after it
SHORTEST = 0.12  # s of loud frames; less is a click

QUIETEST = 40.0  # of 32,768 (-58 dB); what is below is silence everywhere
LOUDER = 2.5  # a loud frame is 8 dB above the floor
FLOOR_SECONDS = 3.0  # the floor is the tenth percentile of that time


def split(pcm: bytes) -> list[bytes]:
    """Split a recording into its utterances; one that is all quiet has none."""
    splitter = Splitter(floor_of(pcm))
    return splitter.feed(pcm) + splitter.finish()


class Splitter:
    """Cuts a stream of samples into utterances at its pauses, by how loud it is.

    The floor is followed, so a steady hum is quiet. It starts at `floor` (root mean square of
    16-bit samples), until as much has been heard as it is taken from.
    """

    def __init__(self, floor: float = QUIETEST / LOUDER) -> None:
        self._levels: deque[float] = deque(maxlen=round(FLOOR_SECONDS * RATE / FRAME))
        self._levels.extend([floor] * (self._levels.maxlen or 1))
        self._rest = b""
        self._begin()

    def feed(self, pcm: bytes) -> list[bytes]:
        """Take samples and return the utterances that have ended in them."""
        pcm = self._rest + pcm
        whole = len(pcm) // (2 * FRAME) * (2 * FRAME)
        self._rest = pcm[whole:]
        ended: list[bytes] = []
        for place, level in enumerate(_levels(pcm[:whole])):
            frame = pcm[2 * FRAME * place : 2 * FRAME * (place + 1)]
            utterance = self._hear(frame, level)
            if utterance:
                ended.append(utterance)
        return ended

    def finish(self) -> list[bytes]:
        """Return the utterance that the end of the stream cuts off, if there is one."""
        utterance = self._end(max(0, self._quiet - round(MARGIN * RATE / FRAME)))
        self._rest = b""
        return [utterance] if utterance else []

    def _begin(self) -> None:
        self._before: deque[tuple[bytes, bool]] = deque(maxlen=round(MARGIN * RATE / FRAME) + 5)
        self._frames: list[bytes] = []
        self._loud = 0
        self._quiet = 0

    def _hear(self, frame: bytes, level: float) -> bytes:
        self._levels.append(level)
        floor = sorted(self._levels)[len(self._levels) // 10]
        loud = level > max(QUIETEST, LOUDER * floor)
        if not self._frames:
            self._before.append((frame, loud))
            recent = [was for _, was in self._before][-5:]
            if sum(recent) >= 3:
                self._frames = [kept for kept, _ in self._before]
                self._loud, self._quiet = sum(recent), 0
            return b""
        self._frames.append(frame)
        self._loud += loud
        self._quiet = 0 if loud else self._quiet + 1
        if self._quiet * FRAME >= PAUSE * RATE:
            return self._end(self._quiet - round(MARGIN * RATE / FRAME))
        return self._end(0) if len(self._frames) * FRAME >= LONGEST * RATE else b""

    def _end(self, drop: int) -> bytes:
        """Close the utterance, without its last `drop` frames of quiet."""
        frames = self._frames[: len(self._frames) - drop]
        enough = self._loud * FRAME >= SHORTEST * RATE
        self._begin()
        return b"".join(frames) if enough else b""


def _levels(pcm: bytes) -> list[float]:
    """Return the root mean square of every frame, its mean (a bias of the device) taken out."""
    import numpy as np

    frames = np.frombuffer(pcm, "<i2").reshape(-1, FRAME).astype(np.float64)
    levels: list[float] = frames.std(axis=1).tolist()
    return levels


def floor_of(pcm: bytes) -> float:
    """Guess how loud the pauses of a recording are: its quietest tenth, but far below its loudest.

    A recording without any loud and quiet in it is all hum: no voice is as even as that.
    """
    levels = sorted(_levels(pcm[: len(pcm) // (2 * FRAME) * (2 * FRAME)])) or [0.0]
    quiet, loudest = levels[len(levels) // 10], levels[-1]
    return max(1.0, quiet if quiet > loudest / 3 else min(quiet, loudest / 10))
