"""Scenario 1, first part: how many demonstrations are needed for an exact policy.

A teacher demonstrates games one after another. After each, the policy is learnt from all of them
and checked in every joint state. Random games are the paper's; a guided game shows everything at
once.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from itertools import islice
from typing import Any

from tangy_tui.experiments.classroom import (
    GUIDED,
    RANDOM,
    Course,
    about,
    activity_of,
    course_number,
    is_exact,
    learnt,
    taught,
)
from tangy_tui.experiments.estimates import share_of, summary
from tangy_tui.experiments.published import USERS
from tangy_tui.experiments.sweep import Case, Settings, Sweep, Where

MOST_GAMES = 12
"""Random games after which a teacher gives up; four are nearly always enough."""

COUNTS = (1, 2, 3, 4)
"""Numbers of demonstrations for which the share of exact policies is reported."""


def until_exact(settings: Settings, case: Case) -> dict[str, Any]:
    """Teach until the policy is exact: a case is (kind of games, people, seed).

    Returns:
        The number of `games` needed (None: more than `most`), the `behaviours` of each
        demonstration, and the `flagged` counts after each.
    """
    games, users, seed = case
    activity = activity_of(settings["activity"])
    course = Course(settings["activity"], users, games, course_number("demonstrations", seed))
    shown, flags = [], []
    exact = False
    for demonstration in islice(taught(course), 1 if games == GUIDED else settings["most"]):
        shown.append(demonstration)
        policy = learnt(activity, shown)
        flags.append(flagged(policy, activity))
        exact = is_exact(policy, activity, users)
        if exact:
            break
    return {
        "games": len(shown) if exact else None,
        "behaviours": [len(demonstration.steps) for demonstration in shown],
        "flags": flags,
    }


def flagged(policy: Any, activity: Any) -> list[int]:
    """Count the decisions in expected situations: [wrong, wrong flagged, right, right flagged].

    A decision is flagged if Tangy would ask instead of carrying it out.
    """
    counts = Counter[tuple[bool, bool]]()
    for situation, behaviour in activity.expected.items():
        decision = policy.decide(situation)
        counts[decision.behaviour == behaviour, not decision.sure] += 1
    wrong, right = counts[False, True], counts[True, True]
    return [wrong + counts[False, False], wrong, right + counts[True, False], right]


def flagged_shares(counts: Sequence[Sequence[int]]) -> dict[str, Any]:
    """Sum `flagged` counts: the numbers of wrong and right decisions, and the shares flagged."""
    wrong, wrong_flagged, right, right_flagged = (
        (sum(column) for column in zip(*counts, strict=True)) if counts else (0, 0, 0, 0)
    )
    return {
        "wrong": wrong,
        "wrong_flagged": wrong_flagged / wrong if wrong else None,
        "right": right,
        "right_flagged": right_flagged / right if right else None,
    }


def run(activity: str, users: Sequence[int], seeds: Sequence[int], where: Where) -> dict[str, Any]:
    """Run both kinds: guided games for each number of people, random ones for the paper's."""
    settings = {**about(activity), "most": MOST_GAMES}
    cases = [(GUIDED, count, seed) for count in users for seed in seeds]
    guided = Sweep("guided", until_exact, settings, cases).run(where)
    chance = Sweep("random", until_exact, settings, [(RANDOM, USERS, seed) for seed in seeds]).run(
        where
    )
    by_users = {
        str(count): share_of(
            [r["games"] == 1 for c, r in zip(cases, guided, strict=True) if c[1] == count]
        )
        for count in users
    }
    took = [result["games"] for result in chance]
    return {
        "guided": {
            "exact_after_one": share_of([result["games"] == 1 for result in guided]),
            "by_users": by_users,
            "behaviours_per_demonstration": summary([r["behaviours"][0] for r in guided]),
        },
        "random": {
            "users": USERS,
            "exact_within": {
                str(count): share_of([t is not None and t <= count for t in took])
                for count in COUNTS
            },
            "demonstrations_needed": dict(sorted(Counter(str(t) for t in took).items())),
        },
        "behaviours": {
            **summary([b for result in chance for b in result["behaviours"]]),
            "all": [b for result in chance for b in result["behaviours"]],
        },
        "flagged_after_each": flagged_shares([f for result in chance for f in result["flags"]]),
    }
