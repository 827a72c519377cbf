"""The second part of Table II: how often faults of each class occurred and were recovered from."""

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
    """Count faults by criticality and first recovery.

    All of the paper's rows are included. `instances` counts every given fault; leave out questions
    (`Fault.asks_only`) if they should not count. `success` is the share, from 0 to 1, of faults
    that the first recovery itself ended or made tolerable: a fault that was escalated is no
    success. It is None without instances.
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
