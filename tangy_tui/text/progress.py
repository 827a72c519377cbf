"""Words for the coverage of an activity by demonstrations."""

from __future__ import annotations

from tangy_tui.text.numbers import counted

NOTHING_SHOWN = "Nobody has shown Tangy anything yet."


def coverage_so_far(number: int, game: int, steps: int, shown: int, situations: int) -> str:
    """Tell the coverage up to a demonstration, given by number."""
    return (
        f"Demonstration {number} (game {game}): {counted(steps, 'step')}; "
        f"{shown} of {situations} situations were shown so far."
    )


def situations_shown(shown: int, situations: int) -> str:
    """Tell how many situations were demonstrated."""
    return f"{shown} of {situations} situations were shown."
