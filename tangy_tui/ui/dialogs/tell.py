"""Telling what a person answers or does, in a line."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

from textual.binding import Binding, BindingType

from tangy_tui.text.telling import TELL, TELL_HELP, TELL_KEYS, telling_words
from tangy_tui.ui.dialogs.line import LineDialog


class TellDialog(LineDialog[str]):
    """Takes a line; Enter tells it, esc tells nothing."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape", "leave", "Tell nothing", priority=True)
    ]
    HELP = TELL_HELP

    def __init__(self, waits_for: str, sayable: Sequence[str]) -> None:
        """Make the dialog.

        Args:
            waits_for: the name of whom the game waits for, "" for nobody.
            sayable: words that say something now.
        """
        super().__init__(TELL, telling_words(waits_for, sayable), TELL_KEYS)

    def taken(self, line: str) -> str | None:
        """Return the line without spaces around it; None if it is empty."""
        return line.strip() or None
