"""Numbers as a caller says them: found by the deck alone, twice, then digit by digit."""

from __future__ import annotations

from xml.etree import ElementTree

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tangy_hw.audio.number_reader import SpokenPiece, as_called, in_words, marked_up
from tangy_profiles.activity import Activity, load_activity

DECK = load_activity("bingo").deck


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("The number is O 69.", "The number is O, 69. O, 6 9."),
        ("O-69", "O, 69. O, 6 9."),
        ("It is O-69. I repeat: O-69.", "It is O, 69. I repeat: O, 6 9."),
        ("It is B 5. Again: B 5! B 5!", "It is B, 5. Again: B, 5. B, 5."),
        ("Mark these: I-16, G-60. Please.", "Mark these: I, 16. I, 1 6. G, 60. G, 6 0. Please."),
    ],
)
def test_a_call_is_spoken_twice_and_then_digit_by_digit(text: str, said: str) -> None:
    assert in_words(as_called(text, DECK)) == said


@pytest.mark.parametrize(
    "text",
    [
        "B 16",
        "O 76",
        "X 5",
        "b 5",
        "AB 5",
        "B 5.5",
        "B 5-7",
        "I am 20",
        "B",
        "5",
        "B and 5",
        "B-05x",
    ],
)
def test_text_without_a_call_of_the_deck_is_unchanged(text: str) -> None:
    assert as_called(text, DECK) == (SpokenPiece(text),)


def test_the_letters_come_from_the_deck(lanterns: Activity) -> None:
    assert in_words(as_called("K-15 B-5", lanterns.deck)) == "K, 15. K, 1 5. B-5"
    assert as_called("K-15", None) == (SpokenPiece("K-15"),)


def test_only_the_call_is_slow_and_has_pauses() -> None:
    marked = ElementTree.fromstring(marked_up(as_called("Now O 69 please", DECK)))  # noqa: S314
    slow = list(marked.iter("prosody"))
    assert [s.text for s in slow] == ["O, 69.", "O, 6 9."]
    assert {s.get("rate") for s in slow} == {"75%"}
    assert [b.get("time") for b in marked.iter("break")] == ["400ms", "600ms", "600ms"]
    assert "".join(marked.itertext()).split() == ["Now", "O,", "69.", "O,", "6", "9.", "please"]


def test_a_call_alone_has_no_pauses_around_it() -> None:
    assert "<break" not in marked_up((SpokenPiece("B, 5.", call=True),))


def test_an_empty_text_gives_no_speech() -> None:
    for text in ("", " \n", "\x00\u200b"):
        assert as_called(text, DECK) == ()
        assert marked_up(as_called(text, DECK)) == ""


@given(st.text())
def test_any_text_becomes_complete_and_well_formed_markup(text: str) -> None:
    written = marked_up(as_called(text, DECK))
    if written:
        said = "".join(ElementTree.fromstring(written).itertext())  # noqa: S314
        assert "[[" not in said, "it would be read as sounds"
        assert said.replace("[ [", "[[") == in_words(as_called(text, None)) or "," in said
