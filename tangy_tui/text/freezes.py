"""Words for a game that was paused because the program was frozen."""

from __future__ import annotations

from tangy_tui.text.times import length

DETAIL = (
    "The program or this computer was stopped, or asleep. The game is paused. Before you go on, "
    "check where the robot stands and how people are."
)
GO_ON, STAY = "go on", "stay paused"
PAUSED = "The game is paused. Type: go on."


def question(seconds: float) -> str:
    """Tell how many s the program was frozen, and ask whether to continue."""
    return f"{stood_words(seconds)} Go on?"


def stood_words(seconds: float) -> str:
    """Tell for how many s it was frozen."""
    return f"Tangy stood still for {length(seconds)}."
