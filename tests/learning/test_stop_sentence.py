"""Sentences that stop the robot: the aim of a sentence decides, not its first word."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tangy_profiles.activity import load_activity, read_activity
from tangy_profiles.person import load_people
from tangy_tui.language.commands import Phrasebook
from tangy_tui.language.stop_phrases import stop_sets
from tangy_tui.language.stop_sentence import (
    STOPS,
    stops,
    stops_by_rules,
    stops_whatever_follows,
)
from tests.bench.sentences import FAR, NEAR, WORDINGS
from tests.learning.stop_sentences import (
    MENTIONING,
    MENTIONING_TOO,
    MENTIONING_WITH_ADJECTIVES,
    STOPPING,
    STOPPING_TOO,
    STOPPING_WITH_ADJECTIVES,
)

ROOT = Path(__file__).parents[1]

WORD = st.sampled_from(sorted({w for s in (*STOPPING, *MENTIONING) for w in s.lower().split()}))
DOORS = (
    *("help", "?", "undo", "redo", "again 5", "again", "where", "seen", "why", "next", "quit"),
    *("exit", "leave", "phrases", "voice", "what", "what should I do?", "all right", "all is well"),
    *("expert", "clear", "faults", "y", "n", "yes", "no", "1", "# stop", ""),
)
"""Other words that are typed where stops are; `#` begins a comment, which needs no answer."""


@pytest.mark.parametrize("sentence", STOPPING[::2])
def test_a_stop_aimed_at_the_robot_or_the_game_stops(sentence: str) -> None:
    assert stops(sentence)
    assert stops(sentence.upper()) and stops(f"  {sentence}!! ")


@pytest.mark.parametrize("sentence", MENTIONING[::2])
def test_a_mention_of_stopping_does_not_stop(sentence: str) -> None:
    assert not stops(sentence)
    assert not stops(f"{sentence}.".capitalize())


def test_held_out_sentences_are_classified() -> None:
    missed = [s for s in (*STOPPING[1::2], *STOPPING_TOO) if not stops(s, {"bingo"})]
    wrongly = [s for s in (*MENTIONING[1::2], *MENTIONING_TOO) if stops(s, {"bingo"})]
    assert (missed, wrongly) == ([], [])


def test_most_everyday_commands_stop_and_other_talk_does_not() -> None:
    said = stop_sets()["everyday"]
    stopped = {kind: [s for s in texts if stops(s, {"bingo"})] for kind, texts in said.items()}
    assert len(stopped["stops"]) >= 0.8 * len(said["stops"])
    assert len(stopped["others"]) <= 1 and stopped["talk"] == []


def test_stops_after_a_polite_condition_or_an_all_round_order_stop() -> None:
    assert stops("if you could just stop there") and stops("everything stop please")
    assert not stops("if you could stop the radio") and not stops("everything stops at noon")


def test_the_robot_on_somebody_stops_and_a_thing_to_hold_does_not() -> None:
    assert stops("it's on my toes") and stops("it is driving over my foot")
    assert not stops("would you hold this for me") and not stops("i'm out of puff today")


def test_taking_an_unnamed_thing_away_is_no_stop() -> None:
    assert not stops("could somebody please take it away")
    assert stops("take it away from me") and stops("take that robot away")


def test_adjectives_for_the_robot_do_not_hide_a_stop() -> None:
    missed = [s for s in STOPPING_WITH_ADJECTIVES if not stops(s, {"bingo"})]
    wrongly = [s for s in MENTIONING_WITH_ADJECTIVES if stops(s, {"bingo"})]
    assert (missed, wrongly) == ([], [])


def test_other_speech_and_typed_text_do_not_stop() -> None:
    said = (*NEAR, *FAR, *WORDINGS, *DOORS[:-2])
    assert [sentence for sentence in said if stops(sentence)] == []


@pytest.mark.parametrize("name", ["bingo", "lanterns"])
def test_no_phrase_of_an_activity_stops(name: str) -> None:
    there = load_activity(name) if name == "bingo" else read_activity(ROOT / f"{name}.toml")
    book = Phrasebook(there, load_people(4))
    assert [phrase for phrase in book.phrases if stops(phrase, book.game)] == []


def test_every_stop_phrase_stops() -> None:
    assert [phrase for phrase in STOPS if not stops(phrase)] == []


@pytest.mark.parametrize(
    ("words", "game", "meant"),
    [
        ("stop the lanterns", {"lanterns"}, True),
        ("stop playing lanterns", {"lanterns"}, True),
        ("stop the lanterns", set(), False),
        ("stop teasing the lanterns", {"lanterns"}, False),
        ("please stop the music quiz", {"music", "quiz"}, True),
        ("stop and go on", {"stop", "and", "go"}, True),  # a game may have any words as its name
        ("go on", {"stop", "and", "go"}, False),
    ],
)
def test_a_stop_may_name_the_game(words: str, game: set[str], meant: bool) -> None:
    assert stops(words, game) is meant


@pytest.mark.parametrize(
    "typed",
    [
        "stpo",
        "STOOOP",
        "please tsop",
        "stop teh robot",
        "stop the rboto",
        "emergancy stop",
        "e-stop",
    ],
)
def test_typing_errors_in_a_stop_are_understood(typed: str) -> None:
    assert stops(typed)


@pytest.mark.parametrize("typed", ["stopthe robot", "stoptherobot", "stopit", "emergencystop"])
def test_words_that_are_run_together_are_understood(typed: str) -> None:
    assert stops(typed)


@pytest.mark.parametrize("typed", ["spot", "post it", "tops", "shop", "the robot", "stamp"])
def test_other_words_with_similar_letters_do_not_stop(typed: str) -> None:
    assert not stops(typed)


@pytest.mark.parametrize(
    ("typed", "meant"),
    [
        ("No! Stop!", True),
        ("Tangy, please, stop", True),
        ("she said nothing; stop the robot", True),
        ("wait - stop", True),
        ("no, don't stop", False),
        ("don\N{RIGHT SINGLE QUOTATION MARK}t stop", False),
        ("the rain stopped, so we went out", False),
    ],
)
def test_each_clause_counts_for_itself(typed: str, meant: bool) -> None:
    assert stops(typed) is meant


@pytest.mark.parametrize(
    ("typed", "meant"),
    [
        ("please to stop the robot now", True),
        ("right there's a fire alarm Tangy stop everything", True),
        ("stop the exercises please Walter is feeling dizzy", True),
        ("stop the man touching the robot", False),
        ("we don't want to stop the game", False),
        ("don't ever stop the robot please", False),
    ],
)
def test_orders_that_no_rule_knows_stop_if_what_was_learnt_is_sure(typed: str, meant: bool) -> None:
    assert not stops_by_rules(typed)
    assert stops(typed) is meant


@given(st.lists(WORD, max_size=12).map(" ".join))
def test_a_negated_stop_does_not_stop(words: str) -> None:
    words = re.sub(r"[^\w' ]", " ", words)  # a clause of its own may be a command: "don't! abort"
    assert not stops(f"don't stop {words.partition('stop')[0].replace('halt', '')} teasing")


@pytest.mark.parametrize(
    "once",
    ["please ", "you must ", "stop now the ", "stop going over to ", "i want it to ", "the robot "],
)
def test_a_long_line_is_judged_at_once(once: str) -> None:
    assert not stops(once * 60 + "teasing")


@pytest.mark.parametrize(
    ("words", "clear"),
    [
        ("stop the robot", True),
        ("please stop the game", True),
        ("emergency stop", True),
        ("stop", False),  # ... teasing her
        ("stop it", False),  # ... from leaking
        ("do not stop the robot", False),
        ("the robot", False),
    ],
)
def test_a_stop_that_names_the_robot_needs_no_more_words(words: str, clear: bool) -> None:
    assert stops_whatever_follows(words) is clear
