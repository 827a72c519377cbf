"""The speech decoder (III-A-1) in a process of its own: pocketsphinx holds the interpreter's lock.

An HMM acoustic model (the bundled en-us) labels phonemes and matches them to words; an n-gram
language model over the phrasebook determines their sequence. Run as
`python -m tangy_tui.learning.speech_worker`, spoken to by JSON, one object a line:

    {"id": 1, "phrases": ["go to the front", ...]}    builds the language model
    {"id": 1, "ready": true, "left_out": ["rosa"]}    words that the dictionary does not have; the
                                                      phrases with them cannot be heard
    {"id": 2, "pcm": "..."}                           base64 of 16 kHz mono s16le, at most 30 s
    {"id": 2, "text": "go to the front", "confidence": 0.98, "seconds": 1.4}
    {"id": 2, "error": "One sentence."}               instead of either answer

It ends when its input closes. What the C library prints goes to standard error.
"""

from __future__ import annotations

import base64
import binascii
import json
import math
import os
import sys
import tempfile
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import IO, Any

RATE = 16_000  # samples a second
LONGEST = 30  # s of sound that are decoded at once
SHORTEST = 0.1  # s; less cannot hold a word, and an empty buffer raises IndexError
DISCOUNT = 0.5  # probability mass that the n-grams leave for sequences no phrase has

# Confidence: a logistic over two figures of the best path, fitted by tests/bench/speech.py to the
# flite voices rms and awb, so that 0.5 parts right commands from other speech and from wrong ones.
# The figures are those of `Decoder.best_path`.
SCORE_MIDDLE, SCORE_WEIGHT = -2.79, 4.77
WORDS_MIDDLE, WORDS_WEIGHT = -17.9, 0.157
OFFSET = 5.23

SHIFT = 1024  # pocketsphinx keeps scores shifted right by ten bits
FRAMES_A_SECOND = 100
NOISES = ("<", "[", "+")  # how silences and noises begin among the words of a path


class Refused(Exception):
    """A request that cannot be answered; its text is the answer's error."""


class Decoder:
    """A pocketsphinx decoder for the words and word sequences of some phrases."""

    def __init__(self, phrases: Sequence[str]) -> None:
        import pocketsphinx

        pronounced = _pronunciations({word for phrase in phrases for word in phrase.split()})
        spoken = [p for p in phrases if p and all(word in pronounced for word in p.split())]
        self.left_out = sorted({w for p in phrases for w in p.split()} - set(pronounced))
        if not spoken:
            raise Refused("None of the phrases can be pronounced with the English dictionary.")
        with tempfile.TemporaryDirectory(prefix="tangy-speech-") as folder:
            model, words = Path(folder) / "lm", Path(folder) / "dict"
            with model.open("w", encoding="utf-8") as file:
                _write_language_model(spoken, file)
            words.write_text("".join(e for p in pronounced.values() for e in p), encoding="utf-8")
            self._decoder: Any = pocketsphinx.Decoder(
                lm=str(model), dict=str(words), cmn="batch", loglevel="ERROR"
            )

    def decode(self, pcm: bytes) -> tuple[str, float]:
        """Return the words of an utterance and how sure they are (0 to 1)."""
        text, score, words = self.best_path(pcm)
        return text, _confidence(score, words) if text else 0.0

    def best_path(self, pcm: bytes) -> tuple[str, float, float]:
        """Return the words of the likeliest path, and the two figures that grade it.

        They are log P(sound, words) a frame and the mean weighted log P(word | words before).
        """
        if len(pcm) < SHORTEST * RATE * 2:
            return "", 0.0, 0.0
        self._decoder.start_utt()
        self._decoder.process_raw(pcm, full_utt=True)
        self._decoder.end_utt()
        best = self._decoder.hyp()
        if best is None or not best.hypstr:
            return "", 0.0, 0.0
        words = [_log(s.lscore) for s in self._decoder.seg() if not s.word.startswith(NOISES)]
        frames = len(pcm) / 2 / RATE * FRAMES_A_SECOND
        return str(best.hypstr), _log(best.score) / frames, sum(words) / max(1, len(words))


