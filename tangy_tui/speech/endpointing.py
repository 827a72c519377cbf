"""Endpointing: where speech begins and ends, by pocketsphinx, for hands-free and recordings."""

from __future__ import annotations

from collections.abc import Iterator

from tangy_tui.speech.evidence import RATE

WINDOW = 0.3  # s, of which this share must be speech, or quiet
RATIO = 0.9
FEWEST = 4  # frames of speech, 0.12 s; less is a click
PAUSE = 0.5  # s; the window for recordings, where latency does not matter
LEAD = 0.1  # s before an utterance that partial decoding includes
MARGIN = 0.3  # s kept before an utterance, and in a recording after it too


class Endpoints:
    """Finds utterances in a stream of samples (16 kHz mono s16le); its window is in s."""

    def __init__(self, window: float = WINDOW) -> None:
        import pocketsphinx

        self._endpointer = pocketsphinx.Endpointer(
            window=window, ratio=RATIO, sample_rate=RATE, vad_mode=pocketsphinx.Vad.LOOSE
        )
        self._rest = b""
        self._window = window
        self.recent = bytearray()  # the latest samples, including the utterance
        self.taken = 0
        """The number of bytes processed."""

    @property
    def speaking(self) -> bool:
        """Whether an utterance is in progress."""
        return bool(self._endpointer.in_speech)

    @property
    def begin(self) -> float:
        """The start of the utterance, in s from the start of the stream."""
        return float(self._endpointer.speech_start)

    @property
    def end(self) -> float:
        """Its end, in s."""
        return float(self._endpointer.speech_end)

    def feed(self, pcm: bytes) -> Iterator[tuple[bool, bytes, bool]]:
        """Yield the speech in these samples: whether it begins, its samples, whether it is over.

        It is yielded at once, with the quiet after it: its end is only known a window later, which
        is too late for urgent words.
        """
        stream = self._rest + pcm
        size = self._endpointer.frame_bytes
        whole = len(stream) - len(stream) % size
        self._rest = stream[whole:]
        for place in range(0, whole, size):
            spoke = self._endpointer.in_speech
            frame = stream[place : place + size]
            speech = self._endpointer.process(frame)
            self.taken += size
            self.recent += frame
            if not spoke and not speech:
                del self.recent[: -2 * round((self._window + MARGIN) * RATE)]
            if speech:
                fresh = frame if spoke else self._since(self.begin - LEAD)
                yield not spoke, fresh, not self._endpointer.in_speech

    def finish(self) -> bytes:
        """End the stream; return the rest of an unfinished utterance."""
        speaking: bool = self._endpointer.in_speech
        self._endpointer.end_stream(self._rest or b"\0\0")
        rest, self._rest = self._rest, b""
        self.taken += len(rest)
        self.recent += rest
        return rest if speaking else b""

    def utterance(self) -> bytes:
        """Return the last utterance with some sound around it.

        Without it, the decoder is less certain of the words.
        """
        return self._since(self.begin - MARGIN)

    def _since(self, seconds: float) -> bytes:
        """Return the samples since a time, in s from the start of the stream."""
        begin = 2 * round(max(0.0, seconds) * RATE)
        return bytes(self.recent[max(0, begin - (self.taken - len(self.recent))) :])


class Pauses:
    """Measures how long it has been quiet since somebody spoke."""

    def __init__(self) -> None:
        import pocketsphinx

        self._vad = pocketsphinx.Vad(mode=pocketsphinx.Vad.MEDIUM_STRICT, sample_rate=RATE)
        self._rest = b""
        self._spoken = 0
        self._quiet = 0

    @property
    def after_speech(self) -> float:
        """Seconds of quiet since somebody spoke; 0 if nobody has."""
        return self._quiet * float(self._vad.frame_length) if self._spoken >= FEWEST else 0.0

    def feed(self, pcm: bytes) -> bool:
        """Process the next samples; return whether they contain speech."""
        self._rest += pcm
        size, spoke = self._vad.frame_bytes, False
        while len(self._rest) >= size:
            frame, self._rest = self._rest[:size], self._rest[size:]
            if self._vad.is_speech(frame):
                self._spoken, self._quiet, spoke = self._spoken + 1, 0, True
            else:
                self._quiet += 1
        return spoke


def pieces(pcm: bytes) -> list[tuple[float, float]]:
    """Return the start and end of each utterance in a recording, in s from its start."""
    endpoints = Endpoints(PAUSE)
    length = len(pcm) / 2 / RATE
    found: list[tuple[float, float]] = []
    for _, _, over in endpoints.feed(pcm):
        if over:
            found.append((endpoints.begin, endpoints.end))
    if endpoints.speaking:
        found.append((endpoints.begin, length))
    return [(max(0.0, begin - MARGIN), min(length, end + MARGIN)) for begin, end in found]
