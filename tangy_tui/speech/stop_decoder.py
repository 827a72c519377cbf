"""Ears for stopping alone: every utterance goes through them, whatever else is listened for.

One n-gram model knows how people stop a robot or a game and how they talk of stopping other things,
with everyday words between them. Where its likeliest words stop the robot, it was a stop for sure.
Where only one of the next likely sentences does, it may have been one: a synthetic or foreign voice
is often heard as "tell the robot" before it is heard as "stop the robot".
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import islice
from typing import Any, NamedTuple

from tangy_tui.language.stop_sentence import ends_in_stop, stops
from tangy_tui.speech.language import dictionary, open_model, words_of
from tangy_tui.speech.noise_reduction import cleared
from tangy_tui.speech.pocketsphinx_search import add_model, best_path, make_search, next_best

SHARE = 0.05  # of everyday words between those of stopping
DOUBTED = 5  # different sentences, the likeliest ones, of which one may be a stop
SEGMENTATIONS = 60  # of the likeliest paths that are looked through for them
ACTIVE = 1500
ACCENTS = {
    "stop": ("S T AO P", "S T AH P"),
    "stopped": ("S T AO P T",),
    "robot": ("R OW B AO T", "R OW B AH T"),
}
"""How British and other voices say what the American dictionary has in one way alone."""

Known = Mapping[str, Sequence[str]]


class HeardStop(NamedTuple):
    """The sentence that stops the robot, "" if there was none, and whether it is beyond doubt."""

    sentence: str = ""
    sure: bool = False


class StopDecoder:
    """Finds cries to stop. Its limits were set on sets of `stop_sentences.toml`."""

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
        said = {word: (*known[word], *ACCENTS.get(word, ())) for word in words}
        self._search = make_search(dictionary(said), bestpath=True, active=ACTIVE)
        add_model(self._search, "all", open_model((*others, *texts), everyday, SHARE))

    def hear(self, pcm: bytes) -> HeardStop:
        """Return the sentence of an utterance (16 kHz mono s16le) that stops the robot."""
        if self._search is None:
            return HeardStop()
        words, _, _ = best_path(self._search, cleared(pcm), "all")
        if stops(words, self._game):
            return HeardStop(words, sure=True)
        guesses = dict.fromkeys(next_best(self._search, SEGMENTATIONS))
        for guess in islice(guesses, DOUBTED):
            if stops(guess, self._game):
                return HeardStop(guess)
        return HeardStop(words) if ends_in_stop(words) else HeardStop()


def _sayable(texts: Sequence[str], known: Known) -> list[str]:
    return [text for text in texts if known.keys() >= set(text.split())]
