"""The check of a rule file in words: what it leaves unexplained."""

from __future__ import annotations

from collections.abc import Sequence

UNSEEN = "Evidence that no rule looks at"
UNRULED = "Simulated faults without a rule"
UNTRIED = "Rules that the simulator cannot bring about"


def together_words(kinds: Sequence[str], code: str) -> str:
    """Say which faults bring a rule about only together."""
    return f"Only together do {' and '.join(kinds)} bring about: {code}."
