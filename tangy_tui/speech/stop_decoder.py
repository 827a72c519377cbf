"""Ears for stopping alone: every utterance goes through them, whatever else is listened for.

Two models of one decoder. The first knows how people stop a robot or a game and how they talk of
stopping other things, with everyday words between them: where its words stop the robot, it was a
stop. The second knows nothing but stops: where a word of stopping was heard, and a stop explains
the sound nearly as well as any other sentence does, it stops in doubt.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from tangy_tui.language.stop_sentence import stops
from tangy_tui.speech.language import dictionary, open_model, phrase_model, words_of
from tangy_tui.speech.pocketsphinx_search import NO_PATH, add_model, best_path, make_search

SHARE = 0.05  # of everyday words between those of stopping
DOUBT = 0.2  # by which a stop may explain the sound worse, in log P a frame
STARTS_DOUBT = frozenset(("stop", "halt", "freeze", "emergency", "don't", "still", "off", "robot"))
ACTIVE = 1500

Known = Mapping[str, Sequence[str]]


class StopDecoder:
    """Finds cries to stop. Its limits were set on the first half of `bench/stop_sayings.toml`."""

    def __init__(
        self,
        texts: Sequence[str],
        others: Sequence[str],
        everyday: Mapping[str, float],
        known: Known,
        game: Sequence[str] = (),
    ) -> None:
        """Make it; without any text that can be pronounced it finds nothing.

        Args:
            texts: ways to stop, common ones several times.
            others: sentences about stopping other things.
            everyday: the probabilities of everyday words.
            known: how words are pronounced.
            game: the words that the game is called by.
        """
        self._game = frozenset(game)
        texts, others = _sayable(texts, known), _sayable(others, known)
        self._search: Any = None
        if not texts:
            return
        words = words_of((*texts, *others)) | everyday.keys()
        self._search = make_search(
            dictionary({w: known[w] for w in words}), bestpath=True, active=ACTIVE
        )
        add_model(self._search, "all", open_model((*others, *texts), everyday, SHARE))
        add_model(self._search, "stops", phrase_model(texts))

    def hear(self, pcm: bytes) -> str:
        """Return the sentence that stops the robot, "" if an utterance was none."""
        if self._search is None:
            return ""
        words, score, _ = best_path(self._search, pcm, "all")
        if stops(words, self._game):
            return words
        if score <= NO_PATH or STARTS_DOUBT.isdisjoint(words.split()):
            return ""
        stop, likely, _ = best_path(self._search, pcm, "stops")
        return stop if likely >= score - DOUBT and stops(stop, self._game) else ""


def _sayable(texts: Sequence[str], known: Known) -> list[str]:
    return [text for text in texts if known.keys() >= set(text.split())]
