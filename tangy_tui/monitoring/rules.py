"""Check of fault rules: the evidence that each uses, and the evidence that none uses."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from tangy_profiles.fault_file import check_faults
from tangy_profiles.faults import CONTEXT, FaultBook, FaultRule
from tangy_profiles.robot import Robot
from tangy_sim.worlds.injection import KINDS
from tangy_tui.monitoring.drill_rounds import round_kinds


@dataclass(frozen=True, slots=True)
class Rules:
    """Checked fault rules.

    `unseen` is the devices' evidence that no rule uses; `unruled` the simulator's kinds of fault
    whose diagnosis has no rule; `untried` the rules that nothing in the simulator triggers;
    `together` the rules that only a combination of kinds triggers, with these kinds.
    """

    file: str
    mistakes: tuple[str, ...]
    rules: tuple[FaultRule, ...] = ()
    unseen: tuple[str, ...] = ()
    unruled: tuple[str, ...] = ()
    untried: tuple[str, ...] = ()
    together: Mapping[str, tuple[str, ...]] = field(default_factory=dict)

    def to_json(self) -> dict[str, Any]:
        """Return what `--json` prints."""
        return {
            "file": self.file,
            "kind": "faults",
            "mistakes": list(self.mistakes),
            "rules": [
                {
                    "code": rule.code,
                    "name": rule.name,
                    "criticality": rule.criticality,
                    "recovery": list(rule.recovery),
                    "looks_at": list(looks_at(rule)),
                }
                for rule in self.rules
            ],
            "evidence_without_rule": list(self.unseen),
            "kinds_without_rule": list(self.unruled),
            "rules_without_kind": list(self.untried),
            "only_by_kinds_together": {code: list(these) for code, these in self.together.items()},
        }


def check_rules(robot: Robot, path: Path | None = None) -> Rules:
    """Check fault rules: the built-in ones, or a file in the same format."""
    book, mistakes = check_faults(robot, path)
    if book is None:
        return Rules(path.name if path is not None else "faults.toml", tuple(mistakes))
    codes = {rule.code for rule in book.rules}
    alone = {kind.code for kind in KINDS.values()}
    ways = {way.code: way.injections for way in round_kinds(book) if way.code not in alone}
    return Rules(
        book.source,
        (),
        book.rules,
        _unseen(book, robot),
        tuple(name for name, kind in KINDS.items() if kind.code not in codes),
        tuple(rule.code for rule in book.rules if rule.code not in alone | ways.keys()),
        {code: kinds for code, kinds in ways.items() if kinds},
    )


def looks_at(rule: FaultRule) -> tuple[str, ...]:
    """Return the evidence that a rule uses, in the order of the file."""
    keys = (condition.key for conditions in rule.when for condition in conditions)
    return tuple(dict.fromkeys(key for key in keys if key not in CONTEXT))


def _unseen(book: FaultBook, robot: Robot) -> tuple[str, ...]:
    """Return the devices' evidence that no rule uses, without ages, which the state covers."""
    seen = {key for rule in book.rules for key in looks_at(rule)}
    keys = [
        f"{device.name}.{fact}"
        for device in robot.devices.values()
        for fact in ("state", *device.facts)
    ]
    return tuple(key for key in keys if key not in seen)
