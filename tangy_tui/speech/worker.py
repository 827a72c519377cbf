"""The decoder's process: pocketsphinx holds the GIL, so it runs on its own.

Run as `python -m tangy_tui.speech.worker`, with one JSON object per line:

    {"id": 1, "wanted": {...}}                   the vocabulary (`evidence.DecoderVocabulary`)
    {"id": 1, "ready": true, "left_out": []}     words without a pronunciation
    {"id": 2, "begin": "commands"}               an utterance begins, or the answer to a question;
                                                 with "endpoint": true it is detected
    {"pcm": "..."}                               base64 of 16 kHz mono s16le, in pieces of any size
    {"id": 2, "speaking": true}                  a detected utterance has begun
    {"id": 2, "partial": "go to"}                the words so far, whenever they change
    {"id": 2, "end": true}                       its end; a detected one may end before
    {"id": 2, "heard": {...}, "used": 64000}     `AcousticEvidence`, and the bytes since "begin"
                                                 that are part of it or came before it
    {"id": 3, "pieces": "..."}                   base64 of a whole recording
    {"id": 3, "found": [[0.5, 1.7]]}             the start and end of its utterances, in s
    {"id": 4, "said": [["...", "go to"]]}        base64 of sentences that were read, and words
    {"id": 4, "voice": "usual ..."}              the voice (`voice_adaptation.voice_of`)
    {"id": 3, "error": "One sentence."}          instead of any answer

Sound between two utterances is ignored. The process ends when its input closes; what the C library
prints goes to standard error.
"""

from __future__ import annotations

import base64
import binascii
import logging
from collections.abc import Callable
from dataclasses import asdict
from typing import Any, get_args

from tangy_profiles import codec
from tangy_profiles.codec import InvalidValue
from tangy_profiles.process_log import log_to_stderr
from tangy_profiles.worker_lines import AnswerWriter, requests
from tangy_tui.language.stop_sentence import stops, stops_whatever_follows
from tangy_tui.speech.endpointing import Endpoints, Pauses, pieces
from tangy_tui.speech.evidence import LONGEST, RATE, AcousticEvidence, DecoderVocabulary, Expecting

_LOG = logging.getLogger("tangy_tui.speech.worker")  # __name__ is __main__ in the process

LARGEST_PIECE = 0.25  # s; larger chunks get no partial results
SILENCE = 8  # of 65,536: a smaller swing is silence, in which the decoder would find words
PAUSE = 0.2  # s of quiet after which the words so far are decoded, as usually nothing follows
STANDS = 0.5  # s for which urgent words must be stable if there is no quiet
CLEAR = 0.12  # s for which they must be stable if no further word can change the meaning


class RequestRefused(Exception):
    """An invalid request; its text is the answer's error."""


