"""Learning from an answer: a teacher says in a game what to do, and Tangy learns it at once.

The answer becomes a demonstration of one step, the forest is fitted anew, and all earlier
demonstrations are gone through with the old and the new policy, to show that nothing else changed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from tangy_profiles.activity import Activity
from tangy_profiles.demonstration import Demonstration, Step
from tangy_profiles.state import Situation
from tangy_profiles.store import Store
from tangy_tui.learning.conflicts import find_conflicts, shown_steps
from tangy_tui.learning.editing import Editor, new_id
from tangy_tui.learning.library import BEGUN, FINISHED, STEP, read_library
from tangy_tui.learning.policies import Change, keep_policy
from tangy_tui.learning.policy import Decision, Policy, learn_policy


@dataclass(frozen=True, slots=True)
class Replay:
    """All demonstrated steps gone through with two policies.

    `steps` were looked at, `changed` are the other situations that are answered otherwise now, and
    `overruled` are the earlier steps in the answered situation that said something else.
    """

    steps: int
    changed: tuple[Change, ...]
    overruled: int

    def words(self) -> str:
        """Say what came out in a sentence or two."""
        if not self.steps:
            first = "There were no earlier steps to compare with."
        elif self.changed:
            rows = "; ".join(
                f"{' / '.join(c.situation)}: was {c.before}, is now {c.after}" for c in self.changed
            )
            first = f"All {self.steps} earlier steps were gone through. Changed as well: {rows}."
        else:
            first = f"All {self.steps} earlier steps were gone through: nothing else changed."
        if self.overruled == 1:
            return f"{first} One earlier step said otherwise, and is set aside."
        if self.overruled:
            return f"{first} {self.overruled} earlier steps said otherwise, and are set aside."
        return first


@dataclass(frozen=True, slots=True)
class Lesson:
    """What an answer led to: the demonstration it became, the policy, and the replay."""

    demonstration: Demonstration
    policy: Policy
    replay: Replay


class Answers:
    """Makes demonstrations and policies of the answers that teachers give in games."""

    def __init__(self, store: Store, activity: Activity) -> None:
        self._store = store
        self._activity = activity

    def learn(
        self, policy: Policy, step: Step, *, teacher: str, seed: int, people: Sequence[str]
    ) -> Lesson:
        """Learn an answer, and keep all of it in the log or nothing.

        Args:
            policy: the policy that was not sure.
            step: the situation, the answer, and what followed.
            teacher: who answered.
            seed, people: of the game in which Tangy asked.
        """
        situation = step.state.situation
        with self._store.transaction():
            made = self._log(step, teacher, seed, tuple(people))
            entries = read_library(self._store, self._activity.name).entries
            earlier = [entries[id].demonstration for id in policy.demonstrations if id in entries]
            resolutions = list(policy.resolutions)
            overruled = 0
            for conflict in find_conflicts([*earlier, made], resolutions):
                if conflict.situation == situation:
                    Editor(self._store, self._activity).resolve(conflict, step.behaviour)
                    resolutions.append(conflict.resolved(step.behaviour))
                    overruled = len(conflict.steps) - len(conflict.answers[step.behaviour])
            learnt = learn_policy(
                self._activity,
                [*earlier, made],
                resolutions=list({r.situation: r for r in resolutions}.values()),
                settings=policy.settings,
                name="" if policy.named_by_count else policy.name,
            )
            keep_policy(self._store, learnt)
        return Lesson(made, learnt, replay(policy, learnt, earlier, situation, overruled))

    def _log(self, step: Step, teacher: str, seed: int, people: tuple[str, ...]) -> Demonstration:
        made = Demonstration(
            new_id(), self._activity.name, teacher, seed, people, finished=True, origin="asked"
        )
        name = {"demonstration": made.id}
        self._store.append(
            BEGUN,
            {
                **name,
                "activity": made.activity,
                "teacher": teacher,
                "seed": seed,
                "people": list(people),
                "origin": made.origin,
            },
        )
        id = self._store.append(STEP, {**name, **step.to_json()})
        self._store.append(FINISHED, name)
        return replace(made, steps=(replace(step, id=id),))


def replay(
    before: Policy,
    after: Policy,
    demonstrations: Sequence[Demonstration],
    answered: Situation,
    overruled: int = 0,
) -> Replay:
    """Go through demonstrations with two policies; `answered` is where they are meant to differ."""
    steps = list(shown_steps(demonstrations))
    situations = dict.fromkeys(shown.step.state.situation for shown in steps)
    changed = tuple(
        Change(situation, _does(before.decide(situation)), _does(after.decide(situation)))
        for situation in situations
        if situation != answered
        and _does(before.decide(situation)) != _does(after.decide(situation))
    )
    return Replay(len(steps), changed, overruled)


def _does(decision: Decision) -> str:
    return decision.behaviour if decision.sure else "asks"
