"""The stop detector: its training texts, and the effect of a detected stop."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from types import SimpleNamespace
from typing import ClassVar

import pytest

from tangy_hw.audio.wav import RATE
from tangy_profiles.activity import load_activity
from tangy_profiles.person import load_people
from tangy_tui.language.commands import Phrasebook
from tangy_tui.language.steering import IN_GAMES
from tangy_tui.language.stop_phrases import other_stop_texts, stop_texts
from tangy_tui.language.stop_sentence import STOPS, stops
from tangy_tui.learning.verification import Reply, Say, StopCommand
from tangy_tui.speech import decoder as speech_decoder
from tangy_tui.speech import pocketsphinx_search, stop_decoder
from tangy_tui.speech.evidence import USUAL, AcousticEvidence, DecoderVocabulary, Expecting
from tangy_tui.speech.stop_decoder import HeardStop, StopDecoder
from tangy_tui.speech.understanding import answer, commanded, replied, understand, wanted

BOOK = Phrasebook(load_activity("bingo"), load_people(4))


def heard(words: str, stop: str, margin: float = 0.3) -> AcousticEvidence:
    return AcousticEvidence(words, "", margin, 1.0, 1.0, stop)


def share(texts: tuple[str, ...]) -> float:
    """Return the share of some texts that stops the robot."""
    some = texts[::7]
    return sum(stops(text, BOOK.game) for text in some) / len(some)


def test_most_stop_texts_stop_and_few_others_do() -> None:
    assert share(stop_texts()) > 0.9
    assert share(other_stop_texts()) < 0.05


def test_the_training_texts_are_reproducible_and_plain_words() -> None:
    texts = stop_texts()
    stop_texts.cache_clear()
    assert stop_texts() == texts
    assert set(STOPS) <= set(texts)
    assert not [text for text in (*texts, *other_stop_texts()) if set("{}_") & set(text)]


def test_the_vocabulary_has_stops_other_texts_and_the_name_of_the_game() -> None:
    found = wanted(BOOK, USUAL)
    assert found.stops
    assert found.no_stops
    assert "bingo" in found.game


@pytest.mark.parametrize("words", ["they stop", "that cannot stop", "", "tell a nice joke now"])
def test_a_detected_stop_overrides_the_words(words: str) -> None:
    assert understand(heard(words, "hey stop"), BOOK, USUAL) == StopCommand("hey stop")
    said, _ = commanded(heard(words, "hey stop"), BOOK, USUAL, live=True)
    assert said == StopCommand("hey stop")


@pytest.mark.parametrize(
    ("words", "margin", "stops"),
    [
        ("that's far enough now dear", 0.2, True),
        ("return we want it", -0.9, False),  # espeak's "greet everyone", spoken slowly
        ("stop the robot", -0.9, True),  # the rules are certain
    ],
)
def test_uncertain_words_stop_only_by_the_rules(words: str, margin: float, stops: bool) -> None:
    said = understand(heard(words, "", margin), BOOK, USUAL)
    assert isinstance(said, StopCommand) == stops


def test_a_clearly_heard_phrase_is_no_stop() -> None:
    said = understand(heard("call number", "don't come closer"), BOOK, USUAL)
    assert isinstance(said, Say)
    assert said.sure


@pytest.mark.parametrize(
    ("words", "margin", "steers"),
    [
        ("let's take a break", -0.2, True),
        ("carry on", -0.2, True),
        ("slow down", -0.2, True),
        ("too fast for the car", 0.2, False),
        ("carry on", -1.5, False),  # the sound hardly fitted
        ("undo that", 0.2, False),  # a command that no game has
        ("carry on with the bag", 0.2, False),
    ],
)
def test_steering_in_games_needs_a_clear_sound(words: str, margin: float, steers: bool) -> None:
    said, _ = replied(heard(words, "", margin), USUAL, steering=IN_GAMES, answers=False)
    assert said == (Say(words, 1.0, None) if steers else None)
    assert replied(heard(words, "", margin), USUAL, answers=False) == (None, None)


def test_a_clear_answer_overrides_a_detected_stop() -> None:
    assert answer(heard("they stop", "hey stop"), USUAL) == StopCommand("hey stop")
    assert answer(heard("no thank you", "don't move", 0.5), USUAL) == Reply(False)


def test_a_detected_stop_counts_unless_both_decoders_heard_a_yes() -> None:
    said = heard("yes please", "please stop", 0.5)
    assert answer(said, USUAL) == StopCommand("please stop")
    assert answer(replace(said, phrase="yes please"), USUAL) == Reply(True)


def test_a_detected_stop_counts_unless_both_decoders_heard_steering() -> None:
    said = heard("undo that", "don't move", 0.5)
    assert understand(said, BOOK, USUAL) == StopCommand("don't move")
    assert understand(replace(said, phrase="undo that"), BOOK, USUAL) == Say("undo that", 1.0, None)


class GuessingSearch:
    """A search with given hypotheses, best first, for any sound."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, *guesses: str) -> None:
        self._guesses = guesses
        monkeypatch.setattr(stop_decoder, "make_search", lambda *_, **__: self)
        monkeypatch.setattr(stop_decoder, "add_model", lambda *_: None)
        monkeypatch.setattr(pocketsphinx_search, "best_path", lambda *_: (guesses[0], -2.0, 0.0))

    def nbest(self) -> Iterator[SimpleNamespace | None]:
        yield from (SimpleNamespace(hypstr=guess) for guess in self._guesses)
        yield None

    def hear(self) -> HeardStop:
        known = {"stop": ("S T AA P",), "the": ("DH AH",)}
        decoder = StopDecoder(["stop"], [], {"the": 1.0}, known)
        return decoder.hear(bytes(RATE))


