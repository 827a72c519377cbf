"""Situations of declared activities in words, with and without words in the file."""

from __future__ import annotations

from pathlib import Path

import pytest

from tangy_profiles.declared.activity import DeclaredActivity, read_declared
from tangy_profiles.declared.situation_words import value_words
from tangy_profiles.declared.situations import situation_of
from tangy_tui.text.activities import without_words
from tests.support.declared import DECLARED, declared

BARE = """
name = "bare"
flags = ["opened"]
stages = [
  { name = "warm_up", when = ["opened is no"], sees = ["clock", "mood", "tries"] },
  { name = "rest" },
]
[facts]
clock = { kind = "timer", bands = [5, 20] }
tries = { kind = "count", bands = [2] }
mood = { values = ["well", "sad"], from = ["staff"] }
[behaviours."open it"]
does = ["set opened yes", "start clock", "add tries", "clear mood"]
says = ["Hello."]
[behaviours."end it"]
does = ["finish"]
says = ["Goodbye."]
"""


@pytest.fixture
def bare(tmp_path: Path) -> DeclaredActivity:
    file = tmp_path / "bare.toml"
    file.write_text(BARE, encoding="utf-8")
    return read_declared(file)


def test_a_stage_is_described_in_the_words_of_its_file() -> None:
    trivia = declared("trivia")
    wrong = situation_of(trivia.declaration, "judge", ("wrong", "yes"))
    assert trivia.told_of(wrong, "Rosa") == "Rosa gave an answer · it is wrong, after a hint"
    assert "the player gave an answer" in trivia.in_words(wrong)
    assert "judge" not in trivia.in_words(wrong)
    assert trivia.in_names(wrong) == "judge · answer is wrong, hinted is yes"


def test_a_stage_of_a_game_of_teams_speaks_of_teams() -> None:
    teams = declared("team-trivia")
    assert teams.stage_words("repeat") == "a team asked to hear the question again"
    assert teams.stage_words("judge") == "the team gave an answer"
    assert declared("trivia").stage_words("judge") == "the player gave an answer"


def test_names_and_conditions_describe_a_stage_without_words(bare: DeclaredActivity) -> None:
    first = situation_of(bare.declaration, "warm_up", ("5-19", "sad", ">=2"))
    told = "warm up (opened is no) · for 5 to 19 s, mood is sad, tries: 2 or more"
    assert bare.in_words(first) == told
    assert bare.stage_words("rest") == "rest"
    assert bare.stage_words("of another file") == "of another file"
    opened = bare.declaration.facts["opened"]
    assert [value_words(opened, value) for value in opened.values] == ["not opened", "opened"]


def test_check_names_the_stages_without_words(bare: DeclaredActivity) -> None:
    (line,) = without_words(bare)
    assert "warm_up, rest" in line
    assert without_words(declared("trivia")) == []


def test_every_shipped_situation_has_unique_words() -> None:
    assert DECLARED
    for activity in map(declared, DECLARED):
        assert without_words(activity) == [], activity.name
        told = [activity.in_words(situation) for situation in activity.situations]
        assert len(set(told)) == len(told), activity.name
