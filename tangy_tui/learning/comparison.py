"""Comparing policies row by row: teacher against teacher, before against after."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

from tangy_profiles.activity import Activity
from tangy_profiles.demonstration import Demonstration
from tangy_profiles.errors import TangyError
from tangy_profiles.reading import nearest, plain
from tangy_profiles.state import Situation
from tangy_profiles.store import Store
from tangy_tui.learning.conflicts import shown_steps
from tangy_tui.learning.library import read_library
from tangy_tui.learning.policies import PolicyNotice, load_policy, place_of, stored_policies
from tangy_tui.learning.policy import Decision, Policy, learn_policy


@dataclass(frozen=True, slots=True)
class SituationComparison:
    """One situation and what two policies decide there."""

    situation: Situation
    a: Decision
    b: Decision

    @property
    def same(self) -> bool:
        """Whether both do the same: the same behaviour, or both would ask."""
        if self.a.sure and self.b.sure:
            return self.a.behaviour == self.b.behaviour
        return self.a.sure == self.b.sure


def compare(activity: Activity, a: Policy, b: Policy) -> list[SituationComparison]:
    """Return what two policies decide in every situation that can occur."""
    return [SituationComparison(s, a.decide(s), b.decide(s)) for s in activity.situations]


def choices(store: Store, activity: Activity) -> list[str]:
    """Return what can be compared: names of policies, the latest first, and of teachers."""
    names = [kept.name for kept in reversed(stored_policies(store, activity.name))]
    teachers = _teachers(read_library(store, activity.name).finished)
    return list(dict.fromkeys([*names, *teachers]))


def find_policy(store: Store, activity: Activity, wanted: str) -> tuple[Policy, list[PolicyNotice]]:
    """Return the policy that a word means, and a notice about it.

    It means, the first that fits: `last` or `last~N` (the last policy learnt, or the N-th before
    it), the name of a policy or how its digest begins, or the name of a teacher, from whose
    finished demonstrations, as they were shown, a policy is learnt for the occasion. `policy:` or
    `teacher:` before it says which is meant.

    Raises:
        TangyError: nothing matches; names the nearest one.
    """
    kind, _, name = wanted.partition(":") if ":" in wanted else ("", "", wanted)
    kept = stored_policies(store, activity.name)
    known = {one.name for one in kept}
    if kind != "teacher" and (
        place_of(name) is not None
        or name in known
        or any(len(name) >= 4 and one.digest.startswith(name) for one in kept)
    ):
        return load_policy(store, activity, name)
    library = read_library(store, activity.name)
    shown = _shown_by(name, library.finished)
    if kind == "policy" or not shown:
        words = {*known, *_teachers(library.finished), "last"}
        raise TangyError(plain(f"There is no policy or teacher {wanted!r}: {nearest(name, words)}"))
    return learn_policy(activity, shown, name=name), []


def _teachers(demonstrations: Iterable[Demonstration]) -> dict[str, None]:
    """Return who showed a step, in the order in which they first did."""
    return dict.fromkeys(shown.teacher for shown in shown_steps(demonstrations))


def _shown_by(teacher: str, demonstrations: Iterable[Demonstration]) -> list[Demonstration]:
    """Return demonstrations with just the steps that one teacher showed."""
    found = []
    for demonstration in demonstrations:
        steps = tuple(
            step
            for step in demonstration.steps
            if (step.teacher or demonstration.teacher) == teacher
        )
        if steps:
            found.append(replace(demonstration, steps=steps))
    return found
