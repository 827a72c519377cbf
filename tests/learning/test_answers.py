"""Yes and no in the words of people; no other answer counts as a yes."""

from __future__ import annotations

import pytest

from tangy_tui.language.answers import NO, YES, choice_in, choice_phrases, yes_or_no
from tangy_tui.learning.verification import Reply, StopCommand
from tangy_tui.speech.evidence import USUAL, AcousticEvidence, EvidenceSettings
from tangy_tui.speech.understanding import answer
from tests.bench.sentences import FAR, NEAR, WORDINGS

CHOICES = ("tell a joke", "greet everyone", "say goodbye")


@pytest.mark.parametrize("text", YES)
def test_every_yes_phrase_is_a_yes(text: str) -> None:
    assert yes_or_no(text) is True


@pytest.mark.parametrize("text", NO)
def test_every_no_phrase_is_a_no(text: str) -> None:
    assert yes_or_no(text) is False


@pytest.mark.parametrize("text", ["Yes, please!", "well yes of course", "yeah, do that, thank you"])
def test_a_yes_may_be_polite(text: str) -> None:
    assert yes_or_no(text) is True


@pytest.mark.parametrize("text", ["no, that's right", "okay no", "oh no please don't", "not yet"])
def test_a_sentence_with_a_no_is_a_no(text: str) -> None:
    assert yes_or_no(text) is False


@pytest.mark.parametrize(
    "text",
    [
        "",
        "please",
        "yes and no",
        "yes that is not right",
        "are you sure",
        "right shoe",
        "yesterday",
    ],
)
def test_other_words_are_no_answer(text: str) -> None:
    assert yes_or_no(text) is None


def test_everyday_talk_is_no_yes() -> None:
    assert [text for text in (*NEAR, *FAR, *WORDINGS) if yes_or_no(text)] == ["yes of course"]


@pytest.mark.parametrize(
    ("text", "number"),
    [
        ("two", 2),
        ("number three please", 3),
        ("the second one", 2),
        ("the last one", 3),
        ("tell a joke", 1),
        ("please say goodbye", 3),
        ("four", None),
        ("the player", None),
        ("", None),
    ],
)
def test_a_choice_is_selected_by_number_or_words(text: str, number: int | None) -> None:
    assert choice_in(text, CHOICES) == number


def test_every_choice_phrase_selects_a_choice() -> None:
    assert all(choice_in(text, CHOICES) for text in choice_phrases(len(CHOICES)))
    assert choice_in("the last one", ()) is None


def heard(words: str, phrase: str = "", margin: float = 0.0) -> AcousticEvidence:
    return AcousticEvidence(words, phrase, margin, 1.0, 1.0)


@pytest.mark.parametrize(
    ("evidence", "reply"),
    [
        (heard("yep", "yep"), Reply(True)),
        (heard("that's right", "that is right", -1.0), Reply(True)),
        (heard("yes", "", -0.5), Reply(True)),
        (heard("yes", "", -0.9), None),
        (heard("yes", "no", 0.5), None),
        (heard("nope", "no"), Reply(False)),
        (heard("rolling", "wrong", -0.3), Reply(False)),
        (heard("rolling", "wrong"), None),
        (heard("rolling", "yes", -0.3), None),
        (heard("that's the one", "that's the one"), Reply(True)),
        (heard("number two", "number two"), Reply(False, alternative=2)),
        (heard("say goodbye", "say goodbye"), Reply(False, alternative=3)),
        (heard("my sister lives in canada"), None),
        (heard("stop"), StopCommand("stop")),
    ],
)
def test_an_answer_counts_if_the_sound_agrees(
    evidence: AcousticEvidence, reply: Reply | StopCommand | None
) -> None:
    assert answer(evidence, USUAL, CHOICES) == reply


def test_the_paper_mode_hears_no_answers() -> None:
    assert answer(heard("yes", "yes"), EvidenceSettings(mode="paper"), CHOICES) is None
