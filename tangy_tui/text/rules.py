"""Words for the check of a rule file: gaps in its rules."""

from __future__ import annotations

from collections.abc import Sequence

UNSEEN = "Evidence that no rule looks at"
UNRULED = "Simulated faults without a rule"
UNTRIED = "Rules that the simulator cannot bring about"


def together_words(kinds: Sequence[str], code: str) -> str:
    """Name the faults that only together trigger a rule."""
    return f"Only together do {' and '.join(kinds)} bring about: {code}."
