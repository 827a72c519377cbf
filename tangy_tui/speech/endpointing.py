"""Where speech begins and ends, by pocketsphinx's endpointer: for hands-free and recordings."""

from __future__ import annotations

from collections.abc import Iterator

from tangy_tui.speech.evidence import RATE

WINDOW = 0.3  # s, of which the share below has to be speech, or quiet
RATIO = 0.9
FEWEST = 4  # frames of speech, 0.12 s; less is a click
PAUSE = 0.5  # s; the window for recordings, in which nobody waits for an answer
LEAD = 0.1  # s before an utterance that its words so far are looked for in
MARGIN = 0.3  # s that are kept before an utterance, and of a recording after it as well


class Endpoints:
    """Finds an utterance in a stream of samples (16 kHz mono s16le); its window is in s."""

    def __init__(self, window: float = WINDOW) -> None:
        import pocketsphinx

        self._endpointer = pocketsphinx.Endpointer(
            window=window, ratio=RATIO, sample_rate=RATE, vad_mode=pocketsphinx.Vad.LOOSE
        )
        self._rest = b""
        self._window = window
        self.recent = bytearray()  # the end of what was taken: the utterance, or before one
        self.taken = 0
        """How many bytes of the stream it has looked at."""

    @property
    def speaking(self) -> bool:
        """Whether an utterance is going on."""
        return bool(self._endpointer.in_speech)

    @property
    def begin(self) -> float:
        """Where the utterance began, in s from the start of the stream."""
        return float(self._endpointer.speech_start)

    @property
    def end(self) -> float:
        """Where it ended, in s."""
        return float(self._endpointer.speech_end)

    def feed(self, pcm: bytes) -> Iterator[tuple[bool, bytes, bool]]:
        """Give the speech in these samples: whether it begins here, and whether it is over.

        It is given as it comes, with the quiet after it: where it ends is known a window later,
        and by then what must not wait has to be known.
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
        """Return the utterance that was found last, with what lies around it.

        Where nothing but words is left of a sound, the decoder is less sure of them.
        """
        return self._since(self.begin - MARGIN)

    def _since(self, seconds: float) -> bytes:
        """Return what was taken from a time on, in s from the start of the stream."""
        begin = 2 * round(max(0.0, seconds) * RATE)
        return bytes(self.recent[max(0, begin - (self.taken - len(self.recent))) :])


class Pauses:
    """Follows how long it has been quiet since somebody spoke."""

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
        """Take the next samples; return whether somebody speaks in them."""
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
    """Return where the utterances of a recording are, in s from its start."""
    endpoints = Endpoints(PAUSE)
    length = len(pcm) / 2 / RATE
    found: list[tuple[float, float]] = []
    for _, _, over in endpoints.feed(pcm):
        if over:
            found.append((endpoints.begin, endpoints.end))
    if endpoints.speaking:
        found.append((endpoints.begin, length))
    return [(max(0.0, begin - MARGIN), min(length, end + MARGIN)) for begin, end in found]
