"""Steps unknown to the activity: one is a bad row, many mean another activity."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import pytest

from tangy_profiles.activity import Activity
from tangy_profiles.demonstration import Demonstration
from tangy_tui.learning.policies import without_strange_steps
from tangy_tui.learning.policy import ForestSettings, NotOfThisActivity, learn_policy

Cover = Callable[[str, int, int], tuple[Demonstration, ...]]


def misnamed(shown: Demonstration, *numbers: int) -> Demonstration:
    steps = [
        replace(step, behaviour="call nummer") if number in numbers else step
        for number, step in enumerate(shown.steps, 1)
    ]
    return replace(shown, steps=tuple(steps))


def test_an_unknown_step_is_reported_and_dropped(activity: Activity, cover: Cover) -> None:
    first, *others = cover("bingo", 1, 4)
    used, notices = without_strange_steps(activity, [misnamed(first, 3), *others])
    (notice,) = notices
    assert (notice.demonstration, notice.number, notice.activity) == (first.id, 3, "Bingo")
    assert len(used[0].steps) == len(first.steps) - 1 and used[1:] == others
    learn_policy(activity, used, settings=ForestSettings(trees=3))


def test_demonstrations_without_unknown_steps_are_unchanged(
    activity: Activity, cover: Cover
) -> None:
    shown = cover("bingo", 1, 4)
    assert without_strange_steps(activity, shown) == (list(shown), [])


def test_many_unknown_steps_mean_a_changed_activity(activity: Activity, cover: Cover) -> None:
    shown = [misnamed(one, *range(1, 99, 2)) for one in cover("bingo", 1, 4)]
    used, notices = without_strange_steps(activity, shown)
    assert (used, notices) == (shown, [])
    with pytest.raises(NotOfThisActivity):
        learn_policy(activity, used, settings=ForestSettings(trees=3))
