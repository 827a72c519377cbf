"""Where speech begins and ends, by pocketsphinx's endpointer: for hands-free and recordings."""

from __future__ import annotations

from collections.abc import Iterator

from tangy_tui.learning.speech.evidence import RATE

WINDOW = 0.3  # s, of which the share below has to be speech, or quiet
RATIO = 0.9
PAUSE = 0.5  # s; the window for recordings, in which nobody waits for an answer
MARGIN = 0.2  # s of a recording that are kept before and after an utterance


class Endpoints:
    """Finds an utterance in a stream of samples (16 kHz mono s16le)."""

    def __init__(self, window: float = WINDOW) -> None:
        import pocketsphinx

        self._endpointer = pocketsphinx.Endpointer(
            window=window, ratio=RATIO, sample_rate=RATE, vad_mode=pocketsphinx.Vad.LOOSE
        )
        self._rest = b""

    @property
    def begin(self) -> float:
        """Where the utterance began, in s from the start of the stream."""
        return float(self._endpointer.speech_start)

    @property
    def end(self) -> float:
        """Where it ended."""
        return float(self._endpointer.speech_end)

    def feed(self, pcm: bytes) -> Iterator[tuple[bool, bytes, bool]]:
        """Give the speech in these samples: whether it begins here, and whether it is over."""
        self._rest += pcm
        size = self._endpointer.frame_bytes
        while len(self._rest) >= size:
            frame, self._rest = self._rest[:size], self._rest[size:]
            spoke = self._endpointer.in_speech
            speech = self._endpointer.process(frame)
            if speech:
                yield not spoke, bytes(speech), not self._endpointer.in_speech

    def finish(self) -> bool:
        """End the stream; return whether an utterance was still going on."""
        speaking: bool = self._endpointer.in_speech
        self._endpointer.end_stream(self._rest or b"\0\0")
        return speaking


def pieces(pcm: bytes) -> list[tuple[float, float]]:
    """Return where the utterances of a recording are, in s from its start."""
    endpoints = Endpoints(PAUSE)
    length = len(pcm) / 2 / RATE
    found: list[tuple[float, float]] = []
    for _, _, over in endpoints.feed(pcm):
        if over:
            found.append((endpoints.begin, endpoints.end))
    if endpoints.finish():
        found.append((endpoints.begin, length))
    return [(max(0.0, begin - MARGIN), min(length, end + MARGIN)) for begin, end in found]
