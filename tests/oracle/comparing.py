"""Two recordings, side by side."""

from __future__ import annotations

from difflib import unified_diff
from itertools import islice
from pathlib import Path

SHOWN = 12
"""The number of lines of a difference that are shown for each file."""


def differences(before: Path, after: Path) -> list[str]:
    """Return an entry for each file that differs, or that only one recording has."""
    files = {path.relative_to(root) for root in (before, after) for path in root.rglob("*.txt")}
    found = (_difference(before / one, after / one, str(one)) for one in sorted(files))
    return [entry for entry in found if entry]


def _difference(before: Path, after: Path, name: str) -> str:
    if not (before.exists() and after.exists()):
        return f"{name}: only in {(before if before.exists() else after).parent}"
    old, new = (path.read_text(encoding="utf-8").splitlines() for path in (before, after))
    lines = islice(unified_diff(old, new, "before", "after", lineterm="", n=1), 2, 2 + SHOWN)
    text = "\n  ".join(line[:200] for line in lines)
    return f"{name}\n  {text}" if text else ""
