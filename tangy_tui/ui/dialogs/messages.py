"""The dialog with the last messages, to read them again."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime
from typing import ClassVar

from textual.binding import Binding, BindingType

from tangy_tui.text import messages as text
from tangy_tui.ui.dialogs.page import PageDialog
from tangy_tui.ui.widgets.page import PageLine, heading, paragraph


class MessagesDialog(PageDialog):
    """The last messages, the newest first, with the time at which each was shown, or happened."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape,q,exclamation_mark", "close", "Close", key_display="esc"),
    ]
    HELP = text.HELP

    def __init__(
        self,
        told: Sequence[tuple[datetime, str]],
        heading: str = "",
        before: Sequence[tuple[datetime, str]] = (),
    ) -> None:
        """Create the dialog.

        Args:
            told: the messages with their times.
            heading: the heading above the messages before an interruption.
            before: these messages.
        """
        super().__init__(text.TITLE, text.KEYS)
        self._told = sorted(told, key=lambda one: one[0])[::-1]
        self._heading, self._before = heading, tuple(reversed(before))

    def write(self, width: int) -> list[PageLine]:
        """Format the page for a width in cells."""
        lines: list[PageLine] = []
        for at, words in self._told:
            lines += paragraph(text.timed_message(at, words), width)
        if self._before:
            lines += heading(self._heading) if lines else heading(self._heading)[1:]
        for at, words in self._before:
            lines += paragraph(text.timed_message(at, words), width, "dim")
        return lines or paragraph(text.NONE_YET, width)
