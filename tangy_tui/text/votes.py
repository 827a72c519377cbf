"""Words for how often a behaviour was shown, and its share of the votes."""

from __future__ import annotations


def shown_here(seen: int, share: float) -> str:
    """Tell how often a behaviour was demonstrated, and its share of the votes if that is not 1."""
    votes = f"{share:.0%} of the votes"
    if not seen:
        return f"a guess of the trees, {votes}"
    times = "once" if seen == 1 else f"{seen} times"
    return f"as shown {times}" if share >= 1 else f"as shown {times}, {votes}"
