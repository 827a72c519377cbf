"""Live games in words: switching a robot on, and how it comes to be where it is."""

from __future__ import annotations

STARTING = "Its devices are being started. It stands still until the game begins."
CALLED_OFF = "It is being switched off again."

LOOKS_ROUND = "Tangy does not know where it is: it turns on the spot, then drives to the front."
MAY_MOVE = "Tangy may move again."


def frozen_words(seconds: float) -> str:
    """Say for how many `seconds` (s) the program in the robot was frozen, and what came of it."""
    return (
        f"The program in the robot was frozen for {seconds:.0f} s. Tangy has stopped what it "
        "was doing, and stands still until you let it go on."
    )


SWITCH_ON_DETAIL = (
    "Make sure that it stands at the front and faces the people, that nobody is close to it, and "
    "that someone is near its stop button. In the game ctrl+x stops it, too."
)


def switch_on_words(robot: str) -> str:
    """Ask before a robot is switched on."""
    return f"Switch {robot} on?"
