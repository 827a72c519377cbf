"""A demonstration: the trajectory T = {b1, s1} -> {b2, s2} ... of one teacher (III-A-3-iv)."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Literal

from tangy_profiles.codec import Sparse, Unlogged
from tangy_profiles.state import ActivityState, Situation

Origin = Literal["shown", "again", "asked", "merged", "split"]
"""Origin of a demonstration.

Shown in a game, shown again from a step of an earlier one, answered when Tangy asked in a game, or
made from others.
"""


@dataclass(frozen=True, slots=True)
class Step:
    """One behaviour-state pair, with the next state (from which effects are learnt).

    `completed`: the world carried the behaviour out. `id` is the step's number in the log, which
    copies keep (0: not logged), and `teacher` the person who showed it.
    """

    behaviour: str
    target: str | None
    state: ActivityState
    after: ActivityState
    completed: bool = True
    id: Unlogged[int] = field(default=0, compare=False)
    teacher: Unlogged[str] = field(default="", compare=False)

    def invalid_reason(self) -> str:
        """Return an inconsistency as the tail of a sentence; "" if there is none."""
        return not_the_same(self.state, self.after)


def not_the_same(before: ActivityState, after: ActivityState | None) -> str:
    """Return the tail of a sentence if a step changes who takes part; else ""."""
    same = after is None or [user.id for user in before.users] == [user.id for user in after.users]
    return "" if same else "has other people in 'after' than in 'state'"


@dataclass(frozen=True, slots=True)
class Resolution:
    """A teacher's resolution of a conflict: the right answers, and the steps it makes wrong.

    Only the reviewed steps are set aside: a different answer shown later is a new conflict. An
    answer in `right` is learnt even if it was not demonstrated.
    """

    situation: Situation
    right: tuple[str, ...]
    wrong: frozenset[int]
    whatever: Sparse[tuple[str, ...]] = ()
    """For a rule: the facts that make no difference, so that this situation need not be shown."""

    def sets_aside(self, step: Step) -> bool:
        """Return whether a step is excluded from learning."""
        return (
            step.state.situation == self.situation
            and step.behaviour not in self.right
            and step.id in self.wrong
        )


@dataclass(frozen=True, slots=True)
class Demonstration:
    """A teacher's demonstration in one game: teacher, activity, world, and the ordered steps.

    `seed`, `people` and `guided` recreate the simulated world, so that it can be resumed; `of`
    names the demonstrations that it was made from.
    """

    id: str
    activity: str
    teacher: str
    seed: int
    people: tuple[str, ...]
    steps: tuple[Step, ...] = ()
    finished: bool = False
    origin: Origin = "shown"
    of: tuple[str, ...] = ()
    guided: bool = False

    @property
    def replayable(self) -> bool:
        """Whether its steps are those of one simulated game from its beginning."""
        return self.origin in ("shown", "again")

    def with_step(self, step: Step) -> Demonstration:
        """Return the demonstration with one more step."""
        return replace(self, steps=(*self.steps, step))

    def without_last(self) -> Demonstration:
        """Return the demonstration without its last step."""
        return replace(self, steps=self.steps[:-1], finished=False)
