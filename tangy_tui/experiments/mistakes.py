"""Wrong answers in demonstrations: are they found, and is the policy right after settling them?

A share of the steps of complete demonstrations gets a wrong answer: anywhere, in the most frequent
situation, or in the rarest ones. Only the answers change, not the steps, so the number and place of
wrong answers are exactly as planned.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import replace
from random import Random
from typing import Any

from tangy_profiles.activity import Activity
from tangy_profiles.demonstration import Demonstration, Step
from tangy_profiles.state import Situation
from tangy_tui.experiments.classroom import (
    RANDOM,
    Course,
    about,
    activity_of,
    course_number,
    covered,
    is_exact,
    learnt,
    taught,
)
from tangy_tui.experiments.estimates import share_of
from tangy_tui.experiments.incremental import flagged, flagged_shares
from tangy_tui.experiments.published import SCENARIO_ONE, USERS
from tangy_tui.experiments.sweep import Case, Settings, Sweep, Where
from tangy_tui.experiments.teachers import resolved
from tangy_tui.learning.conflicts import find_conflicts

RATES = (0.01, 0.02, 0.03, 0.05)
PLACES = ("anywhere", "commonest", "rarest")


def with_mistakes(settings: Settings, case: Case) -> dict[str, Any]:
    """Learn from demonstrations with wrong answers: a case is (share wrong, place, seed).

    Returns:
        The number of `wrong` steps, how many of them are in a detected conflict, the number of
        situations with contradicting answers and how many were detected, whether the policy was
        exact before and after a teacher settled the conflicts, `flagged` counts before and after,
        and `silent`: the number of situations without any right answer left.
    """
    rate, place, seed = case
    activity = activity_of(settings["activity"])
    clean: list[Demonstration] = []
    course = Course(settings["activity"], USERS, RANDOM, course_number("mistakes", seed))
    for demonstration in taught(course):
        clean.append(demonstration)
        if len(clean) >= int(SCENARIO_ONE["demonstrations"]) and covered(activity, clean):
            break
    rng = Random(f"{seed}/{place}/{rate}")
    wrong = places(activity, clean, rate, place, rng)
    shown = [_spoilt(activity, demonstration, wrong, rng) for demonstration in clean]
    answers: dict[Situation, set[str]] = defaultdict(set)
    for step in (step for one in shown for step in one.steps):
        answers[step.state.situation].add(step.behaviour)
    contradicted = {situation for situation, given in answers.items() if len(given) > 1}
    found = {conflict.situation for conflict in find_conflicts(shown)}
    before = learnt(activity, shown)
    after = learnt(activity, shown, resolved(activity, shown))
    return {
        "steps": sum(len(one.steps) for one in shown),
        "wrong": len(wrong),
        "wrong_in_conflict": sum(
            step.id in wrong and step.state.situation in found
            for one in shown
            for step in one.steps
        ),
        "contradicted": len(contradicted),
        "found": len(contradicted & found),
        "silent": sum(activity.expected[s] not in given for s, given in answers.items()),
        "exact_before": is_exact(before, activity, USERS),
        "exact_after": is_exact(after, activity, USERS),
        "flags_before": flagged(before, activity),
        "flags_after": flagged(after, activity),
    }


def places(
    activity: Activity, shown: Sequence[Demonstration], rate: float, place: str, rng: Random
) -> set[int]:
    """Choose the steps (ids) to make wrong, a share `rate` (0 to 1) of all steps.

    For "commonest" all are in the most frequent situation. For "rarest" the situations get one
    wrong answer each, in order of frequency and then again from the rarest. Each situation keeps at
    least one right answer. For "anywhere" there is no restriction.
    """
    steps = [step for one in shown for step in one.steps]
    wanted = round(rate * len(steps))
    if place == "anywhere":
        return {step.id for step in rng.sample(steps, wanted)}
    of_situation: dict[Situation, list[Step]] = defaultdict(list)
    for step in steps:
        of_situation[step.state.situation].append(step)
    ordered = sorted(
        of_situation.values(), key=lambda group: (len(group), group[0].state.situation)
    )
    if place == "commonest":
        return {step.id for step in rng.sample(ordered[-1], min(wanted, len(ordered[-1]) - 1))}
    for group in ordered:
        rng.shuffle(group)
        group.pop()  # stays right
    chosen: set[int] = set()
    while len(chosen) < wanted and any(ordered):
        for group in ordered:
            if group and len(chosen) < wanted:
                chosen.add(group.pop().id)
    return chosen


def _spoilt(
    activity: Activity, demonstration: Demonstration, wrong: set[int], rng: Random
) -> Demonstration:
    def answer(step: Step) -> Step:
        if step.id not in wrong:
            return step
        others = [name for name in activity.behaviours if name != step.behaviour]
        return replace(step, behaviour=others[int(rng.random() * len(others))])

    return replace(demonstration, steps=tuple(answer(step) for step in demonstration.steps))


def run(activity: str, seeds: Sequence[int], where: Where) -> list[dict[str, Any]]:
    """Run every rate at every place; one row each, the first one without mistakes."""
    kinds = [(0.0, PLACES[0]), *((rate, place) for place in PLACES for rate in RATES)]
    cases = [(rate, place, seed) for rate, place in kinds for seed in seeds]
    results = Sweep("mistakes", with_mistakes, about(activity), cases).run(where)
    rows = []
    for at, (rate, place) in enumerate(kinds):
        some = results[at * len(seeds) : (at + 1) * len(seeds)]
        rows.append({"rate": rate, "placed": place, "n": len(some), **_row(some)})
    return rows


def _row(results: Sequence[dict[str, Any]]) -> dict[str, Any]:
    def total(key: str) -> int:
        return sum(result[key] for result in results)

    return {
        "wrong": total("wrong"),
        "wrong_in_conflict": total("wrong_in_conflict") / total("wrong")
        if total("wrong")
        else None,
        "conflicts": total("contradicted"),
        "conflicts_found": total("found") / total("contradicted")
        if total("contradicted")
        else None,
        "no_right_answer_left": total("silent"),
        "exact_before": share_of([result["exact_before"] for result in results]),
        "exact_after": share_of([result["exact_after"] for result in results]),
        "before": flagged_shares([result["flags_before"] for result in results]),
        "after": flagged_shares([result["flags_after"] for result in results]),
    }
