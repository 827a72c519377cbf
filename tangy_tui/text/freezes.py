"""What staff are told after the program itself stood still."""

from __future__ import annotations

from tangy_tui.text.times import length

DETAIL = (
    "The program or this computer was stopped, or slept. The game is paused. Look how the robot "
    "stands and how people are before you go on."
)
GO_ON, STAY = "go on", "stay paused"


def question(seconds: float) -> str:
    """Say how many seconds the program stood still, and ask whether the game goes on."""
    return f"Tangy stood still for {length(seconds)}. Go on?"


def told_words(seconds: float) -> str:
    """Say by a line how many seconds it stood still, and how the game goes on."""
    return f"Tangy stood still for {length(seconds)}. The game is paused. Type: go on."
