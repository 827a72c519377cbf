"""Conflicts: situations in which demonstrations give different answers.

A forest outvotes a rare answer silently (one of three vanishes; two of four depend on the seed). So
conflicts are searched for before training, and a teacher decides which answer is right.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from types import MappingProxyType

from tangy_profiles.demonstration import Demonstration, Step
from tangy_profiles.demonstration import Resolution as Resolution
from tangy_profiles.state import Situation


@dataclass(frozen=True, slots=True)
class DemonstratedStep:
    """One demonstrated step, as step `number` (from 1) of a demonstration."""

    demonstration: str
    teacher: str
    number: int
    step: Step


@dataclass(frozen=True, slots=True)
class Conflict:
    """A situation with the steps of each answer to it, most frequent answer first."""

    situation: Situation
    answers: Mapping[str, tuple[DemonstratedStep, ...]]

    @property
    def steps(self) -> tuple[DemonstratedStep, ...]:
        """All steps that were shown in this situation."""
        return tuple(shown for steps in self.answers.values() for shown in steps)

    def resolved(self, *right: str) -> Resolution:
        """Return the resolution that calls these answers right, and all other steps wrong."""
        wrong = (s.step.id for s in self.steps if s.step.behaviour not in right)
        return Resolution(self.situation, tuple(dict.fromkeys(right)), frozenset(wrong))


def joined(resolutions: Iterable[Resolution]) -> dict[Situation, Resolution]:
    """Merge the resolutions of each situation, oldest first.

    The latest resolution decides which answers are right. A step that was set aside stays set aside
    unless its answer is now right.
    """
    settled: dict[Situation, Resolution] = {}
    for said in resolutions:
        before = settled.get(said.situation)
        wrong = said.wrong if before is None else said.wrong | before.wrong
        settled[said.situation] = Resolution(said.situation, said.right, wrong, said.whatever)
    return settled


def called_wrong(resolutions: Iterable[Resolution], step: Step) -> bool:
    """Return whether a teacher called a step wrong: nothing is learnt from it."""
    return any(said.sets_aside(step) for said in resolutions)


def shown_steps(demonstrations: Iterable[Demonstration]) -> Iterator[DemonstratedStep]:
    """Yield every step with its demonstration and number; skip copies of earlier steps."""
    known: set[int] = set()
    for demonstration in demonstrations:
        for number, step in enumerate(demonstration.steps, 1):
            if step.id and step.id in known:
                continue
            known.add(step.id)
            teacher = step.teacher or demonstration.teacher
            yield DemonstratedStep(demonstration.id, teacher, number, step)


def find_conflicts(
    demonstrations: Iterable[Demonstration], resolutions: Iterable[Resolution] = ()
) -> list[Conflict]:
    """Find the conflicts that no resolution settles, in order of occurrence.

    Two answers that were both called right are no conflict. A later step with a third answer is.
    """
    settled = joined(resolutions)
    answers: dict[Situation, dict[str, list[DemonstratedStep]]] = {}
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
    """Split the training rows (situation, behaviour) into those shown and those only told.

    The shown rows are all steps in order, without copies and without steps that a resolution sets
    aside. The told rows are answers from a resolution that no step shows, or that a rule covers.
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
