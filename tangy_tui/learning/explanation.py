"""Explanation of a decision: the situation, the votes, the steps behind it, the alternatives.

The same explanation is used in games, during teaching, and for look-ups.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from tangy_profiles.activity import Activity
from tangy_profiles.demonstration import Demonstration
from tangy_profiles.state import Situation
from tangy_profiles.store import Store
from tangy_tui.learning.conflicts import DemonstratedStep, shown_steps
from tangy_tui.learning.library import read_library
from tangy_tui.learning.policy import Decision, Policy, learn_policy


@dataclass(frozen=True, slots=True)
class DecisionReasons:
    """The reasons for one decision.

    `rests_on` are the steps in this situation that show the chosen behaviour, `against` those that
    show another (set aside or not). If the situation was never shown, `near` are the steps in
    situations that differ from it in one part, from which the trees generalise.
    """

    situation: Situation
    decision: Decision
    rests_on: tuple[DemonstratedStep, ...]
    against: tuple[DemonstratedStep, ...]
    near: tuple[DemonstratedStep, ...]

    @property
    def steps(self) -> tuple[DemonstratedStep, ...]:
        """All of these steps, in the order in which they are presented."""
        return (*self.rests_on, *self.against, *self.near)


def explain(
    policy: Policy, demonstrations: Sequence[Demonstration], situation: Situation
) -> DecisionReasons:
    """Find the steps behind a policy's decision.

    Args:
        policy: the policy that decides.
        demonstrations: all demonstrations; those the policy was not learnt from are ignored.
        situation: the situation to explain.

    Raises:
        KeyError: the activity has no such situation.
    """
    decision = policy.decide(situation)
    used = set(policy.demonstrations)
    shown = list(shown_steps(d for d in demonstrations if d.id in used))
    here = [s for s in shown if s.step.state.situation == situation]
    near = () if decision.seen else (s for s in shown if _differ(s, situation) == 1)
    return DecisionReasons(
        situation,
        decision,
        tuple(s for s in here if s.step.behaviour == decision.behaviour),
        tuple(s for s in here if s.step.behaviour != decision.behaviour),
        tuple(near),
    )


def foresee(store: Store, activity: Activity, present: Demonstration | None) -> Policy:
    """Learn a preview policy from finished demonstrations and the current one; store nothing.

    Raises:
        NothingToLearnFrom: nothing has been demonstrated yet.
    """
    library = read_library(store, activity.name)
    shown = {d.id: d for d in library.finished}
    if present is not None and present.steps:
        for id in present.of:
            shown.pop(id, None)
        shown[present.id] = present
    return learn_policy(activity, list(shown.values()), resolutions=library.resolutions)


def _differ(shown: DemonstratedStep, situation: Situation) -> int:
    """Count the parts of the triple in which two situations differ."""
    return sum(a != b for a, b in zip(shown.step.state.situation, situation, strict=True))