NO_STOPS = ("the dog", "the door", "a dog", "a door", "the log", "the lock")


def test_a_stop_as_best_hypothesis_is_certain(monkeypatch: pytest.MonkeyPatch) -> None:
    heard = GuessingSearch(monkeypatch, "hey stop", *NO_STOPS).hear()
    assert heard == HeardStop("hey stop", sure=True)


@pytest.mark.parametrize(
    ("likely", "stops"),
    [((0.3, 0.7, 0.6), True), ((0.6, 0, 0, 0), False), ((0,) * 20 + (1,) * 20, False)],
)
def test_a_high_average_stop_likelihood_gives_an_uncertain_stop(
    monkeypatch: pytest.MonkeyPatch, likely: tuple[float, ...], stops: bool
) -> None:
    guesses = {f"dog {number}": one for number, one in enumerate(likely)}
    monkeypatch.setattr(stop_decoder, "likelihood", lambda guess, _: guesses[guess])
    twice = [guess for guess in guesses for _ in range(2)]  # cut at different places
    heard = GuessingSearch(monkeypatch, *twice).hear()
    assert heard == (HeardStop("dog 0") if stops else HeardStop())


@pytest.mark.parametrize(("words", "stops"), [(3, True), (7, False)])
def test_a_longer_sentence_needs_a_higher_likelihood(
    monkeypatch: pytest.MonkeyPatch, words: int, stops: bool
) -> None:
    said = " ".join(["dog"] * words)
    monkeypatch.setattr(stop_decoder, "likelihood", lambda *_: 0.5)
    assert GuessingSearch(monkeypatch, said).hear() == HeardStop(said if stops else "")


class TwoAnswers:
    """Stands in for the decoder's forked workers; the one for the words may remain unused."""

    found = HeardStop()
    words = ""
    other_words, other_score = "", -1.0
    means = False
    asked: ClassVar[list[str]] = []

    def __init__(self, work: Callable[[object], object]) -> None:
        self.name = work.__name__

    def ask(self, asked: object) -> None:
        """Take a question; those for words say whether the means of other voices are meant."""
        self.means = isinstance(asked, tuple) and asked[-1]

    def answer(self) -> object:
        self.asked.append(self.name)
        if self.name == "hear":
            return self.found
        return (self.other_words, self.other_score, ()) if self.means else (self.words, -2.0, ())

    def close(self) -> None:
        """Do nothing, as nothing was started."""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("sure", "words"), [(True, "call number"), (False, "they stop"), (False, "call number")]
)
def test_only_an_uncertain_stop_waits_for_the_words(
    monkeypatch: pytest.MonkeyPatch, sure: bool, words: str
) -> None:
    monkeypatch.setattr(speech_decoder, "ForkedWorker", TwoAnswers)
    monkeypatch.setattr(TwoAnswers, "found", HeardStop("hey stop", sure))
    monkeypatch.setattr(TwoAnswers, "words", words)
    monkeypatch.setattr(TwoAnswers, "asked", [])
    decoder = speech_decoder.make_decoder(DecoderVocabulary(("call number",), ("yes",)))
    evidence = decoder.decode(bytes(2 * RATE), "commands")
    assert evidence.stop == "hey stop"
    assert evidence.words == ("hey stop" if sure else words)
    assert len(TwoAnswers.asked) == (1 if sure else 2)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("unlike", "expecting", "score", "other"),
    [
        (True, "commands", -1.9, "call number"),
        (True, "commands", -2.1, None),  # the usual means fit these words better
        (False, "commands", -1.9, None),
        (True, "answers", -1.9, None),
    ],
)
def test_requests_of_unlike_voices_are_decoded_again(
    monkeypatch: pytest.MonkeyPatch,
    unlike: bool,
    expecting: Expecting,
    score: float,
    other: str | None,
) -> None:
    monkeypatch.setattr(speech_decoder, "ForkedWorker", TwoAnswers)
    monkeypatch.setattr(TwoAnswers, "found", HeardStop(unlike=unlike))
    monkeypatch.setattr(TwoAnswers, "words", "cool lumber")
    monkeypatch.setattr(TwoAnswers, "other_words", "call number")
    monkeypatch.setattr(TwoAnswers, "other_score", score)
    decoder = speech_decoder.make_decoder(DecoderVocabulary(("call number",), ("yes",)))
    evidence = decoder.decode(bytes(2 * RATE), expecting)
    assert evidence.words == "cool lumber"
    assert (evidence.other and evidence.other.words) == other
