"""pocketsphinx searches: built from a dictionary and models, and queried for the best path."""

from __future__ import annotations

import math
import tempfile
from itertools import islice
from pathlib import Path
from typing import Any

from tangy_tui.speech.evidence import RATE

SHIFT = 1024  # pocketsphinx keeps scores shifted right by ten bits
FRAMES_A_SECOND = 100
NOISES = ("<", "[", "+", "(")  # prefixes of silences and noises among the words of a path
GUESSES = 20
SEGMENTATIONS = 200  # paths to search for them; many have the same words at other times
NO_PATH = -1e9  # score if no path is complete


def make_search(
    words: str, *, bestpath: bool, active: int = 30_000, means: bytes | None = None
) -> Any:
    """Create a decoder without any search.

    Args:
        words: its dictionary.
        bestpath: search the lattice again at the end.
        active: the beam, as the most active HMMs; fewer are faster, but less accurate.
        means: the file of the acoustic model's means, if they are not the usual ones.
    """
    import pocketsphinx

    with tempfile.TemporaryDirectory(prefix="tangy-speech-") as folder:
        path = Path(folder) / "dict"
        path.write_text(words, encoding="utf-8")
        moved = {}
        if means is not None:
            (Path(folder) / "means").write_bytes(means)
            moved["mean"] = str(Path(folder) / "means")
        return pocketsphinx.Decoder(
            lm=None, dict=str(path), cmn="batch", loglevel="ERROR", bestpath=bestpath,
            maxhmmpf=active, **moved,
        )  # fmt: skip


def add_model(decoder: Any, name: str, arpa: str) -> None:
    """Add a search to a decoder, with an n-gram model in ARPA format."""
    with tempfile.TemporaryDirectory(prefix="tangy-speech-") as folder:
        path = Path(folder) / "lm"
        path.write_text(arpa, encoding="utf-8")
        decoder.add_lm_file(name, str(path))


def best_path(decoder: Any, pcm: bytes, search: str) -> tuple[str, float, float]:
    """Return the words of the best path, and its two scores.

    They are log P(sound, words) per frame and the mean weighted log P(word | words before).
    """
    decoder.activate_search(search)
    decoder.reinit_feat()  # else earlier utterances and partial decoding change the scores
    decoder.start_utt()
    decoder.process_raw(pcm, full_utt=True)
    decoder.end_utt()
    best = decoder.hyp()
    if best is None:
        return "", NO_PATH, 0.0
    words = [_log(s.lscore) for s in decoder.seg() if not s.word.startswith(NOISES)]
    frames = len(pcm) / 2 / RATE * FRAMES_A_SECOND
    return str(best.hypstr), _log(best.score) / frames, sum(words) / max(1, len(words))


def likeliest(decoder: Any, pcm: bytes, search: str) -> tuple[tuple[str, ...], float]:
    """Return up to `GUESSES` sentences that may have been said, the best path's first.

    Its log P(sound, words) per frame comes after them.
    """
    words, score, _ = best_path(decoder, pcm, search)
    if not words:
        return (), score
    guesses = {words: None}
    for path in islice(decoder.nbest() or (), SEGMENTATIONS):
        if path is not None:  # None if the search has no more
            guesses[str(path.hypstr)] = None
        if len(guesses) == GUESSES:
            break
    return tuple(guesses), score


def _log(score: float) -> float:
    return math.log(max(score, 1e-300)) * SHIFT
