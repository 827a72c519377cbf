"""Words for a game that was paused because the program was frozen."""

from __future__ import annotations

from tangy_tui.text.times import length

DETAIL = (
    "The program or this computer was stopped, or asleep. The game is paused. Before you go on, "
    "check where the robot stands and how people are."
)
GO_ON, STAY = "go on", "stay paused"


def question(seconds: float) -> str:
    """Tell how many s the program was frozen, and ask whether to continue."""
    return f"Tangy stood still for {length(seconds)}. Go on?"


def told_words(seconds: float) -> str:
    """Tell in a line how many s it was frozen, and how to continue."""
    return f"Tangy stood still for {length(seconds)}. The game is paused. Type: go on."
