"""The reasons for a decision, missing situations, and differences between two policies."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import count
from pathlib import Path

import pytest

from tangy_profiles.activity import Activity
from tangy_profiles.codec import encode
from tangy_profiles.demonstration import Demonstration
from tangy_profiles.errors import TangyError
from tangy_profiles.state import Situation
from tangy_profiles.store import Store
from tangy_profiles.teaching_records import (
    DemonstrationBegun,
    DemonstrationFinished,
    DemonstrationStep,
)
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.comparison import compare, find_policy
from tangy_tui.learning.conflicts import find_conflicts
from tangy_tui.learning.coverage import coverage, missing_words
from tangy_tui.learning.explanation import explain, foresee
from tangy_tui.learning.library import read_library
from tangy_tui.learning.policies import keep_policy, stored_policies
from tangy_tui.learning.policy import ForestSettings, NothingToLearnFrom, learn_policy
from tangy_tui.text.decisions import shown_words, why_words
from tests.support.append_body import append_body

Demonstrate = Callable[[str, int, int], Demonstration]
FEW = ForestSettings(trees=5)
WRONG = Situation("help", "AR", "incorrectly marked")


@pytest.fixture
def shown(demonstrate: Demonstrate) -> list[Demonstration]:
    """Two demonstrations with numbered steps."""
    ids = count(1)
    given = [demonstrate("bingo", seed, 4) for seed in (1, 2)]
    return [replace(d, steps=tuple(replace(s, id=next(ids)) for s in d.steps)) for d in given]


def log(store: Store, shown: Demonstration, teacher: str) -> None:
    """Log a demonstration as a teaching session does."""
    name = {"demonstration": shown.id}
    append_body(
        store,
        DemonstrationBegun,
        {**name, "activity": shown.activity, "teacher": teacher, "seed": 1, "people": ["user1"]},
    )
    for step in shown.steps:
        append_body(store, DemonstrationStep, {**name, **encode(step)})
    append_body(store, DemonstrationFinished, name)


def without(shown: Demonstration, situation: Situation) -> Demonstration:
    steps = tuple(s for s in shown.steps if s.state.situation != situation)
    return replace(shown, steps=steps)


# ------------------------------------------------------------------------------------ reasons


def test_an_explanation_lists_exactly_the_steps_of_its_situation(
    shown: list[Demonstration], activity: Activity
) -> None:
    policy = learn_policy(activity, shown, settings=FEW)
    for situation in activity.situations:
        why = explain(policy, shown, situation)
        there = [
            (d.id, n)
            for d in shown
            for n, s in enumerate(d.steps, 1)
            if s.state.situation == situation
        ]
        assert [(s.demonstration, s.number) for s in why.rests_on] == there
        assert why.decision.seen == len(there)
        assert why.against == ()
        assert bool(why.near) == (not there)


def test_an_explanation_uses_only_the_training_demonstrations(
    shown: list[Demonstration], activity: Activity
) -> None:
    policy = learn_policy(activity, shown[:1], settings=FEW)
    why = explain(policy, shown, activity.situations[0])
    assert {s.demonstration for s in why.steps} == {shown[0].id}


def test_an_undemonstrated_situation_lists_the_nearest_steps(
    shown: list[Demonstration], activity: Activity
) -> None:
    poorer = [without(d, WRONG) for d in shown]
    policy = learn_policy(activity, poorer, settings=FEW)
    why = explain(policy, poorer, WRONG)
    assert why.rests_on == ()
    assert {s.step.state.situation for s in why.near} <= {
        s for s in activity.situations if sum(a != b for a, b in zip(s, WRONG, strict=True)) == 1
    }
    words = " ".join(why_words(activity, why))
    assert "Nobody has shown Tangy what to do here" in words
    assert "helping: wrong marks" in words
    done = activity.behaviour_words(why.decision.behaviour)
    assert f"{done} {why.decision.share:.0%}" in words


def test_an_explanation_includes_a_conflict_and_its_resolution(
    shown: list[Demonstration], activity: Activity
) -> None:
    first = shown[0].steps[0]
    stray = replace(first, behaviour="joke", id=9_999)
    other = replace(shown[1], teacher="Bea", steps=(stray, *shown[1].steps))
    both = [shown[0], other]
    open_why = explain(learn_policy(activity, both, settings=FEW), both, first.state.situation)
    assert "Demonstrations disagree" in " ".join(why_words(activity, open_why))
    (conflict,) = find_conflicts(both)
    said = conflict.resolved(first.behaviour)
    policy = learn_policy(activity, both, resolutions=[said], settings=FEW)
    why = explain(policy, both, first.state.situation)
    assert [(s.teacher, s.step.behaviour) for s in why.against] == [("Bea", "joke")]
    assert "A teacher said that 'greet everyone' is right" in " ".join(why_words(activity, why))
    assert shown_words(activity, why.against[0], lambda id: f"game {id}") == (
        f"tell a joke: step 1 of game {other.id}, by Bea"
    )


def test_a_preview_includes_the_current_demonstration(
    store: Store, shown: list[Demonstration], activity: Activity
) -> None:
    with pytest.raises(NothingToLearnFrom):
        foresee(store, activity, None)
    begun = replace(shown[0], steps=shown[0].steps[:2], finished=False)
    assert foresee(store, activity, begun).decide(activity.situations[0]).seen == 1
    log(store, shown[1], "Ada")
    now = foresee(store, activity, begun)
    assert now.demonstrations == (shown[1].id, begun.id)
    again = replace(begun, of=(shown[1].id,), origin="again")
    assert foresee(store, activity, again).demonstrations == (begun.id,)


# ----------------------------------------------------------------------------------- coverage


def test_coverage_counts_the_steps_of_each_situation(
    shown: list[Demonstration], activity: Activity
) -> None:
    poorer = [without(d, WRONG) for d in shown]
    found = coverage(activity, poorer)
    assert list(found.times) == list(activity.situations)
    assert sum(found.times.values()) == sum(len(d.steps) for d in poorer)
    assert WRONG in found.missing
    assert set(found.seen) | set(found.missing) == set(activity.situations)
    assert "helping: wrong marks" in missing_words(activity, found)


def test_an_activity_without_own_words_is_described_by_its_values(lanterns: Activity) -> None:
    found = coverage(lanterns, [])
    for situation, words in zip(found.missing, missing_words(lanterns, found), strict=True):
        assert lanterns.in_words(situation) in words


def test_what_is_missing_has_the_words_of_the_steps(activity: Activity) -> None:
    words = missing_words(activity, coverage(activity, []))
    assert len(set(words)) == len(activity.situations)
    assert words == [activity.in_words(situation) for situation in activity.situations]


# ---------------------------------------------------------------------------------- comparing


@pytest.fixture
def two_teachers(store: Store, shown: list[Demonstration], activity: Activity) -> Store:
    """A log in which Ada shows the expected behaviours, and Bea jokes at wrong marks."""
    steps = tuple(
        replace(s, behaviour="joke") if s.state.situation == WRONG else s for s in shown[1].steps
    )
    with store.transaction():
        log(store, shown[0], "Ada")
        log(store, replace(shown[1], steps=steps), "Bea")
        library = read_library(store, "bingo")
        for name, used in (("early", library.finished[:1]), ("late", library.finished)):
            keep_policy(store, learn_policy(activity, used, settings=FEW, name=name))
    return store


def test_two_teachers_are_compared_row_by_row(two_teachers: Store, activity: Activity) -> None:
    ada, _ = find_policy(two_teachers, activity, "Ada")
    bea, _ = find_policy(two_teachers, activity, "teacher:Bea")
    rows = compare(activity, ada, bea)
    assert [row.situation for row in rows] == list(activity.situations)
    differ = {row.situation for row in rows if not row.same}
    assert WRONG in differ
    assert all((r.a.behaviour, r.a.sure) != (r.b.behaviour, r.b.sure) for r in rows if not r.same)
    assert all(row.same for row in compare(activity, ada, ada))


def test_two_versions_of_a_policy_are_compared(two_teachers: Store, activity: Activity) -> None:
    before, _ = find_policy(two_teachers, activity, "last~1")
    after, _ = find_policy(two_teachers, activity, "last")
    assert (before.name, after.name) == ("early", "late")
    (row,) = [r for r in compare(activity, before, after) if r.situation == WRONG]
    assert row.b.contested
    assert not row.same


def test_a_policy_is_found_by_name_and_digest(two_teachers: Store, activity: Activity) -> None:
    early, notices = find_policy(two_teachers, activity, "early")
    assert (early.name, notices) == ("early", [])
    assert find_policy(two_teachers, activity, early.digest[:8])[0] == early


@pytest.mark.parametrize("wanted", ["Cleo", "last~7", "policy:Ada", "teacher:late", "", "la"])
def test_an_unknown_policy_is_refused_with_suggestions(
    wanted: str, two_teachers: Store, activity: Activity
) -> None:
    with pytest.raises(TangyError, match=r"did you mean|choose one of|were learnt"):
        find_policy(two_teachers, activity, wanted)


def test_a_data_folder_opens_every_policy_by_name(taught: Path) -> None:
    workspace = Workspace(taught, write=False)
    try:
        store, activity = workspace.store, workspace.activity
        (kept,) = stored_policies(store, activity.name)
        found = [find_policy(store, activity, name) for name in (kept.name, "scripted")]
        assert [notices for _, notices in found] == [[], []]
        learnt, shown = (policy for policy, _ in found)
        assert (learnt.name, learnt.digest) == (kept.name, kept.digest)
        assert (shown.name, len(shown.demonstrations)) == ("scripted", 3)
        assert all(row.same for row in compare(activity, learnt, shown))
        assert learnt.exact(activity)
    finally:
        workspace.close()
