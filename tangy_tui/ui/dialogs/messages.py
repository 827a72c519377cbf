"""The dialog with the last messages, to read them again."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime
from typing import ClassVar

from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Vertical
from textual.content import Content

from tangy_tui.text import messages as text
from tangy_tui.ui.base import Dialog
from tangy_tui.ui.widgets.page import Page, PageLine, heading, paragraph


class MessagesDialog(Dialog[None]):
    """The last messages, the newest first, with the time at which each was shown."""

    DEFAULT_CSS = """
    MessagesDialog > .box { width: 78; padding: 0 1; }
    MessagesDialog Page { height: auto; max-height: 1fr; }
    """
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
            told: the messages with their times, the oldest first.
            heading: the heading above the messages before an interruption.
            before: these messages.
        """
        super().__init__(None)
        self._told = tuple(reversed(told))
        self._heading, self._before = heading, tuple(reversed(before))

    def compose(self) -> ComposeResult:
        """Lay out the page."""
        box = Vertical(Page(self._write), id="messages", classes="box")
        box.border_title = Content(text.TITLE)
        box.border_subtitle = text.KEYS
        yield box

    def on_mount(self) -> None:
        """Focus the page."""
        self.query_one(Page).focus()

    def action_close(self) -> None:
        """Close the dialog."""
        self.answer(None)

    def _write(self, width: int) -> list[PageLine]:
        lines: list[PageLine] = []
        for at, words in self._told:
            lines += paragraph(text.told_words(at, words), width)
        if self._before:
            lines += heading(self._heading) if lines else heading(self._heading)[1:]
        for at, words in self._before:
            lines += paragraph(text.told_words(at, words), width, "dim")
        return lines or paragraph(text.NONE_YET, width)
