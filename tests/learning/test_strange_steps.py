"""Steps that the activity does not know: one is a bad row, many are another activity."""

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


def test_one_is_left_out_by_name_and_the_rest_is_learnt(activity: Activity, cover: Cover) -> None:
    first, *others = cover("bingo", 1, 4)
    used, notices = without_strange_steps(activity, [misnamed(first, 3), *others])
    (notice,) = notices
    assert (notice.demonstration, notice.number, notice.activity) == (first.id, 3, "Bingo")
    assert len(used[0].steps) == len(first.steps) - 1 and used[1:] == others
    learn_policy(activity, used, settings=ForestSettings(trees=3))


def test_where_nothing_is_strange_all_is_as_it_was(activity: Activity, cover: Cover) -> None:
    shown = cover("bingo", 1, 4)
    assert without_strange_steps(activity, shown) == (list(shown), [])


def test_where_there_are_many_the_activity_was_changed(activity: Activity, cover: Cover) -> None:
    shown = [misnamed(one, *range(1, 99, 2)) for one in cover("bingo", 1, 4)]
    used, notices = without_strange_steps(activity, shown)
    assert (used, notices) == (shown, [])
    with pytest.raises(NotOfThisActivity):
        learn_policy(activity, used, settings=ForestSettings(trees=3))
