"""Demonstrations and policies are read from the log, and differences of a policy are reported."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import pytest

from tangy_profiles.activity import Activity
from tangy_profiles.codec import encode
from tangy_profiles.demonstration import Demonstration
from tangy_profiles.errors import TangyError
from tangy_profiles.state import Situation
from tangy_profiles.store import Store
from tangy_profiles.teaching_records import (
    DemonstrationFinished,
    DemonstrationStep,
    DemonstrationStepUndone,
    LearntRow,
    PolicyLearnt,
)
from tangy_tui.learning.library import read_demonstrations, read_library
from tangy_tui.learning.policies import (
    ASKS,
    GONE,
    DecisionChange,
    NoPolicy,
    NotAsKept,
    changes,
    check_name,
    keep_policy,
    load_policy,
    unused_name,
)
from tangy_tui.learning.policy import ForestSettings, Policy, learn_policy
from tangy_tui.text.policies import notice_words
from tests.shown import log_demonstration
from tests.support.append_body import append_body

Demonstrate = Callable[[str, int, int], Demonstration]
FEW = ForestSettings(trees=5)


@pytest.fixture
def shown(store: Store, demonstrate: Demonstrate) -> list[Demonstration]:
    """Two logged demonstrations."""
    given = [replace(demonstrate("bingo", seed, 4), teacher=f"Ada {seed}") for seed in (1, 2)]
    for one in given:
        log_demonstration(store, one)
    return given


def learnt(activity: Activity, shown: list[Demonstration], store: Store) -> Policy:
    policy = learn_policy(activity, shown, settings=FEW)
    keep_policy(store, policy)
    return policy


def with_kept(store: Store, change: Mapping[str, Any]) -> None:
    """Log the last policy once more, as if its result had been different."""
    kept = store.last(PolicyLearnt)
    assert kept is not None
    append_body(store, PolicyLearnt, {**kept.body, **change})


# ------------------------------------------------------------------------------ demonstrations


def test_logged_demonstrations_are_read_back_unchanged(
    store: Store, shown: list[Demonstration]
) -> None:
    assert read_demonstrations(store, "bingo") == shown
    assert read_demonstrations(store, "lanterns") == []


def test_interleaved_demonstrations_are_separated(store: Store, demonstrate: Demonstrate) -> None:
    one, other = demonstrate("bingo", 1, 4), demonstrate("bingo", 2, 4)
    log_demonstration(store, replace(one, steps=one.steps[:3], finished=False))
    log_demonstration(store, other)
    append_body(store, DemonstrationStep, {"demonstration": one.id, **encode(one.steps[3])})
    found = read_demonstrations(store, "bingo")
    assert found == [replace(one, steps=one.steps[:4], finished=False), other]


def test_a_library_is_read_again_only_after_a_change(
    store: Store, shown: list[Demonstration], monkeypatch: pytest.MonkeyPatch
) -> None:
    reads = list[tuple[object, ...]]()
    events = Store.events

    def counted(log: Store, *kinds: Any, after: int = 0) -> Any:
        reads.append(kinds)
        return events(log, *kinds, after=after)

    monkeypatch.setattr(Store, "events", counted)
    first = read_library(store, "bingo")
    first.entries.clear()  # the caller owns this copy
    assert read_demonstrations(store, "bingo") == shown and len(reads) == 1
    step = DemonstrationStepUndone(demonstration=shown[0].id, step=1)
    with pytest.raises(RuntimeError), store.transaction():
        store.append(step)
        assert len(read_demonstrations(store, "bingo")[0].steps) == 0
        raise RuntimeError
    assert read_demonstrations(store, "bingo") == shown  # the step was rolled back
    store.append(step)
    assert len(read_demonstrations(store, "bingo")[0].steps) == 0
    assert read_library(store, "lanterns").entries == {}


def test_undoing_the_last_step_reopens_the_demonstration(
    store: Store, shown: list[Demonstration]
) -> None:
    append_body(
        store, DemonstrationStepUndone, {"demonstration": shown[0].id, "step": len(shown[0].steps)}
    )
    assert read_demonstrations(store, "bingo")[0] == shown[0].without_last()


def test_steps_of_unknown_demonstrations_are_ignored(
    store: Store, shown: list[Demonstration]
) -> None:
    for kind in (DemonstrationStep, DemonstrationStepUndone, DemonstrationFinished):
        append_body(store, kind, {"demonstration": "nobody's", **encode(shown[0].steps[0])})
    assert read_demonstrations(store, "bingo") == shown


# ------------------------------------------------------------------------------------- policies


def test_a_missing_policy_is_reported_with_the_command_to_learn_one(
    store: Store, activity: Activity
) -> None:
    with pytest.raises(NoPolicy, match=r"not learnt Bingo yet.*`tangy teach`.*`tangy learn`"):
        load_policy(store, activity)


def test_a_stored_policy_is_read_back_unchanged(
    store: Store, activity: Activity, shown: list[Demonstration]
) -> None:
    policy = learnt(activity, shown, store)
    again, notices = load_policy(store, activity)
    assert notices == []
    assert again == policy


def test_the_newest_policy_of_each_activity_is_loaded(
    store: Store,
    activity: Activity,
    lanterns: Activity,
    shown: list[Demonstration],
    demonstrate: Demonstrate,
) -> None:
    learnt(activity, shown, store)
    last = learnt(activity, shown[:1], store)
    made_up = demonstrate("lanterns", 1, 4)
    log_demonstration(store, made_up)
    other = learnt(lanterns, [made_up], store)
    assert load_policy(store, activity)[0] == last
    assert load_policy(store, lanterns)[0] == other


def test_later_demonstrations_do_not_change_a_stored_policy(
    store: Store, activity: Activity, shown: list[Demonstration], demonstrate: Demonstrate
) -> None:
    policy = learnt(activity, shown, store)
    log_demonstration(store, demonstrate("bingo", 3, 4))
    assert load_policy(store, activity) == (policy, [])


def test_a_policy_without_its_demonstrations_is_refused(
    store: Store, activity: Activity, shown: list[Demonstration]
) -> None:
    learnt(activity, shown, store)
    with_kept(store, {"demonstrations": ["gone", *[d.id for d in shown]]})
    with pytest.raises(NoPolicy, match="1 demonstrations that are not in this data folder"):
        load_policy(store, activity)


def test_another_version_with_equal_decisions_is_reported(
    store: Store, activity: Activity, shown: list[Demonstration]
) -> None:
    policy = learnt(activity, shown, store)
    versions = {**policy.versions, "scikit-learn": "0.1"}
    with_kept(store, {"digest": "other", "versions": versions})
    _, notices = load_policy(store, activity)
    moved = (("scikit-learn", "0.1", policy.versions["scikit-learn"]),)
    assert notices == [NotAsKept(policy.name, moved, ())]


def test_changed_decisions_are_reported_row_by_row(
    store: Store, activity: Activity, shown: list[Demonstration]
) -> None:
    policy = learnt(activity, shown, store)
    rows = policy.record().body["rows"]
    where, was = Situation(*rows[0][:3]), rows[0][3]
    rows[0][3] = "juggle"
    with_kept(store, {"digest": "other", "rows": rows})
    _, notices = load_policy(store, activity)
    assert notices == [NotAsKept(policy.name, (), (DecisionChange(where, "juggle", was),))]
    told = notice_words(notices)
    assert "its demonstrations have changed since" in told[0]
    assert f"{' / '.join(where)}: was juggle, is now {was}." in told


def test_a_step_undone_after_learning_is_reported(
    store: Store, activity: Activity, shown: list[Demonstration]
) -> None:
    learnt(activity, shown, store)
    append_body(
        store, DemonstrationStepUndone, {"demonstration": shown[0].id, "step": len(shown[0].steps)}
    )
    _, notices = load_policy(store, activity)
    (notice,) = notices
    assert isinstance(notice, NotAsKept)
    assert notice.versions == ()


def test_policies_are_compared_by_their_decisions(
    activity: Activity, shown: list[Demonstration]
) -> None:
    policy = learn_policy(activity, shown, settings=FEW)
    kept = policy.record()
    assert changes(kept, policy) == []
    gone = LearntRow("nowhere", "AR", "odd", "joke", 1.0)
    (change,) = changes(replace(kept, rows=(*kept.rows, gone)), policy)
    assert change == DecisionChange(Situation("nowhere", "AR", "odd"), "joke", GONE)
    start = activity.situations[0]
    assert changes(replace(kept, asks=(start,)), policy) == [
        DecisionChange(start, ASKS, "greeting")
    ]
    fewer = tuple(row for row in kept.rows if row.stage != "start")
    assert changes(replace(kept, rows=fewer), policy) == [DecisionChange(start, ASKS, "greeting")]
    assert changes(replace(kept, asks=None), policy) == []


def test_a_newly_contested_row_is_a_difference(
    activity: Activity, shown: list[Demonstration]
) -> None:
    kept = learn_policy(activity, shown, settings=FEW).record()
    first = shown[0].steps[0]
    stray = replace(shown[0], steps=(replace(first, behaviour="joke"), *shown[0].steps))
    now = learn_policy(activity, [stray, *shown[1:]], settings=FEW)
    assert changes(kept, now) == [DecisionChange(first.state.situation, "greeting", ASKS)]


def test_a_default_name_is_never_given_to_two_policies(
    store: Store, activity: Activity, shown: list[Demonstration]
) -> None:
    first = learn_policy(activity, shown[:1], settings=FEW)
    other = learn_policy(activity, shown[1:], settings=FEW)
    keep_policy(store, unused_name(store, first))
    assert unused_name(store, first).name == "bingo-1"
    named = unused_name(store, other)
    assert named.name == "bingo-1.2"
    keep_policy(store, named)
    assert load_policy(store, activity, "bingo-1")[0] == first
    for name in ("last", "last~2", "policy:x", "teacher:Ada"):
        with pytest.raises(TangyError, match="choose another name"):
            check_name(name)
    check_name("lasting")
