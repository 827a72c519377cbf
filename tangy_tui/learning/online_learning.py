"""Online learning: a teacher says during a game what to do, and Tangy learns it at once.

The answer becomes a demonstration of one step and the forest is refitted. Then all earlier
demonstrations are replayed with the old and the new policy, to show that nothing else changed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

from tangy_profiles.activity import Activity
from tangy_profiles.demonstration import Demonstration, Step
from tangy_profiles.state import Situation
from tangy_profiles.store import Store
from tangy_profiles.teaching_records import (
    DemonstrationBegun,
    DemonstrationFinished,
    DemonstrationStep,
)
from tangy_tui.learning.conflicts import Resolution, find_conflicts, joined, shown_steps
from tangy_tui.learning.editing import Editor, new_id
from tangy_tui.learning.library import read_library
from tangy_tui.learning.library_entries import Library
from tangy_tui.learning.policies import DecisionChange, does, keep_policy, unused_name
from tangy_tui.learning.policy import Policy, learn_policy

Unsettled = Literal["", "new", "otherwise"]
"""Open question about an answer: none, nobody gave it before, or a teacher gave another one."""


@dataclass(frozen=True, slots=True)
class PolicyReplay:
    """Replay of all demonstrated steps with two policies.

    `steps` is the number of replayed steps, `changed` the other situations whose decision changed,
    `overruled` the number of earlier steps that the answer sets aside, and `unsettled` the question
    that a teacher still has to settle.
    """

    steps: int
    changed: tuple[DecisionChange, ...]
    overruled: int = 0
    unsettled: Unsettled = ""


@dataclass(frozen=True, slots=True)
class Lesson:
    """The result of an answer: its demonstration, the new policy, and the replay."""

    demonstration: Demonstration
    policy: Policy
    replay: PolicyReplay


class OnlineLearning:
    """Turns the answers that teachers give in games into demonstrations and policies."""

    def __init__(self, store: Store, activity: Activity) -> None:
        self._store = store
        self._activity = activity

    def learn(
        self, policy: Policy, step: Step, *, teacher: str, seed: int, people: Sequence[str]
    ) -> Lesson:
        """Learn an answer, and log it in one transaction.

        Args:
            policy: the policy that was not sure.
            step: the situation, the answer, and the next state.
            teacher: who answered.
            seed: seed of the random generators.
            people: the ids of the participants.
        """
        with self._store.transaction():
            made = self._log(step, teacher, seed, tuple(people))
            library = read_library(self._store, self._activity.name)
            entries = library.entries
            earlier = [entries[id].demonstration for id in policy.demonstrations if id in entries]
            settled = _settle(policy, earlier, made)
            if settled is not None:
                self._settle_library(library, settled)
            learnt = self._learn(policy, [*earlier, made], settled)
            keep_policy(self._store, learnt)
        gone_through = replay(policy, learnt, earlier, step.state.situation)
        return Lesson(
            made,
            learnt,
            replace(
                gone_through,
                overruled=len(settled.wrong) if settled is not None else 0,
                unsettled=_unsettled(learnt, library, step),
            ),
        )

    def _settle_library(self, library: Library, settled: Resolution) -> None:
        """Settle the conflict in the library too, unless a teacher has settled it differently."""
        said = joined(library.resolutions).get(settled.situation)
        if said is not None and not set(settled.right) <= set(said.right):
            return  # the teacher sees both before Tangy learns again
        for conflict in library.conflicts:
            if conflict.situation == settled.situation:
                Editor(self._store, self._activity).resolve(conflict, *settled.right)

    def _learn(
        self, policy: Policy, shown: Sequence[Demonstration], settled: Resolution | None
    ) -> Policy:
        """Refit the forest; if one answer is not enough to be sure, settle it as right."""
        said = [*policy.resolutions, *([settled] if settled is not None else [])]
        answer = shown[-1].steps[-1]
        situation = answer.state.situation
        for again in (False, True):
            learnt = learn_policy(
                self._activity,
                shown,
                resolutions=list(joined(said).values()),
                settings=policy.settings,
                name="" if policy.named_by_count else policy.name,
            )
            decision = learnt.decide(situation)
            if again or decision.sure or decision.contested:
                break
            said.append(Resolution(situation, (answer.behaviour,), frozenset()))
        return unused_name(self._store, learnt)

    def _log(self, step: Step, teacher: str, seed: int, people: tuple[str, ...]) -> Demonstration:
        made = Demonstration(
            new_id(), self._activity.name, teacher, seed, people, finished=True, origin="asked"
        )
        self._store.append(DemonstrationBegun.from_demonstration(made))
        id = self._store.append(DemonstrationStep(demonstration=made.id, step=step))
        self._store.append(DemonstrationFinished(demonstration=made.id))
        return replace(made, steps=(replace(step, id=id),))


def replay(
    before: Policy,
    after: Policy,
    demonstrations: Sequence[Demonstration],
    answered: Situation,
) -> PolicyReplay:
    """Replay demonstrations with two policies; `answered` is where they are meant to differ."""
    steps = list(shown_steps(demonstrations))
    situations = dict.fromkeys(shown.step.state.situation for shown in steps)
    changed = tuple(
        DecisionChange(situation, does(before.decide(situation)), does(after.decide(situation)))
        for situation in situations
        if situation != answered and does(before.decide(situation)) != does(after.decide(situation))
    )
    return PolicyReplay(len(steps), changed)


def _settle(
    policy: Policy, earlier: Sequence[Demonstration], made: Demonstration
) -> Resolution | None:
    """Settle a conflict if the answer was demonstrated before; a new answer settles nothing."""
    answer = made.steps[-1]
    for conflict in find_conflicts([*earlier, made], policy.resolutions):
        if conflict.situation == answer.state.situation:
            given = conflict.answers[answer.behaviour]
            if any(shown.demonstration != made.id for shown in given):
                return conflict.resolved(answer.behaviour)
    return None


def _unsettled(learnt: Policy, library: Library, step: Step) -> Unsettled:
    """Return the open question about the answered situation."""
    if learnt.decide(step.state.situation).contested:
        return "new"
    said = joined(library.resolutions).get(step.state.situation)
    if said is not None and step.behaviour not in said.right:
        return "otherwise"
    return ""
