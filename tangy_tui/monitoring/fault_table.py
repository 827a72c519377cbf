"""The second part of Table II: how often faults of each kind came, and were recovered from."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from tangy_profiles.faults import CRITICAL, NON_CRITICAL
from tangy_tui.monitoring.fault import Fault

ROWS = (
    (CRITICAL, "expert"),
    (NON_CRITICAL, "continue"),
    (NON_CRITICAL, "user"),
    (NON_CRITICAL, "teacher"),
)
"""Criticality and first recovery, in the paper's order."""


def fault_rows(faults: Iterable[Fault]) -> list[dict[str, Any]]:
    """Count faults by criticality and the recovery that was tried first.

    All of the paper's rows are there. `instances` counts every given fault; leave out those that
    only ask (`Fault.asks_only`) where a question is no fault. `success` is the share, from 0 to 1,
    that is over, or that Tangy goes on with as planned, by the first recovery itself: a fault that
    was handed on to another one is no success. It is None if there was no instance.
    """
    done: dict[tuple[str, str], list[bool]] = {row: [] for row in ROWS}
    for fault in faults:
        row = (CRITICAL if fault.critical else NON_CRITICAL, fault.recovery)
        done.setdefault(row, []).append(fault.succeeded and len(fault.ladder) == 1)
    return [
        {
            "criticality": criticality,
            "recovery": recovery,
            "instances": len(results),
            "success": sum(results) / len(results) if results else None,
        }
        for (criticality, recovery), results in done.items()
    ]
