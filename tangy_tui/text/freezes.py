"""Words for a game that was paused because the program stood still."""

from __future__ import annotations

from tangy_tui.text.times import length

DETAIL = (
    "The program or this computer was stopped, or asleep. The game is paused. Before you go on, "
    "check where the robot stands and how people are."
)
GO_ON, STAY = "go on", "stay paused"


def question(seconds: float) -> str:
    """Say how many seconds the program stood still, and ask whether the game goes on."""
    return f"Tangy stood still for {length(seconds)}. Go on?"


def told_words(seconds: float) -> str:
    """Say in a line how many seconds it stood still, and how to go on."""
    return f"Tangy stood still for {length(seconds)}. The game is paused. Type: go on."
