"""Fault diagnosis (III-C): ordered rules that map evidence to faults.

Each symptom is explained by the first matching rule that names it. A rule whose symptoms are all
explained already adds nothing. So a lost link is one fault, not eleven, and two independent faults
are two. Symptoms without an explanation are a diagnosis too: unexpected, so a teacher is asked.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from tangy_profiles.faults import Condition, Evidence, FaultBook, FaultRule
from tangy_tui.learning.effects import Mismatch
from tangy_tui.monitoring.detection import symptoms


@dataclass(frozen=True)
class Diagnosis:
    """A diagnosed fault: its evidence, and the mismatches that it explains."""

    rule: FaultRule
    evidence: Evidence
    mismatches: tuple[Mismatch, ...]
    beside: frozenset[str] = frozenset()
    """The keys of evidence that only excludes other faults."""


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
                # A critical fault interrupted the behaviour, so its expected effects say nothing,
                # except what other people did meanwhile.
                broken_off = {key for key in evidence if key.startswith("mismatch.")}
                explained.update(broken_off - {"mismatch.others' requests"})
    if left := symptoms(evidence) - explained:
        take(book.fallback, left)
    return sorted(found, key=lambda diagnosis: diagnosis.rule.urgency)


def narrows(condition: Condition, among: Sequence[Condition], book: FaultBook) -> bool:
    """Return whether a condition only excludes other faults.

    That is so if it negates a condition of another rule, and its own rule has one that does not.
    """
    theirs = [c for rule in book.rules for conditions in rule.when for c in conditions]

    def contrary(one: Condition) -> bool:
        return any(_contrary(one, other) for other in theirs)

    return contrary(condition) and not all(contrary(one) for one in among)


def _contrary(one: Condition, other: Condition) -> bool:
    if (one.key, one.value) != (other.key, other.value):
        return False
    return {one.test, other.test} in ({"below", "at_least"}, {"is", "not"})
