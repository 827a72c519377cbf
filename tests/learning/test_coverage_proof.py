"""The proof of coverage names the groups that it covers, and the searches that were cut."""

from __future__ import annotations

from tangy_profiles.declared.checking import expected_moves
from tangy_profiles.declared.search import Limit
from tangy_tui.learning.coverage_proof import search_groups
from tangy_tui.text.activity_search import proof_words
from tests.support.declared import declared


def test_the_proof_names_the_group_sizes_that_it_covers() -> None:
    activity = declared("trivia")
    found = search_groups(activity, expected_moves(activity))
    assert (found.proved, found.whole, found.open) == ((1, 2, 3), True, {})
    teams = declared("team-trivia")
    assert search_groups(teams, expected_moves(teams)).proved == (len(teams.teams),)


def test_an_incomplete_search_proves_nothing() -> None:
    activity = declared("trivia")
    small = Limit(states=100, seconds=10.0)
    found = search_groups(activity, expected_moves(activity), largest=small)
    assert found.proved == (1, 2)
    assert [one.cut for _, one in found.searches] == ["", "", "states"]
    assert found.searches[-1][1].states <= small.states
    cut = search_groups(activity, expected_moves(activity), limit=small)
    assert (cut.whole, cut.proved) == (False, ())


def test_the_words_claim_only_the_searched_groups() -> None:
    activity = declared("trivia")
    shown = expected_moves(activity)
    three = " ".join(proof_words(activity, search_groups(activity, shown)))
    assert "all games of 1, 2 and 3 players" in three
    small = Limit(states=100, seconds=10.0)
    none = " ".join(proof_words(activity, search_groups(activity, shown, limit=small)))
    assert "searched all games" not in none
    assert "could not search all games of 1 player" in none


def test_an_undemonstrated_situation_stays_open_in_every_group_size() -> None:
    activity = declared("trivia")
    shown = expected_moves(activity)
    left_out = next(one for one in shown.shown if one.stage == "over")
    del shown.shown[left_out]
    found = search_groups(activity, shown)
    assert found.open[left_out] == ""
    assert found.whole
