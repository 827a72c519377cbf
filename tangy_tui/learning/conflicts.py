"""Conflicts: situations in which demonstrations, one or several, give different answers.

A forest outvotes a rare answer silently (notes: one of three vanishes, two of four flip with the
seed), so a conflict is looked for before training, and a teacher says which answer is right.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from types import MappingProxyType

from tangy_profiles.demonstration import Demonstration, Step
from tangy_profiles.demonstration import Resolution as Resolution
from tangy_profiles.state import Situation


@dataclass(frozen=True, slots=True)
class Shown:
    """One demonstrated step and where it stands: step `number` (from 1) of a demonstration."""

    demonstration: str
    teacher: str
    number: int
    step: Step


@dataclass(frozen=True, slots=True)
class Conflict:
    """A situation with the different answers to it, most often shown first, and their steps."""

    situation: Situation
    answers: Mapping[str, tuple[Shown, ...]]

    @property
    def steps(self) -> tuple[Shown, ...]:
        """All steps in the situation."""
        return tuple(shown for steps in self.answers.values() for shown in steps)

    def resolved(self, *right: str) -> Resolution:
        """Return the resolution by which these answers are right, and the other steps wrong."""
        wrong = (s.step.id for s in self.steps if s.step.behaviour not in right)
        return Resolution(self.situation, tuple(dict.fromkeys(right)), frozenset(wrong))


def joined(resolutions: Iterable[Resolution]) -> dict[Situation, Resolution]:
    """Merge the resolutions of each situation, in order of time.

    What was called right last is right; a step that was set aside once stays so, unless its
    answer is right by now.
    """
    settled: dict[Situation, Resolution] = {}
    for said in resolutions:
        before = settled.get(said.situation)
        wrong = said.wrong if before is None else said.wrong | before.wrong
        settled[said.situation] = Resolution(said.situation, said.right, wrong, said.whatever)
    return settled


def shown_steps(demonstrations: Iterable[Demonstration]) -> Iterator[Shown]:
    """Yield every step with where it stands; a step that was copied, only where it is first."""
    known: set[int] = set()
    for demonstration in demonstrations:
        for number, step in enumerate(demonstration.steps, 1):
            if step.id and step.id in known:
                continue
            known.add(step.id)
            teacher = step.teacher or demonstration.teacher
            yield Shown(demonstration.id, teacher, number, step)


def find_conflicts(
    demonstrations: Iterable[Demonstration], resolutions: Iterable[Resolution] = ()
) -> list[Conflict]:
    """Return the conflicts that no resolution settles, in the order in which they occurred.

    Two answers that were both called right are no conflict; a step with another answer, made
    since, is one.
    """
    settled = joined(resolutions)
    answers: dict[Situation, dict[str, list[Shown]]] = {}
    for shown in shown_steps(demonstrations):
        said = settled.get(shown.step.state.situation)
        if said is not None and said.sets_aside(shown.step):
            continue
        of_situation = answers.setdefault(shown.step.state.situation, {})
        of_situation.setdefault(shown.step.behaviour, []).append(shown)
    found = []
    for situation, given in answers.items():
        right = settled[situation].right if situation in settled else ()
        different = set(given) | set(right)
        if len(different) > 1 and not different <= set(right):
            ordered = sorted(given.items(), key=lambda item: -len(item[1]))
            found.append(Conflict(situation, MappingProxyType({b: tuple(s) for b, s in ordered})))
    return found


def training_rows(
    demonstrations: Iterable[Demonstration], resolutions: Iterable[Resolution] = ()
) -> tuple[list[tuple[Situation, str]], list[tuple[Situation, str]]]:
    """Return the training set of situations and behaviours, shown or only told.

    Shown is every step, in order, but for those that a resolution calls wrong and copies of a
    step. Said is an answer that a resolution calls right where all steps showed others, or
    that a rule covers.
    """
    settled = joined(resolutions)
    rows: list[tuple[Situation, str]] = []
    met: set[Situation] = set()
    for shown in shown_steps(demonstrations):
        situation = shown.step.state.situation
        met.add(situation)
        said = settled.get(situation)
        if said is None or not said.sets_aside(shown.step):
            rows.append((situation, shown.step.behaviour))
    learnt = set(rows)
    told = [
        (situation, behaviour)
        for situation, said in settled.items()
        for behaviour in said.right
        if (situation in met or said.whatever) and (situation, behaviour) not in learnt
    ]
    return rows, told
