"""A search of an activity's games finds unreachable parts, missing words, and endless games."""

from __future__ import annotations

from pathlib import Path

import pytest

from tangy_profiles.activity import shipped_activities
from tangy_profiles.declared.checking import findings
from tangy_profiles.declared.search import Limit
from tangy_profiles.declared.state_keys import TELLING
from tangy_tui.text.activity_search import IN_VAIN, dead_end_lines, finding_words, search_lines
from tests.support.changed import changed_trivia
from tests.support.declared import DECLARED, declared

SHIPPED = shipped_activities()["trivia"]


def flaws(folder: Path, *changes: tuple[str, str]) -> set[tuple[str, str]]:
    return {(found.flaw, found.name) for found in findings(changed_trivia(folder, *changes)).flaws}


def way_there(folder: Path, *changes: tuple[str, str]) -> list[str]:
    activity = changed_trivia(folder, *changes)
    (found,) = findings(activity).flaws
    return list(dead_end_lines(activity, found))


@pytest.mark.slow
@pytest.mark.parametrize("name", DECLARED)
def test_shipped_activities_have_no_flaw(name: str) -> None:
    assert findings(declared(name), Limit(states=5_000, seconds=10.0)).flaws == ()


@pytest.mark.slow
def test_unreachable_stages_and_unset_flags_are_flaws(tmp_path: Path) -> None:
    never = '{ name = "never", when = ["lost is yes"] },\n  { name = "over"'
    changes = (('{ name = "over"', never), ('flags = ["greeted"', 'flags = ["lost", "greeted"'))
    assert flaws(tmp_path, *changes) == {
        ("stage never reached", "never"),
        ("fact never changes", "lost"),
    }


@pytest.mark.slow
def test_a_game_that_cannot_end_is_a_flaw(tmp_path: Path) -> None:
    needs = ('does = ["finish"]', 'needs = ["greeted is no"]\ndoes = ["finish"]')
    assert any(flaw == "never ends" for flaw, _ in flaws(tmp_path, needs))
    lines = way_there(tmp_path, needs)
    assert lines[1:3] == ["  1. start -> welcome everyone", "From then on only these are possible:"]
    assert "close quiz" not in lines[3]


@pytest.mark.slow
def test_a_game_that_never_ends_as_expected_is_a_flaw(tmp_path: Path) -> None:
    round_and_round = (
        '["over", "told is no", "tell scores"],',
        '["over", "told is no", "allow time"],',
    )
    assert ("never ends", "over · told is no") in flaws(tmp_path, round_and_round)
    lines = way_there(tmp_path, round_and_round)
    assert "     then player 1: answer is right" in lines
    assert lines[-2:] == [
        "From then on 'expected' names only these:",
        "  over · told is no -> allow time",
    ]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("change", "endless"),
    [
        (('["over", "told is no", "tell scores"],', '["over", "told is no", "allow time"],'), True),
        (('does = ["finish"]', 'needs = ["greeted is no"]\ndoes = ["finish"]'), True),
        (("", ""), False),
    ],
)
def test_only_a_game_that_never_ends_is_endless(
    change: tuple[str, str], endless: bool, tmp_path: Path
) -> None:
    found = findings(changed_trivia(tmp_path, change)).flaws
    assert [one.endless for one in found] == [True] * endless


@pytest.mark.slow
def test_an_end_that_lacks_what_it_needs_is_said_to_be_impossible(tmp_path: Path) -> None:
    lines = way_there(
        tmp_path, ('does = ["finish"]', 'needs = ["greeted is no"]\ndoes = ["finish"]')
    )
    assert not any("close quiz" in line and IN_VAIN not in line for line in lines)


@pytest.mark.slow
def test_a_behaviour_that_is_repeated_while_nobody_acts_is_a_flaw(tmp_path: Path) -> None:
    patient = ('["listen", "clock is <20", "allow time"],', '["listen", "allow time"],')
    activity = changed_trivia(tmp_path, patient)
    (found,) = (one for one in findings(activity).flaws if one.flaw == "repeated in vain")
    assert found.name == "allow time"
    assert "clock is >=20" in found.text
    assert "allow time" in finding_words("mine.toml", found)


@pytest.mark.slow
def test_a_situation_without_a_possible_behaviour_is_a_flaw(tmp_path: Path) -> None:
    text = SHIPPED.read_text(encoding="utf-8")
    headers = [line for line in text.splitlines() if line.startswith("[behaviours.")]
    nothing = [(line, f'{line}\nneeds = ["hinted is no"]') for line in headers]
    assert ("nothing possible", "start") in flaws(tmp_path, *nothing)
    activity = changed_trivia(tmp_path, *nothing)
    (found,) = (one for one in findings(activity).flaws if one.flaw == "nothing possible")
    *_, last = dead_end_lines(activity, found)
    assert last == "  1. start -> give hint (player 1)"


@pytest.mark.slow
def test_a_text_with_a_missing_word_is_a_flaw(tmp_path: Path) -> None:
    early = flaws(tmp_path, ("Welcome to the quiz!", "Welcome! The first is: {ask}"))
    assert early == {("text lacks a word", "welcome everyone")}


@pytest.mark.slow
def test_a_fact_that_is_never_cleared_is_a_flaw(tmp_path: Path) -> None:
    assert ("fact never cleared", "answer") in flaws(tmp_path, ('"clear answer", ', ""))


@pytest.mark.slow
def test_a_behaviour_that_is_never_possible_is_a_flaw(tmp_path: Path) -> None:
    needs = 'needs = ["open is yes", "open is no"]\n'
    never = ('[behaviours."tell scores"]\n', f'[behaviours."tell scores"]\n{needs}')
    assert ("behaviour never possible", "tell scores") in flaws(tmp_path, never)


def test_a_cut_search_names_its_limit_and_what_it_did_not_reach() -> None:
    found = findings(declared("trivia"), Limit(states=40, seconds=10.0))
    assert {one.cut for one in found.searches} == {"states"}
    assert all(0 < one.states <= 40 for one in found.searches)
    assert "over" in {one.name for one in found.not_met}
    assert found.flaws == ()


@pytest.mark.slow
def test_a_cut_search_names_the_facts_with_the_most_states() -> None:
    found = findings(declared("exercises"), Limit(states=2_000, seconds=30.0))
    named = {share.name: share.times for one in found.searches for share in one.shares}
    assert "asking" in named
    assert all(times >= TELLING for times in named.values())
    (line,) = (one for one in search_lines(found, teams=False) if "the most states" in one)
    assert "the requests for help" in line
    whole = search_lines(findings(declared("trivia")), teams=False)
    assert not any("the most states" in one for one in whole)


@pytest.mark.slow
def test_a_search_ends_at_its_time_limit() -> None:
    found = findings(declared("exercises"), Limit(states=12_000, seconds=0.2))
    whole = findings(declared("trivia"))
    assert found.searches[-1].cut == "time"
    assert [one.cut for one in whole.searches] == ["", "", ""]
    assert [one.players for one in whole.searches] == [1, 2, 2]
