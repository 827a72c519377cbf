"""Fault diagnosis (III-C): rules in order say what the evidence means.

Each symptom is explained by the first rule that matches and names it; a rule all of whose
symptoms are explained already has nothing to add. So a lost link is one fault and not eleven, and
two faults that have nothing to do with each other are two. What nothing explains is a diagnosis
too: it was unexpected, and a teacher is asked.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from tangy_profiles.faults import Evidence, FaultBook, FaultRule
from tangy_tui.learning.effects import Mismatch
from tangy_tui.monitoring.detection import symptoms


@dataclass(frozen=True)
class Diagnosis:
    """A fault that was recognised: by which evidence, and which mismatches it explains."""

    rule: FaultRule
    evidence: Evidence
    mismatches: tuple[Mismatch, ...]


def diagnose(
    book: FaultBook, evidence: Evidence, mismatches: Sequence[Mismatch] = ()
) -> list[Diagnosis]:
    """Explain evidence by rules; the most urgent diagnosis comes first."""
    explained: set[str] = set()
    found: list[Diagnosis] = []

    def take(rule: FaultRule, keys: set[str]) -> None:
        mine = rule.symptoms.union(keys) - explained
        explained.update(mine)
        ages = {f"{key.removesuffix('state')}age" for key in keys if key.endswith(".state")}
        found.append(
            Diagnosis(
                rule,
                {key: evidence[key] for key in evidence if key in keys or key in ages},
                tuple(m for m in mismatches if f"mismatch.{m.variable}" in mine),
            )
        )

    for rule in book.rules[:-1]:
        conditions = rule.matched(evidence)
        if conditions is None:
            continue
        keys = {condition.key for condition in conditions}
        if (keys & rule.symptoms) - explained:
            take(rule, keys)
    if evidence.get("behaviour.completed") is False and any(d.rule.critical for d in found):
        # What critically went wrong broke the behaviour off: nothing was to be expected of it. What
        # others did meanwhile is another matter.
        broken_off = {key for key in evidence if key.startswith("mismatch.")}
        explained.update(broken_off - {"mismatch.others' requests"})
    if left := symptoms(evidence) - explained:
        take(book.fallback, left)
    return sorted(found, key=lambda diagnosis: diagnosis.rule.urgency)
