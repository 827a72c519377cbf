"""Scenario 1, second part: do different teachers lead to different policies?

Five simulated teachers give the paper's three demonstrations each, in their own games, and continue
while some situation was not shown. Then they settle the detected conflicts by what they know about
the activity.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from tangy_profiles.activity import Activity
from tangy_profiles.demonstration import Demonstration
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
from tangy_tui.experiments.estimates import share_of, summary
from tangy_tui.experiments.provenance import digest_of
from tangy_tui.experiments.published import SCENARIO_ONE, USERS
from tangy_tui.experiments.styles import STYLES, StyledTeacher
from tangy_tui.experiments.sweep import Case, Settings, Sweep, Where
from tangy_tui.learning.conflicts import Resolution, find_conflicts
from tangy_tui.learning.policy import Policy
from tangy_tui.learning.teaching_session import TeachingSession

FEWEST, MOST = int(SCENARIO_ONE["demonstrations"]), 8
"""The fewest and most games of a teacher."""


def resolved(activity: Activity, shown: Sequence[Demonstration]) -> list[Resolution]:
    """Settle every conflict by the expected behaviour."""
    return [
        conflict.resolved(activity.expected[conflict.situation])
        for conflict in find_conflicts(shown)
        if conflict.situation in activity.expected
    ]


def wrong_steps(activity: Activity, shown: Sequence[Demonstration]) -> int:
    """Count the steps that are not as expected."""
    steps = [step for one in shown for step in one.steps]
    return sum(step.behaviour != activity.expected.get(step.state.situation) for step in steps)


def teach(settings: Settings, case: Case) -> dict[str, Any]:
    """Let one teacher teach: a case is (index of the style, seed).

    Returns:
        The demonstrations and mistakes, and the policy after three demonstrations (`three`), then
        with the conflicts resolved (`three_resolved`), and at the end (`end`).
    """
    place, seed = case
    style, activity = STYLES[place], activity_of(settings["activity"])
    number = course_number("teachers", seed, place, len(STYLES))
    course = Course(settings["activity"], USERS, RANDOM, number)
    made: list[StyledTeacher] = []

    def make(teaching: TeachingSession) -> StyledTeacher:
        made.append(StyledTeacher(style, teaching, seed))
        return made[0]

    shown: list[Demonstration] = []
    outcome: dict[str, Any] = {}
    for demonstration in taught(course, make):
        shown.append(demonstration)
        if len(shown) == FEWEST:
            outcome["three"] = _outcome(activity, learnt(activity, shown))
            outcome["three_resolved"] = _outcome(
                activity, learnt(activity, shown, resolved(activity, shown))
            )
        if len(shown) >= FEWEST and (covered(activity, shown) or len(shown) >= MOST):
            break
    conflicts = find_conflicts(shown)
    end = learnt(activity, shown, resolved(activity, shown))
    return {
        "style": style.name,
        "games": len(shown),
        "behaviours": [len(demonstration.steps) for demonstration in shown],
        "mistakes": {
            "made": made[0].made,
            "noticed": made[0].noticed,
            "mended": made[0].mended,
            "kept": wrong_steps(activity, shown),
        },
        "conflicts": len(conflicts),
        **outcome,
        "end": _outcome(activity, end),
    }


def _outcome(activity: Activity, policy: Policy) -> dict[str, Any]:
    decisions = [[*s, policy.decide(s).behaviour] for s in sorted(activity.situations)]
    return {"exact": is_exact(policy, activity, USERS), "policy": digest_of(decisions)}


def run(activity: str, seeds: Sequence[int], where: Where) -> dict[str, Any]:
    """Run groups of five teachers, one group per seed, and compare within each group."""
    cases = [(place, seed) for seed in seeds for place in range(len(STYLES))]
    results = Sweep("teachers", teach, about(activity), cases).run(where)
    groups = [results[at : at + len(STYLES)] for at in range(0, len(results), len(STYLES))]

    def alike(group: Sequence[dict[str, Any]], when: str) -> bool:
        return len({result[when]["policy"] for result in group}) == 1

    return {
        "count": len(STYLES),
        "identical": all(alike(group, "end") for group in groups),
        "groups": len(groups),
        "identical_share": {
            when: share_of([alike(group, when) for group in groups])
            for when in ("three", "three_resolved", "end")
        },
        "each": [_row(results[place :: len(STYLES)]) for place in range(len(STYLES))],
    }


def _row(results: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """Return the totals of the teachers of one style."""
    steps = sum(sum(result["behaviours"]) for result in results)
    return {
        "style": results[0]["style"],
        "n": len(results),
        "games": summary([result["games"] for result in results]),
        "behaviours": summary([b for result in results for b in result["behaviours"]]),
        "mistakes_made": sum(result["mistakes"]["made"] for result in results) / steps,
        "mistakes_kept": sum(result["mistakes"]["kept"] for result in results) / steps,
        "conflicts": summary([result["conflicts"] for result in results]),
        "exact": {
            when: share_of([result[when]["exact"] for result in results])
            for when in ("three", "three_resolved", "end")
        },
    }
