"""Messages between the application and its screens."""

from __future__ import annotations

from textual.message import Message


class Stop(Message, bubble=False):
    """The robot must stop now. Posted to every open screen; `reason` is a short text.

    Posted by ctrl+x (which also works inside dialogs), and before the program ends.
    """

    def __init__(self, reason: str) -> None:
        super().__init__()
        self.reason = reason


class OpenStep(Message):
    """A request to open a step of a demonstration."""

    def __init__(self, demonstration: str, number: int) -> None:
        """Request step `number`, counted from 1, of the demonstration with this id."""
        super().__init__()
        self.demonstration = demonstration
        self.number = number
