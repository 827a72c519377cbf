"""Spoken answers of people: their words, and the confidence that they were said."""

from __future__ import annotations

import pytest

from tangy_profiles.declared.judging import CERTAIN
from tangy_profiles.person import load_people
from tangy_tui.language.commands import Phrasebook
from tangy_tui.language.steering import IN_GAMES
from tangy_tui.learning.verification import Reply, Say, StopCommand
from tangy_tui.speech.evidence import USUAL, AcousticEvidence
from tangy_tui.speech.understanding import BOTH_HEARD, LEAST_ANSWER, commanded, replied, wanted
from tests.support.declared import declared

GIVEN = {"the dove": "the dove", "the crow": "the crow", "no milk": "no milk", "seven": "7"}


def taken(words: str, phrase: str, margin: float = 0.0) -> Say | Reply | None:
    evidence = AcousticEvidence(words, phrase, margin, 1.0, 1.0)
    said, _ = replied(evidence, USUAL, (), IN_GAMES, GIVEN, answers=True)
    assert said is None or isinstance(said, Say | Reply)
    return said


@pytest.mark.parametrize(
    ("words", "phrase", "margin", "judged"),
    [
        ("the dove", "the dove", 0.0, True),
        ("the dove", "", 0.0, False),  # only one of the decoders heard it
        ("above", "the dove", 0.0, False),
        ("the crow", "the dove", 0.0, False),
    ],
)
def test_an_answer_counts_if_both_decoders_hear_it(
    words: str, phrase: str, margin: float, judged: bool
) -> None:
    said = taken(words, phrase, margin)
    assert isinstance(said, Say)
    assert said.text == (words if words in GIVEN else phrase)
    assert (said.confidence >= CERTAIN) is judged


@pytest.mark.parametrize(
    ("words", "phrase", "stops"),
    [
        ("the dove", "the dove", False),  # only the stop decoder hears a stop
        ("the dove", "", True),
        ("stop tangy", "stop tangy", True),
        ("stop tangy", "the dove", True),
    ],
)
def test_an_answer_that_both_decoders_hear_does_not_stop_the_robot(
    words: str, phrase: str, stops: bool
) -> None:
    evidence = AcousticEvidence(words, phrase, 0.0, 1.0, 1.0, "the robot now")
    said, _ = replied(evidence, USUAL, (), IN_GAMES, GIVEN, answers=True)
    assert isinstance(said, StopCommand) is stops


@pytest.mark.parametrize(
    ("text", "meant"),
    [("carry on", Say("carry on", 1.0, None)), ("number two", Reply(yes=False, alternative=2))],
)
def test_staff_are_heard_before_people_whose_answer_is_the_same(
    text: str, meant: Say | Reply
) -> None:
    evidence = AcousticEvidence(text, text, 0.0, 1.0, 1.0)
    said, _ = replied(evidence, USUAL, ("yes", "no"), IN_GAMES, {text: "an answer"}, answers=True)
    assert said == meant


def test_the_stop_decoder_knows_the_answers_as_other_talk() -> None:
    book = Phrasebook(declared("trivia"), load_people(4))
    assert "honey" in wanted(book, USUAL).no_stops


def test_every_answer_to_a_remark_can_be_said_by_its_number() -> None:
    book = Phrasebook(declared("trivia"), load_people(4))
    assert "number four" in wanted(book, USUAL).answers
    assert "number five" not in wanted(book, USUAL).answers


def test_a_spoken_number_is_given_in_digits() -> None:
    assert taken("seven", "seven") == Say("7", BOTH_HEARD, None)


def test_other_words_and_other_sounds_are_no_answer() -> None:
    assert taken("what a lovely day", "") is None
    assert taken("the dove", "the dove", LEAST_ANSWER - 0.1) is None


def test_a_yes_is_no_answer_to_an_item() -> None:
    assert taken("yes please", "yes please") == Reply(True)
    assert taken("yes please", "the dove") is None


@pytest.mark.parametrize(("heard", "yes"), [("know thank you", False), ("yes please", True)])
def test_a_yes_or_no_that_answers_no_question_is_no_command(heard: str, yes: bool) -> None:
    book = Phrasebook(declared("trivia"), load_people(4))
    evidence = AcousticEvidence(heard, "", 0.0, 1.0, 1.0)
    assert commanded(evidence, book, USUAL, live=True) == (Reply(yes), None)
    other = AcousticEvidence("know your place", "", 0.0, 1.0, 1.0)
    said, _ = commanded(other, book, USUAL, live=True)
    assert isinstance(said, Say)


def test_a_phrase_that_is_also_a_yes_stays_a_command() -> None:
    book = Phrasebook(declared("trivia"), load_people(4))
    evidence = AcousticEvidence("that is right", "that is right", 0.0, 1.0, 1.0)
    said, _ = commanded(evidence, book, USUAL, live=True)
    assert isinstance(said, Say)
    assert said.commands


def test_no_answer_is_taken_if_spoken_answers_are_off() -> None:
    evidence = AcousticEvidence("the dove", "the dove", 0.0, 1.0, 1.0)
    assert replied(evidence, USUAL, (), IN_GAMES, GIVEN, answers=False) == (None, None)


def test_the_vocabulary_includes_answers_but_no_single_letters() -> None:
    trivia = Phrasebook(declared("trivia"), load_people(2))
    options = trivia.table.answers
    assert "a bakery" in options
    assert all(len(text) > 1 for text in options)
    assert set(options) <= set(wanted(trivia, USUAL).answers)
    assert Phrasebook(declared("exercises"), load_people(2)).table.answers == {}


@pytest.mark.parametrize(
    ("words", "stop", "options", "stops"),
    [
        ("the dove move", "the dove move", ("the dove",), False),  # learnt stops know no doves
        ("the crow", "the crow", ("the crow",), False),
        ("the crow", "the crow", ("the dove",), True),  # not an answer to this question
        ("the crow", "the crow", (), True),  # no question is open
        ("let go of the dove now", "let go of the dove now", ("the dove",), True),
        ("stop the dove", "stop the now", ("the dove",), True),  # perhaps: stop it now
        ("stop the dove", "stop it", ("the dove",), True),  # clearly a stop
    ],
)
def test_words_that_are_an_option_of_the_open_question_stop_by_the_rules_alone(
    words: str, stop: str, options: tuple[str, ...], stops: bool
) -> None:
    evidence = AcousticEvidence(words, "", -0.3, 1.0, 1.0, stop)
    said, _ = replied(evidence, USUAL, (), IN_GAMES, GIVEN, options, answers=True)
    assert isinstance(said, StopCommand) is stops
