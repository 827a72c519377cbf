"""The input line for a report about a person."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

from textual.binding import Binding, BindingType

from tangy_tui.text.telling import TELL, TELL_HELP, TELL_KEYS, telling_words
from tangy_tui.ui.dialogs.line import LineDialog


class TellDialog(LineDialog[str]):
    """An input line: Enter submits the report, esc closes."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape", "leave", "Tell nothing", priority=True)
    ]
    HELP = TELL_HELP

    def __init__(self, waits_for: str, sayable: Sequence[str]) -> None:
        """Create the dialog.

        Args:
            waits_for: the name of the person the game waits for, "" for nobody.
            sayable: the words that have a meaning now.
        """
        super().__init__(TELL, telling_words(waits_for, sayable), TELL_KEYS)

    def taken(self, line: str) -> str | None:
        """Return the line without spaces around it; None if it is empty."""
        return line.strip() or None
