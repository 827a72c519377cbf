"""Drift detection: a changed preference is noticed, described, and its past forgotten."""

from __future__ import annotations

from random import Random

import pytest

from tangy_profiles.beliefs import Beta
from tangy_profiles.state import Response
from tangy_tui.app.workspace import Workspace
from tangy_tui.interaction.drift import ALARM, FEWEST, Drift, DriftWatch, change_point
from tangy_tui.interaction.feedback import Feedback
from tangy_tui.interaction.persuasion import Persuasion
from tangy_tui.text.people import drift_lines


def answers(seed: int, *parts: tuple[int, float]) -> list[bool]:
    draw = Random(f"drift/{seed}").random
    return [draw() < rate for times, rate in parts for _ in range(times)]


def test_the_change_point_is_found() -> None:
    assert change_point([True] * 20 + [False] * 10) == 20
    assert change_point([False] * 15 + [True] * 15) == 15


@pytest.mark.parametrize("responses", [[], [True], [True] * (FEWEST - 1), [False] * 200])
def test_uniform_or_few_responses_have_no_change_point(responses: list[bool]) -> None:
    assert change_point(responses) is None


@pytest.mark.parametrize("rate", [0.1, 0.4, 0.6, 0.9])
def test_the_false_alarm_rate_for_constant_people_is_low(rate: float) -> None:
    people = 60
    seen = sum(
        bool(DriftWatch(("praise", one) for one in answers(seed, (80, rate))).changes)
        for seed in range(people)
    )
    assert seen <= ALARM * people


def test_a_change_from_nine_in_ten_to_two_in_ten_is_noticed_soon() -> None:
    taken = []
    for seed in range(30):
        watch = DriftWatch()
        for number, complied in enumerate(answers(seed, (30, 0.9), (40, 0.2))):
            if watch.add("praise", complied) is not None:
                taken.append(number - 30)
                break
    assert len(taken) == 30 and sorted(taken)[15] < 20


def test_only_earlier_responses_of_the_changed_strategy_are_forgotten() -> None:
    responses = [("praise", True)] * 20 + [("neutral", True)] * 5 + [("praise", False)] * 10
    watch = DriftWatch(responses)
    prior = {"praise": Beta(), "neutral": Beta()}
    beliefs = watch.forgotten({"praise": Beta(21, 11), "neutral": Beta(6, 1)}, prior)
    assert (beliefs["praise"].alpha, beliefs["praise"].beta) == (1, 11)
    assert beliefs["neutral"] == Beta(6, 1)
    assert watch.drifts == (Drift("praise", (20, 0), (0, 10)),)
    assert watch.drifts[0].worse


def test_drift_detection_switches_the_strategy_sooner() -> None:
    def used(*, notices: bool) -> int:
        people = Persuasion(["a"], ["x", "y"], Random(4), notices_drift=notices)
        for _ in range(60):
            people.update(Response("a", "x", True, True, 0.0))
        times = 0
        for _ in range(60):
            strategy = people.choose("a").strategy
            times += strategy == "x"
            people.update(Response("a", strategy, True, strategy == "y", 0.0))
        return times

    assert used(notices=True) < 0.5 * used(notices=False)


def test_a_change_is_read_from_the_log_and_described_in_words(workspace: Workspace) -> None:
    rosa = workspace.people[0]
    feedback = Feedback(workspace.store)
    strategy, other, *_ = workspace.activity.strategies
    with workspace.store.transaction():
        for complied in (*[True] * 14, *[False] * 9):
            feedback.give(rosa.id, strategy, complied)
        feedback.give(rosa.id, other, True)
    (record,) = workspace.records(rosa)
    (line,) = drift_lines(record)
    assert strategy in line and rosa.name in line and "14 of 14" in line and "0 of 9" in line
    belief = record.beliefs[strategy]
    assert (belief.alpha, belief.beta) == (1, 10)