def _log(score: float) -> float:
    return math.log(max(score, 1e-300)) * SHIFT


def _confidence(score: float, words: float) -> float:
    sure = OFFSET + SCORE_WEIGHT * (score - SCORE_MIDDLE) + WORDS_WEIGHT * (words - WORDS_MIDDLE)
    return 1 / (1 + math.exp(-max(-50.0, min(50.0, sure))))


def _pronunciations(words: Iterable[str]) -> dict[str, list[str]]:
    """Return the lines of the pronouncing dictionary for those words that it has."""
    import pocketsphinx

    wanted = set(words)
    found: dict[str, list[str]] = {}
    with Path(pocketsphinx.get_model_path("en-us/cmudict-en-us.dict")).open("rb") as dictionary:
        for line in dictionary:
            entry = line.decode("utf-8", "replace")
            word = entry.partition(" ")[0].partition("(")[0]
            if word in wanted:
                found.setdefault(word, []).append(entry)
    return found


def _write_language_model(phrases: Sequence[str], file: IO[str]) -> None:
    """Write a trigram model of the phrases in ARPA format."""
    from pocketsphinx.lm import ArpaBoLM

    model = ArpaBoLM(text="\n".join(phrases), add_start=True, discount_mass=DISCOUNT)
    model.compute()
    model.write(file)


class Worker:
    """Answers requests, one at a time."""

    def __init__(self) -> None:
        self._decoder: Decoder | None = None

    def answer(self, request: Any) -> dict[str, Any]:
        """Answer one request; what is wrong with it becomes the answer's error."""
        id = request.get("id") if isinstance(request, dict) else None
        try:
            return {"id": id, **self._answer(request)}
        except Refused as reason:
            return {"id": id, "error": str(reason)}
        except ImportError as error:
            return {"id": id, "error": f"Speech needs the package {error.name or 'pocketsphinx'}."}
        except (RuntimeError, ValueError, OSError) as error:
            said = " ".join(str(error).split())[:200]
            return {
                "id": id,
                "error": f"The speech decoder failed: {said or type(error).__name__}.",
            }

    def _answer(self, request: Any) -> dict[str, Any]:
        match request:
            case {"phrases": [*phrases]} if all(isinstance(phrase, str) for phrase in phrases):
                self._decoder = Decoder(phrases)
                return {"ready": True, "left_out": self._decoder.left_out}
            case {"pcm": str(encoded)}:
                return self._decode(encoded)
            case _:
                raise Refused("A request must hold phrases or pcm.")

    def _decode(self, encoded: str) -> dict[str, Any]:
        if self._decoder is None:
            raise Refused("The phrases must come before the sound.")
        try:
            pcm = base64.b64decode(encoded, validate=True)
        except binascii.Error:
            raise Refused("The sound is not base64.") from None
        if len(pcm) > LONGEST * RATE * 2:
            raise Refused(f"The sound is longer than {LONGEST} s.")
        text, confidence = self._decoder.decode(pcm[: len(pcm) // 2 * 2])
        seconds = len(pcm) / 2 / RATE
        return {"text": text, "confidence": round(confidence, 3), "seconds": round(seconds, 3)}


def main() -> None:
    """Answer requests until standard input closes."""
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)  # the C library prints on standard output; the protocol has its own copy of it
    worker = Worker()
    for line in sys.stdin.buffer:
        try:
            request = json.loads(line)
        except (ValueError, RecursionError):
            request = None
        try:
            print(json.dumps(worker.answer(request)), file=answers, flush=True)
        except BrokenPipeError:
            os._exit(0)  # nobody listens any more


if __name__ == "__main__":
    main()
