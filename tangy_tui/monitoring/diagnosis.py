"""Fault diagnosis (III-C): ordered rules that map evidence to faults.

Each symptom is explained by the first rule that matches and names it; a rule all of whose
symptoms are explained already has nothing to add. So a lost link is one fault and not eleven, and
two faults that have nothing to do with each other are two. What nothing explains is a diagnosis
too: it was unexpected, and a teacher is asked.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from tangy_profiles.faults import Condition, Evidence, FaultBook, FaultRule
from tangy_tui.learning.effects import Mismatch
from tangy_tui.monitoring.detection import symptoms


@dataclass(frozen=True)
class Diagnosis:
    """A fault that was recognised: by which evidence, and which mismatches it explains."""

    rule: FaultRule
    evidence: Evidence
    mismatches: tuple[Mismatch, ...]
    beside: frozenset[str] = frozenset()
    """The keys of evidence that only says that it is not another fault."""


def diagnose(
    book: FaultBook, evidence: Evidence, mismatches: Sequence[Mismatch] = ()
) -> list[Diagnosis]:
    """Explain evidence by rules; the most urgent diagnosis comes first."""
    explained: set[str] = set()
    found: list[Diagnosis] = []

    def take(rule: FaultRule, keys: set[str], conditions: Sequence[Condition] = ()) -> None:
        mine = rule.symptoms.union(keys) - explained
        explained.update(mine)
        ages = {f"{key.removesuffix('state')}age" for key in keys if key.endswith(".state")}
        found.append(
            Diagnosis(
                rule,
                {key: evidence[key] for key in evidence if key in keys or key in ages},
                tuple(m for m in mismatches if f"mismatch.{m.variable}" in mine),
                frozenset(c.key for c in conditions if narrows(c, conditions, book)),
            )
        )

    for rule in book.rules[:-1]:
        conditions = rule.matched(evidence)
        if conditions is None:
            continue
        keys = {condition.key for condition in conditions}
        if (keys & rule.symptoms) - explained:
            take(rule, keys, conditions)
            if rule.critical and evidence.get("behaviour.completed") is False:
                # What critically went wrong broke the behaviour off: nothing was to be expected of
                # it. What others did meanwhile is another matter.
                broken_off = {key for key in evidence if key.startswith("mismatch.")}
                explained.update(broken_off - {"mismatch.others' requests"})
    if left := symptoms(evidence) - explained:
        take(book.fallback, left)
    return sorted(found, key=lambda diagnosis: diagnosis.rule.urgency)


def narrows(condition: Condition, among: Sequence[Condition], book: FaultBook) -> bool:
    """Say whether a condition only says that it is not another fault.

    It is then the contrary of another rule's, and its own rule has one that is not.
    """
    theirs = [c for rule in book.rules for conditions in rule.when for c in conditions]

    def contrary(one: Condition) -> bool:
        return any(_contrary(one, other) for other in theirs)

    return contrary(condition) and not all(contrary(one) for one in among)


def _contrary(one: Condition, other: Condition) -> bool:
    if (one.key, one.value) != (other.key, other.value):
        return False
    return {one.test, other.test} in ({"below", "at_least"}, {"is", "not"})
