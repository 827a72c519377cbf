"""The decoders (III-A-1): an HMM acoustic model labels phonemes and matches them to words.

In the usual mode each utterance is decoded twice: by an n-gram model of the phrases in which
everyday words can occur anywhere, which gives the words; and by a grammar of the phrases with a
garbage branch of any phones, which shows how well any phones explain the sound. The difference of
the two scores separates spoken commands from words that merely fit best. Where the words are no
whole phrase, apart from fillers, a model of the ways to ask and of talk gives guesses at the
sentence. A separate stop decoder (`stop_decoder`) runs first; if it is sure, its result is used at
once. If it finds that the means of other voices fit the sound better, requests are decoded again
with these means. The paper's mode has only the n-gram model of the phrases. pocketsphinx holds the
GIL, so this runs in a process of its own: see `worker`.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import astuple
from pathlib import Path
from typing import Any, NamedTuple, Protocol

from tangy_tui.language.words import bare
from tangy_tui.speech.evidence import (
    RATE,
    AcousticEvidence,
    DecoderVocabulary,
    Expecting,
    OtherHearing,
)
from tangy_tui.speech.forked_worker import ForkedWorker
from tangy_tui.speech.language import (
    EVERYDAY,
    dictionary,
    grammar,
    open_model,
    phrase_model,
    words_of,
)
from tangy_tui.speech.noise_reduction import cleared, surrounded
from tangy_tui.speech.other_voices import both_means
from tangy_tui.speech.pocketsphinx_search import (
    NO_PATH,
    add_model,
    best_path,
    likeliest,
    make_search,
)
from tangy_tui.speech.stop_decoder import StopDecoder

SHORTEST = 0.1  # s; less cannot hold a word, and an empty buffer raises IndexError
MODEL = "en-us/"
SENTENCES = "sentences"  # the search for guesses
FEW = 1_500  # everyday words among sentences and stops
AMONG_SENTENCES = 0.05  # their share
UNKNOWN_MARGIN = -0.5  # the margin of most speech that is no command

# Confidence of the paper's n-gram model: a logistic regression over two scores of the best path,
# its score per frame and the mean weighted log P(word | words before). Fitted by
# tests/bench/speech.py.
SCORE_MIDDLE, SCORE_WEIGHT = -2.79, 4.77
WORDS_MIDDLE, WORDS_WEIGHT = -17.9, 0.157
OFFSET = 5.23


class NoPronunciation(ValueError):
    """No phrase has a pronunciation."""


class Decoder(Protocol):
    """Converts the sound of one utterance to words."""

    left_out: tuple[str, ...]
    """Words that cannot be recognised, because they have no pronunciation."""

    def decode(self, pcm: bytes, expecting: Expecting) -> AcousticEvidence:
        """Decode a whole utterance (16 kHz mono s16le)."""

    def begin(self, expecting: Expecting) -> None:
        """Begin an utterance that arrives in chunks, for `partial`."""

    def partial(self, pcm: bytes) -> str:
        """Process the next chunk and return the words so far."""

    def close(self) -> None:
        """End its child processes."""


def make_decoder(wanted: DecoderVocabulary) -> Decoder:
    """Build the decoder for a vocabulary.

    Raises:
        NoPronunciation: no phrase can be recognised.
    """
    return PaperDecoder(wanted) if wanted.settings.mode == "paper" else TwoDecoders(wanted)


class _Streaming:
    """Partial decoding of an utterance that arrives in chunks, by one of its searches."""

    _search: Any
    _said: Mapping[str, frozenset[str]]
    """The phrases of each search."""
    _open = False

    def begin(self, expecting: Expecting) -> None:
        """Begin an utterance that arrives in chunks."""
        self._end()
        self._open = bool(self._said[expecting])
        if self._open:
            self._search.activate_search(expecting)
            self._search.start_utt()

    def partial(self, pcm: bytes) -> str:
        """Process the next chunk and return the words so far."""
        if not self._open:
            return ""
        if pcm:
            self._search.process_raw(pcm)
        best = self._search.hyp()
        return str(best.hypstr) if best is not None else ""

    def close(self) -> None:
        """End the child processes, if any."""

    def _end(self) -> None:
        if self._open:
            self._search.end_utt()
            self._open = False


class _RequestSearches:
    """Words by an open n-gram model, and a grammar with a garbage branch."""

    def __init__(self, texts: _RequestTexts, means: bytes | None) -> None:
        self.words = make_search(texts.words, bestpath=True, active=1500, means=means)
        self._grammar = make_search(texts.own_words, bestpath=False, active=1000, means=means)
        for name, model in texts.models.items():
            add_model(self.words, name, model)
        for name, rules in texts.grammars.items():
            self._grammar.add_jsgf_string(name, rules)

    def by_words(self, pcm: bytes, expecting: Expecting) -> tuple[str, float]:
        """Return the likeliest words, and their score."""
        return best_path(self.words, pcm, expecting)[:2]

    def by_grammar(self, pcm: bytes, expecting: Expecting) -> tuple[str, float]:
        """Return the phrase or any phones, and their score."""
        return best_path(self._grammar, pcm, expecting)[:2]


class _RequestTexts(NamedTuple):
    """Dictionaries and models of the searches for requests."""

    words: str
    own_words: str
    models: dict[str, str]
    grammars: dict[str, str]


class TwoDecoders(_Streaming):
    """The usual mode: words by an open n-gram model, and a grammar with a garbage branch."""

    def __init__(self, wanted: DecoderVocabulary) -> None:
        everyday = everyday_words(EVERYDAY)
        known = _pronunciations(
            words_of((*wanted.phrases, *wanted.answers, *wanted.sentences))
            | words_of((*wanted.stops, *wanted.no_stops))
            | everyday.keys(),
            wanted.pronunciations,
        )
        self.left_out, phrases = _heard(wanted.phrases, known)
        _, answers = _heard(wanted.answers, known)
        weight = wanted.settings.garbage
        own = {w: known[w] for w in (*words_of(phrases), *words_of(answers))}
        open_words = {word: p for word, p in everyday.items() if word in known}
        share = weight / (1 + weight)
        asked = [text for text in wanted.sentences if known.keys() >= set(text.split())]
        said_words = (*open_words, *words_of(asked), *own)
        texts = _RequestTexts(
            dictionary({word: known[word] for word in said_words}),
            dictionary(own, phones=True),
            {},
            {},
        )
        for name, said in (("commands", phrases), ("answers", answers)):
            if said:
                texts.models[name] = open_model(said, open_words, share)
                texts.grammars[name] = grammar(said, weight)
        self._said = {"commands": frozenset(phrases), "answers": frozenset(answers)}
        self._bare = {bare(tuple(text.split())) for text in phrases} - {()}
        few = dict(list(open_words.items())[:FEW])
        self._guesses = bool(asked)
        if asked:
            texts.models[SENTENCES] = open_model((*phrases, *asked), few, AMONG_SENTENCES)
        usual, other = both_means(wanted.settings.voice)
        self._usual, self._other = _RequestSearches(texts, usual), _RequestSearches(texts, other)
        self._search = self._usual.words
        means = usual, other
        self._stops = StopDecoder(wanted.stops, wanted.no_stops, few, known, wanted.game, means)
        self._beside = ForkedWorker(self._by_words)
        self._beside_stops = ForkedWorker(self._stops.hear)

    def decode(self, pcm: bytes, expecting: Expecting) -> AcousticEvidence:
        """Decode a whole utterance."""
        seconds = len(pcm) / 2 / RATE
        if seconds < SHORTEST or not self._said[expecting]:
            return AcousticEvidence(seconds=seconds)
        self._beside_stops.ask(pcm)
        pcm = cleared(surrounded(pcm))
        self._beside.ask((pcm, expecting, False))
        stop, sure, unlike = self._beside_stops.answer()  # first, while it has a core to itself
        if sure:
            return AcousticEvidence(stop, "", UNKNOWN_MARGIN, 1.0, seconds, stop)
        usual, score = self._both(self._usual, pcm, expecting)
        other = None
        if unlike and expecting == "commands":
            self._beside.ask((pcm, expecting, True))
            heard, other_score = self._both(self._other, pcm, expecting)
            other = heard if other_score > score else None
        words, phrase, margin, guesses = astuple(usual)
        return AcousticEvidence(words, phrase, margin, 1.0, seconds, stop, guesses, other)

    def _both(
        self, searches: _RequestSearches, pcm: bytes, expecting: Expecting
    ) -> tuple[OtherHearing, float]:
        """Return what searches hear, and the score of the words, which were asked for before."""
        phrase, garbage = searches.by_grammar(pcm, expecting)
        words, score, guesses = self._beside.answer()
        margin = score - garbage if garbage > NO_PATH else UNKNOWN_MARGIN
        if phrase not in self._said[expecting]:
            phrase = ""  # garbage, or an unfinished phrase
        return OtherHearing(words, phrase, margin, guesses), score

    def _by_words(self, asked: tuple[bytes, Expecting, bool]) -> tuple[str, float, tuple[str, ...]]:
        pcm, expecting, unlike = asked
        self._end()  # not earlier: it takes .06 s, and a child's own search is not open
        searches = self._other if unlike else self._usual
        words, score = searches.by_words(pcm, expecting)
        # fillers such as "please" change nothing
        phrase = not words or bare(tuple(words.split())) in self._bare
        if phrase or expecting != "commands" or not self._guesses:
            return words, score, ()
        guesses, _ = likeliest(searches.words, pcm, SENTENCES)
        return words, score, guesses

    def close(self) -> None:
        """End the child processes."""
        self._beside.close()
        self._beside_stops.close()


class PaperDecoder(_Streaming):
    """The paper's mode: the sequence of words by an n-gram model of the phrases alone."""

    def __init__(self, wanted: DecoderVocabulary) -> None:
        known = _pronunciations(
            {*words_of(wanted.phrases), *words_of(wanted.answers)}, wanted.pronunciations
        )
        self.left_out, phrases = _heard(wanted.phrases, known)
        _, answers = _heard(wanted.answers, known)
        self._search = make_search(dictionary(known), bestpath=True)
        for name, said in (("commands", phrases), ("answers", answers)):
            if said:
                add_model(self._search, name, phrase_model(said))
        self._said = {"commands": frozenset(phrases), "answers": frozenset(answers)}

    def decode(self, pcm: bytes, expecting: Expecting) -> AcousticEvidence:
        """Decode a whole utterance."""
        self._end()
        seconds = len(pcm) / 2 / RATE
        if seconds < SHORTEST or not self._said[expecting]:
            return AcousticEvidence(seconds=seconds)
        text, score, words = best_path(self._search, pcm, expecting)
        sure = (
            OFFSET + SCORE_WEIGHT * (score - SCORE_MIDDLE) + WORDS_WEIGHT * (words - WORDS_MIDDLE)
        )
        confidence = 1 / (1 + math.exp(-max(-50.0, min(50.0, sure)))) if text else 0.0
        return AcousticEvidence(text, "", 0.0, confidence, seconds)


