"""The forest: exact after any covering demonstration, reproducible, and marked where unsure."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import warnings
from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from math import isclose

import pytest

from tangy_profiles.activity import Activity
from tangy_profiles.codec import encode
from tangy_profiles.demonstration import Demonstration, Step
from tangy_profiles.state import FRONT, ActivityState, Situation
from tangy_tui.learning.conflicts import find_conflicts, training_rows
from tangy_tui.learning.policy import (
    EXACT,
    PAPER,
    ForestSettings,
    NothingToLearnFrom,
    NotOfThisActivity,
    Policy,
    all_situations,
    grown,
    learn_policy,
)
from tangy_tui.learning.reachable import joint_states

Cover = Callable[[str, int, int], tuple[Demonstration, ...]]
FEW = ForestSettings(trees=5)
"""For guarantees that do not depend on the number of trees."""


def showing(*rows: tuple[Situation, str], id: str = "made") -> Demonstration:
    """A demonstration of only these situations and behaviours."""
    steps = []
    for situation, behaviour in rows:
        state = ActivityState(0, situation, FRONT, None, ())
        steps.append(Step(behaviour, None, state, state))
    return Demonstration(id, "bingo", "test", 0, (), tuple(steps), True)


def everything(activity: Activity, *without: Situation) -> list[tuple[Situation, str]]:
    return [row for row in activity.expected.items() if row[0] not in without]


# ------------------------------------------------------------------------------- exactness


@pytest.mark.slow
@pytest.mark.parametrize("first", range(0, 50, 10))
def test_the_policy_is_exact_after_any_covering_demonstration(
    first: int, activity: Activity, cover: Cover
) -> None:
    for seed in range(first, first + 10):
        shown = cover("bingo", seed, 1 + seed % 8)
        policy = learn_policy(activity, shown, settings=replace(EXACT, seed=seed))
        assert policy.exact(activity)
        for situation in activity.situations:
            decision = policy.decide(situation)
            assert (decision.behaviour, decision.share) == (activity.expected[situation], 1.0)
            assert decision.sure


@pytest.mark.slow
def test_the_bagging_of_the_paper_is_exact_with_lower_votes(
    activity: Activity, cover: Cover
) -> None:
    for seed in range(10):
        shown = cover("bingo", seed, 1 + seed % 8)
        policy = learn_policy(activity, shown, settings=replace(PAPER, seed=seed))
        assert policy.exact(activity)
        assert 0.4 < min(policy.decide(s).share for s in activity.situations) < 1


@pytest.mark.parametrize("users", range(1, 9))
def test_every_reachable_joint_state_is_decided_as_expected(
    users: int, activity: Activity, cover: Cover
) -> None:
    policy = learn_policy(activity, cover("bingo", users, users), settings=FEW)
    for state in joint_states(activity, [f"user{n}" for n in range(users)]):
        wanted = activity.expected[state.situation]
        assert policy.decide(state.situation).behaviour == wanted


@pytest.mark.slow
def test_the_policy_is_exact_despite_imbalanced_demonstrations(
    activity: Activity,
) -> None:
    often = Situation("facilitate", "ANR", "occluded")
    rows = everything(activity) + [(often, "call number")] * 99
    for settings in (EXACT, PAPER):
        assert learn_policy(activity, [showing(*rows)], settings=settings).exact(activity)


def test_a_made_up_activity_is_learnt_exactly(lanterns: Activity, cover: Cover) -> None:
    policy = learn_policy(lanterns, cover("lanterns", 1, 5))
    assert policy.exact(lanterns)
    assert {policy.decide(s).behaviour for s in lanterns.situations} == set(lanterns.behaviours)


# -------------------------------------------------------------------------- reproducibility


def test_the_policy_depends_only_on_the_rows(activity: Activity) -> None:
    rows = everything(activity)
    one = learn_policy(activity, [showing(*rows)], settings=FEW)
    parts = [showing(*rows[:4], id="a"), showing(*rows[4:], id="b")]
    grown.cache_clear()  # grows the same trees again instead of remembering them
    other = learn_policy(activity, parts, settings=FEW, name="other")
    assert other.table == one.table
    assert other.digest == one.digest
    assert (other.name, other.demonstrations) == ("other", ("a", "b"))


def test_the_digest_changes_with_rows_settings_and_seed(activity: Activity) -> None:
    rows = everything(activity)
    learnt = [
        learn_policy(activity, [showing(*rows)], settings=FEW),
        learn_policy(activity, [showing(*reversed(rows))], settings=FEW),
        learn_policy(activity, [showing(*rows, rows[0])], settings=FEW),
        learn_policy(activity, [showing(*rows)], settings=replace(FEW, seed=1)),
        learn_policy(activity, [showing(*rows)], settings=replace(FEW, trees=6)),
        learn_policy(activity, [showing(*rows)], settings=replace(FEW, bootstrap=True)),
    ]
    assert len({policy.digest for policy in learnt}) == len(learnt)
    alike = [learn_policy(activity, [showing(rows[0])], settings=s) for s in (EXACT, FEW)]
    assert alike[0].table == alike[1].table
    assert alike[0].digest != alike[1].digest


@pytest.mark.slow
def test_another_process_learns_an_identical_policy(
    activity: Activity, demonstrate: Callable[[str, int, int], Demonstration]
) -> None:
    shown = demonstrate("bingo", 5, 4)
    code = (
        "import sys, json\n"
        "from tangy_profiles.activity import load_activity\n"
        "from tangy_profiles.codec import decode\n"
        "from tangy_profiles.demonstration import Demonstration, Step\n"
        "from tangy_tui.learning.policy import PAPER, learn_policy\n"
        "steps = tuple(decode(Step, one) for one in json.load(sys.stdin))\n"
        "shown = Demonstration('x', 'bingo', 'test', 0, (), steps)\n"
        "print(learn_policy(load_activity('bingo'), [shown], settings=PAPER).digest)\n"
    )
    told = json.dumps([encode(step) for step in shown.steps])
    done = subprocess.run(  # noqa: S603 - this Python
        [sys.executable, "-c", code],
        input=told, capture_output=True, text=True, check=True,
        env={**os.environ, "PYTHONHASHSEED": "12345"},
    )  # fmt: skip
    assert done.stdout.strip() == learn_policy(activity, [shown], settings=PAPER).digest


@pytest.mark.parametrize("seed", [-1, 2**32, 10**30])
def test_any_whole_number_is_a_seed(seed: int, activity: Activity) -> None:
    settings = replace(FEW, seed=seed)
    policy = learn_policy(activity, [showing(*everything(activity))], settings=settings)
    assert policy.exact(activity)


# --------------------------------------------------------------------------------- the table


@pytest.fixture(scope="module")
def covered(activity: Activity, cover: Cover) -> Policy:
    return learn_policy(activity, cover("bingo", 1, 4), settings=FEW)


def test_there_is_a_decision_for_every_combination(activity: Activity, covered: Policy) -> None:
    assert list(covered.table) == list(all_situations(activity))
    assert len(covered.table) == 6 * 2 * 5
    assert set(activity.situations) < set(covered.table)


def test_votes_are_sorted_shares_and_the_first_decides(covered: Policy) -> None:
    for decision in covered.table.values():
        shares = [share for _, share in decision.votes]
        assert shares == sorted(shares, reverse=True)
        assert isclose(sum(shares), 1, abs_tol=1e-6)
        assert all(share > 0 for share in shares)
        assert (decision.behaviour, decision.share) == decision.votes[0]


def test_a_decision_counts_the_demonstrations_of_its_situation(
    activity: Activity, cover: Cover, covered: Policy
) -> None:
    rows, _ = training_rows(cover("bingo", 1, 4))
    counts = Counter(situation for situation, _ in rows)
    assert {s: d.seen for s, d in covered.table.items() if d.seen} == counts


def test_only_demonstrated_situations_are_sure(activity: Activity) -> None:
    for missing in activity.situations:
        shown = [showing(*everything(activity, missing))]
        policy = learn_policy(activity, shown, settings=FEW)
        unsure = {s for s in activity.situations if not policy.decide(s).sure}
        assert unsure == {missing}
        assert set(policy.errors(activity)) <= {missing}
        if policy.decide(missing).behaviour != activity.expected[missing]:
            assert not policy.exact(activity)


@pytest.mark.parametrize(("right", "wrong"), [(99, 1), (9, 1), (2, 1), (2, 2)])
def test_a_conflict_is_decided_by_a_teacher_and_not_by_votes(
    right: int, wrong: int, activity: Activity
) -> None:
    where = Situation("help", "AR", "missing numbers")
    rows = [
        *everything(activity, where),
        *[(where, "mark numbers")] * right,
        *[(where, "remove markers")] * wrong,
    ]
    shown = [showing(*rows)]
    decision = learn_policy(activity, shown, settings=FEW).decide(where)
    assert dict(decision.votes)["mark numbers"] == pytest.approx(right / (right + wrong))
    assert decision.contested
    assert not decision.sure
    (conflict,) = find_conflicts(shown)
    for answers in (("remove markers",), ("mark numbers",), ("mark numbers", "remove markers")):
        said = conflict.resolved(*answers)
        settled = learn_policy(activity, shown, resolutions=[said], settings=FEW).decide(where)
        assert settled.sure
        assert settled.behaviour in answers


def test_the_record_of_a_policy_is_plain_json(covered: Policy) -> None:
    kept = covered.record().body
    assert json.loads(json.dumps(kept)) == kept
    assert kept["digest"] == covered.digest
    assert kept["forest"] == {"trees": 5, "bootstrap": False, "min_samples_leaf": 1, "seed": 0}
    assert {"python", "numpy", "scikit-learn"} == set(kept["versions"])
    assert len(kept["rows"]) == 11


# ---------------------------------------------------------------------------------- refusals


def test_learning_without_steps_is_refused(activity: Activity) -> None:
    for shown in ([], [showing()]):
        with pytest.raises(NothingToLearnFrom, match="demonstrate a game first"):
            learn_policy(activity, shown)


def test_demonstrations_of_an_older_activity_are_refused(
    activity: Activity, lanterns: Activity
) -> None:
    rows = everything(activity)
    with pytest.raises(NotOfThisActivity, match="Lanterns has changed since"):
        learn_policy(lanterns, [showing(*rows)])
    with pytest.raises(NotOfThisActivity, match=r"no longer has the behaviour 'sing'.*old name"):
        learn_policy(activity, [showing(*rows, (rows[0][0], "sing"))])
    strange = rows[0][0]._replace(stage="supper")
    with pytest.raises(NotOfThisActivity, match=r"no longer has the situation 'supper.*old name"):
        learn_policy(activity, [showing(*rows, (strange, rows[0][1]))])


def test_a_situation_of_another_activity_has_no_decision(covered: Policy) -> None:
    with pytest.raises(KeyError):
        covered.decide(Situation("arriving", "ANR", "hidden"))


def test_a_short_game_of_many_behaviours_is_learnt_without_a_warning() -> None:
    situations = tuple(Situation("stage", "AR", str(number)) for number in range(24))
    rows = tuple((situation, f"behaviour {n}") for n, situation in enumerate(situations))
    assert len(rows) > 20, "scikit-learn says nothing of fewer"
    with warnings.catch_warnings(record=True) as warned:
        warnings.simplefilter("always")
        grown(ForestSettings(trees=2, seed=771), rows, situations)
        warnings.warn("another", UserWarning, stacklevel=1)
    assert [str(one.message) for one in warned] == ["another"]
