"""The stop decoder: it decodes every utterance, whatever else is expected.

An n-gram model covers sentences that stop a robot or a game and others, with everyday words in
between. An utterance stops the robot if its best path does by the rules, or its best sentences are
likely to; the longer it is, the likelier they must be, because a long sentence that is misheard has
words of stopping somewhere. If the best path does not stop by the rules, the stop is in doubt, and
a command that the other decoders hear has priority: a synthetic or foreign voice is often
recognised as "tell the robot" before "stop the robot".

If the sound fits badly and no stop is certain, the utterance is decoded again with the means of
other voices (`other_voices`), and the search that fits better is used.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from tangy_tui.language.stop_sentence import likelihood, prepare, stops
from tangy_tui.speech.language import dictionary, open_model, words_of
from tangy_tui.speech.noise_reduction import cleared
from tangy_tui.speech.pocketsphinx_search import add_model, likeliest, make_search

SHARE = 0.05  # of everyday words
BY_RULES = 0.33  # what the rules add to the mean likelihood of these sentences
EACH_WORD = 0.08  # likelihood that a stop needs for each word of the best path
FEWEST, MOST = 3, 8  # words that count
ACTIVE = 1500
FITS = -3.8  # score per frame of the best path below which the means of other voices are tried
UNLIKE = 0.1  # more than the usual score, from which requests are decoded with other means, too
ACCENTS = {
    "stop": ("S T AO P", "S T AH P"),
    "stopped": ("S T AO P T",),
    "robot": ("R OW B AO T", "R OW B AH T"),
}
"""Pronunciations of British and other voices that the American dictionary lacks."""

Known = Mapping[str, Sequence[str]]


class HeardStop(NamedTuple):
    """The sentence that stops the robot ("" if none), and whether it is certain.

    `unlike` says that the means of other voices fit the sound clearly better than the usual ones.
    """

    sentence: str = ""
    sure: bool = False
    unlike: bool = False


class StopDecoder:
    """Finds stops.

    Its limits were fitted on the set `everyday`, with each voice left out once; `EACH_WORD` again
    on half of the development set.
    """

    def __init__(
        self,
        texts: Sequence[str],
        others: Sequence[str],
        everyday: Mapping[str, float],
        known: Known,
        game: Sequence[str] = (),
        means: tuple[bytes | None, bytes | None] = (None, None),
    ) -> None:
        """Build the decoder; without a text that has pronunciations it finds nothing.

        Args:
            texts: sentences that stop the robot, common ones repeated.
            others: sentences about stopping other things.
            everyday: the probabilities of everyday words.
            known: the pronunciations of words.
            game: the words of the activity's title.
            means: those of the model, and those for sound that fits them badly.
        """
        self._game = frozenset(game)
        texts, others = _sayable(texts, known), _sayable(others, known)
        self._search: Any = None
        if not texts:
            return
        words = words_of((*texts, *others)) | everyday.keys()
        said = {word: (*known[word], *ACCENTS.get(word, ())) for word in words}
        prepare()  # before the first utterance has to wait
        spoken, model = dictionary(said), open_model((*others, *texts), everyday, SHARE)
        self._search, self._other = (
            make_search(spoken, bestpath=True, active=ACTIVE, means=one) for one in means
        )
        for search in (self._search, self._other):
            add_model(search, "all", model)

    def hear(self, pcm: bytes) -> HeardStop:
        """Return the sentence of an utterance (16 kHz mono s16le) that stops the robot."""
        if self._search is None:
            return HeardStop()
        pcm = cleared(pcm)
        guesses, score = likeliest(self._search, pcm, "all")
        heard = self._judged(guesses)
        if heard.sure or score >= FITS:
            return heard
        others, other_score = likeliest(self._other, pcm, "all")
        if other_score <= score:
            return heard
        return self._judged(others)._replace(unlike=other_score > score + UNLIKE)

    def _judged(self, guesses: tuple[str, ...]) -> HeardStop:
        """Return the stop among the likeliest sentences, best first."""
        if not guesses:
            return HeardStop()
        likely = sum(likelihood(guess, self._game) for guess in guesses) / len(guesses)
        certain = stops(words := guesses[0], self._game)
        needed = EACH_WORD * min(max(len(words.split()), FEWEST), MOST)
        return HeardStop(words, certain) if likely + certain * BY_RULES >= needed else HeardStop()


def _sayable(texts: Sequence[str], known: Known) -> list[str]:
    return [text for text in texts if known.keys() >= set(text.split())]
