"""pocketsphinx's searches: made of a dictionary and models, and asked for the likeliest path."""

from __future__ import annotations

import math
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from tangy_tui.speech.evidence import RATE

SHIFT = 1024  # pocketsphinx keeps scores shifted right by ten bits
FRAMES_A_SECOND = 100
NOISES = ("<", "[", "+", "(")  # how silences and noises begin among the words of a path
NO_PATH = -1e9  # the score where no path comes to an end


def make_search(words: str, *, bestpath: bool, active: int = 30_000) -> Any:
    """Make a decoder without any search in it yet.

    Args:
        words: its dictionary.
        bestpath: search the lattice once more in the end.
        active: how many models are followed at most; fewer are faster, and at some point wrong.
    """
    import pocketsphinx

    with tempfile.TemporaryDirectory(prefix="tangy-speech-") as folder:
        path = Path(folder) / "dict"
        path.write_text(words, encoding="utf-8")
        return pocketsphinx.Decoder(
            lm=None, dict=str(path), cmn="batch", loglevel="ERROR", bestpath=bestpath,
            maxhmmpf=active,
        )  # fmt: skip


def add_model(decoder: Any, name: str, arpa: str) -> None:
    """Give a decoder one more search, by an n-gram model in ARPA format."""
    with tempfile.TemporaryDirectory(prefix="tangy-speech-") as folder:
        path = Path(folder) / "lm"
        path.write_text(arpa, encoding="utf-8")
        decoder.add_lm_file(name, str(path))


def best_path(decoder: Any, pcm: bytes, search: str) -> tuple[str, float, float]:
    """Return the words of the likeliest path, and the two figures that grade it.

    They are log P(sound, words) a frame and the mean weighted log P(word | words before).
    """
    decoder.activate_search(search)
    decoder.reinit_feat()  # else what was heard before, and the words so far, change the scores
    decoder.start_utt()
    decoder.process_raw(pcm, full_utt=True)
    decoder.end_utt()
    best = decoder.hyp()
    if best is None:
        return "", NO_PATH, 0.0
    words = [_log(s.lscore) for s in decoder.seg() if not s.word.startswith(NOISES)]
    frames = len(pcm) / 2 / RATE * FRAMES_A_SECOND
    return str(best.hypstr), _log(best.score) / frames, sum(words) / max(1, len(words))


def next_best(decoder: Any, most: int) -> Iterator[str]:
    """Yield the likeliest sentences of what `best_path` has decoded last, best first."""
    for _, guess in zip(range(most), decoder.nbest() or (), strict=False):
        if guess is not None:  # as the search gives where it has no more
            yield str(guess.hypstr)


def _log(score: float) -> float:
    return math.log(max(score, 1e-300)) * SHIFT