class Worker:
    """Handles requests, one at a time; `write` takes the answers."""

    def __init__(self, write: Callable[[dict[str, Any]], None]) -> None:
        self._write = write
        self.decoder: Any = None
        self._wanted: DecoderVocabulary | None = None
        self._id: Any = None
        self._expecting: Expecting = "commands"
        self._pcm = bytearray()
        self._endpoints: Endpoints | None = None
        self._pauses: Pauses | None = None
        self._foreseen: AcousticEvidence | None = None  # the result decoded in the current pause
        self._shown = ""
        self._stood = 0  # bytes since the words so far changed
        self.urgent: frozenset[str] = frozenset()

    def take(self, request: Any) -> None:
        """Handle one request; an error becomes its answer."""
        id = request.get("id") if isinstance(request, dict) else None
        if isinstance(request, dict) and "pcm" in request:
            id = self._id  # an error in the sound goes to the utterance's request
        try:
            self._take(id, request)
        except RequestRefused as reason:
            self._fail(id, str(reason))
        except ImportError as error:
            self._fail(id, f"Speech needs the package {error.name or 'pocketsphinx'}.")
        except (RuntimeError, ValueError, LookupError, OSError) as error:
            said = " ".join(str(error).split())[:200] or type(error).__name__
            self._fail(id, f"The speech decoder failed: {said}.")

    def _fail(self, id: Any, sentence: str) -> None:
        """Answer with an error, which ends the current utterance."""
        if id is not None and id == self._id:
            self._id = None
        self._write({"id": id, "error": sentence})

    def _take(self, id: Any, request: Any) -> None:
        match request:
            case {"wanted": dict(wanted)}:
                self._write({"id": id, "ready": True, "left_out": self._build(wanted)})
            case {"begin": str(expecting)} if expecting in get_args(Expecting):
                self._begin(id, expecting, endpoint=bool(request.get("endpoint")))
            case {"pcm": str(encoded)}:
                self._hear(_sound(encoded))
            case {"end": True}:
                if id == self._id:
                    if self._endpoints is not None:
                        self._add(self._endpoints.finish(), shows=True)
                    self._end()
            case {"pieces": str(encoded)}:
                found = [(round(begin, 3), round(end, 3)) for begin, end in pieces(_sound(encoded))]
                self._write({"id": id, "found": found})
            case {"said": list(said)}:
                self._write({"id": id, "voice": self._voice(said)})
            case _:
                raise RequestRefused("A request must hold wanted, begin, pcm, end, pieces or said.")

    def _build(self, wanted: dict[str, Any]) -> list[str]:
        from tangy_tui.speech.decoder import NoPronunciation, make_decoder

        try:
            read = codec.decode(DecoderVocabulary, wanted)
            if self.decoder is not None:
                self.decoder.close()
            self.decoder = make_decoder(read)
        except NoPronunciation as reason:
            raise RequestRefused(str(reason)) from None
        except InvalidValue as why:
            raise RequestRefused(f"What is wanted cannot be read: it {why}.") from None
        self._wanted = read
        self.urgent = frozenset(read.urgent)
        return list(self.decoder.left_out)

    def _voice(self, said: list[Any]) -> str:
        from tangy_tui.speech.decoder import spelt
        from tangy_tui.speech.voice_adaptation import KnownSound, voice_of

        if self._wanted is None:
            raise RequestRefused("The phrases must come before the sound.")
        known = [KnownSound(_sound(str(pcm)), str(text)) for pcm, text in said]
        return voice_of(known, spelt([one.text for one in known], self._wanted.pronunciations))

    def _begin(self, id: Any, expecting: Any, *, endpoint: bool) -> None:
        if self.decoder is None:
            raise RequestRefused("The phrases must come before the sound.")
        self._id, self._expecting, self._shown, self._stood = id, expecting, "", 0
        self._pcm.clear()
        self._endpoints = Endpoints() if endpoint else None
        self._pauses = Pauses()
        self._foreseen = None
        if not endpoint:
            self.decoder.begin(expecting)

    def _hear(self, sound: bytes) -> None:
        if self._id is None:
            return  # no utterance is in progress
        if self._endpoints is None:
            self._follow(sound)
            return
        for began, speech, over in self._endpoints.feed(sound):
            if began:
                self.decoder.begin(self._expecting)
                self._write({"id": self._id, "speaking": True})
            self._follow(speech)
            if self._id is not None and (over or len(self._pcm) >= 2 * RATE * LONGEST):
                self._end()
            if self._id is None:
                return

    def _follow(self, sound: bytes) -> None:
        """Process the next chunk of an utterance, and end it if its words so far are urgent."""
        assert self._pauses is not None  # noqa: S101 - an utterance has begun
        shows = self._endpoints is not None or len(sound) <= 2 * RATE * LARGEST_PIECE
        spoke = self._pauses.feed(sound)
        self._add(sound, shows=shows)
        if self._stands_alone(self._pauses.after_speech):
            self._end(self._so_far())
        elif shows:
            self._foresee(self._pauses.after_speech, spoke=spoke)

    def _add(self, sound: bytes, *, shows: bool) -> None:
        if len(self._pcm) + len(sound) > 2 * RATE * LONGEST and self._endpoints is None:
            sound = sound[: max(0, 2 * RATE * LONGEST - len(self._pcm))]
        if not sound:
            return
        self._pcm += sound
        if shows and self._foreseen is None:
            words = self.decoder.partial(sound)
            self._stood += len(sound)
            if words != self._shown:
                self._shown, self._stood = words, 0
                self._write({"id": self._id, "partial": words})

    def _stands_alone(self, quiet: float) -> bool:
        """Return whether the words so far are urgent and have been stable for a while."""
        if self._stood < 2 * RATE * CLEAR or not self._is_urgent(self._shown):
            return False
        waits = quiet < PAUSE and not stops_whatever_follows(self._shown)
        return not waits or self._stood >= 2 * RATE * STANDS

    def _is_urgent(self, words: str) -> bool:
        return words in self.urgent or (bool(self.urgent) and stops(words))

    def _so_far(self) -> AcousticEvidence:
        """Return the partial words without a second pass, for urgent commands."""
        return AcousticEvidence(self._shown, "", 0.0, 1.0, len(self._pcm) / 2 / RATE)

    def _foresee(self, quiet: float, *, spoke: bool) -> None:
        """Decode in a pause, so that the result is ready when the utterance ends."""
        if self._foreseen is None and quiet >= PAUSE:
            self._foreseen = self._decode(self._said())
            if self._foreseen.stop or self._is_urgent(self._foreseen.words):
                self._end()
        elif self._foreseen is not None and spoke:
            self._foreseen = None
            self.decoder.begin(self._expecting)
            self.decoder.partial(bytes(self._pcm))

    def _decode(self, pcm: bytes) -> AcousticEvidence:
        if not _sounds(pcm):
            return AcousticEvidence(seconds=len(pcm) / 2 / RATE)
        evidence: AcousticEvidence = self.decoder.decode(pcm, self._expecting)
        return evidence

    def _said(self) -> bytes:
        """Return the utterance, with the sound around it if it was detected."""
        return self._endpoints.utterance() if self._endpoints and self._pcm else bytes(self._pcm)

    def _end(self, heard: AcousticEvidence | None = None) -> None:
        id, used = self._id, len(self._pcm)
        if self._endpoints is not None:
            used = self._endpoints.taken
        heard = heard or self._foreseen or self._decode(self._said())
        self._id = None
        self._pcm.clear()
        self._write({"id": id, "heard": asdict(heard), "used": used})


def _sounds(pcm: bytes) -> bool:
    """Return whether there is more than the silence of a muted microphone."""
    samples = memoryview(pcm).cast("h")
    return len(samples) > 0 and max(samples) - min(samples) > SILENCE


def _sound(encoded: str) -> bytes:
    try:
        pcm = base64.b64decode(encoded, validate=True)
    except binascii.Error:
        raise RequestRefused("The sound is not base64.") from None
    return pcm[: len(pcm) // 2 * 2]


def main() -> None:
    """Handle requests until standard input closes."""
    log_to_stderr()
    _LOG.info("the speech worker begins")
    answers = AnswerWriter()
    worker = Worker(answers.write)
    for request in requests(lambda why: answers.write({"id": None, "error": why})):
        worker.take(request)


if __name__ == "__main__":
    main()