def everyday_words(count: int) -> dict[str, float]:
    """Return the most frequent words of the decoder's general model, with their probabilities.

    Words outside the dictionary are left out.
    """
    import pocketsphinx

    path = pocketsphinx.get_model_path(f"{MODEL}en-us.lm.bin")
    logs = pocketsphinx.LogMath()
    model = pocketsphinx.NGramModel(pocketsphinx.Config(lm=path), logs, path)
    words = (w for w in dict.fromkeys(w for w, _ in _dictionary_lines()) if w[0].isalpha())
    scored = sorted(((model.prob([word]), word) for word in words), reverse=True)
    return {word: logs.exp(score) for score, word in scored[:count]}


def _dictionary_lines() -> Iterable[tuple[str, str]]:
    import pocketsphinx

    path = Path(pocketsphinx.get_model_path(f"{MODEL}cmudict-en-us.dict"))
    with path.open(encoding="utf-8", errors="replace") as lines:
        for line in lines:
            word, _, phones = line.strip().partition(" ")
            yield word.partition("(")[0], phones


def _pronunciations(
    wanted: set[str], own: Mapping[str, Sequence[str]]
) -> dict[str, tuple[str, ...]]:
    """Return pronunciations: those given by activity and people, or else the dictionary's."""
    found: dict[str, list[str]] = {}
    for word, phones in _dictionary_lines():
        if word in wanted and word not in own:
            found.setdefault(word, []).append(phones)
    return {
        **{word: tuple(ways) for word, ways in found.items()},
        **{word: tuple(ways) for word, ways in own.items() if word in wanted},
    }


def spelt(texts: Sequence[str], own: Mapping[str, Sequence[str]]) -> str:
    """Return the dictionary of the words of some texts; those without a pronunciation are missing.

    Args:
        texts: the texts.
        own: the pronunciations given by activity and people.
    """
    return dictionary(_pronunciations(words_of(texts), own))


def _heard(
    phrases: Sequence[str], known: Mapping[str, Sequence[str]]
) -> tuple[tuple[str, ...], list[str]]:
    """Return the words that cannot be recognised, and the phrases that can."""
    unknown = words_of(phrases) - set(known)
    heard = [p for p in dict.fromkeys(phrases) if p and not unknown.intersection(p.split())]
    if phrases and not heard:
        raise NoPronunciation("None of the phrases can be pronounced with the English dictionary.")
    return tuple(sorted(unknown)), heard
