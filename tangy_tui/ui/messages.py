"""What the whole program tells its screens."""

from __future__ import annotations

from textual.message import Message


class Stop(Message, bubble=False):
    """The robot must stop now. Posted to every open screen; `reason` says why, in a few words.

    It comes from ctrl+x (which also works inside dialogs), and before the program ends.
    """

    def __init__(self, reason: str) -> None:
        super().__init__()
        self.reason = reason
