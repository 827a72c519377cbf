"""What the whole program tells its screens, and what they ask of it."""

from __future__ import annotations

from textual.message import Message


class Stop(Message, bubble=False):
    """The robot must stop now. Posted to every open screen; `reason` says why, in a few words.

    It comes from ctrl+x (which also works inside dialogs), and before the program ends.
    """

    def __init__(self, reason: str) -> None:
        super().__init__()
        self.reason = reason


class OpenStep(Message):
    """Somebody wants to see a step of a demonstration, which the program opens."""

    def __init__(self, demonstration: str, number: int) -> None:
        """Ask for step `number`, counted from 1, of the demonstration of this id."""
        super().__init__()
        self.demonstration = demonstration
        self.number = number
