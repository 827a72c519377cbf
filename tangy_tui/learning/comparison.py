"""Comparison of policies situation by situation: two teachers, or before and after a change."""

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
    """One situation and the decisions of two policies in it."""

    situation: Situation
    a: Decision
    b: Decision

    @property
    def same(self) -> bool:
        """Whether both policies choose the same behaviour, or both would ask."""
        if self.a.sure and self.b.sure:
            return self.a.behaviour == self.b.behaviour
        return self.a.sure == self.b.sure


def compare(activity: Activity, a: Policy, b: Policy) -> list[SituationComparison]:
    """Compare the decisions of two policies in every situation that can occur."""
    return [SituationComparison(s, a.decide(s), b.decide(s)) for s in activity.situations]


def find_policy(store: Store, activity: Activity, wanted: str) -> tuple[Policy, list[PolicyNotice]]:
    """Find the policy that a word refers to, and return it with notices about it.

    The first of these that matches is used: `last` or `last~N` (the newest policy, or the N-th
    before it), the name of a policy or a prefix of its digest, or the name of a teacher. For a
    teacher, a policy is fitted to the steps that this teacher showed in finished demonstrations.
    The prefix `policy:` or `teacher:` selects the kind.

    Raises:
        TangyError: nothing matches; the message suggests the nearest name.
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
    """Return everyone who showed a step, in order of their first step."""
    return dict.fromkeys(shown.teacher for shown in shown_steps(demonstrations))


def _shown_by(teacher: str, demonstrations: Iterable[Demonstration]) -> list[Demonstration]:
    """Return demonstrations reduced to the steps that one teacher showed."""
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
