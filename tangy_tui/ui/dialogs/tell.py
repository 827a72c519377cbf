"""Telling what a person answers or does, in a line."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

from textual import events
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Vertical
from textual.content import Content
from textual.widgets import Input, Static

from tangy_tui.text.telling import TELL, TELL_HELP, TELL_KEYS, telling_words
from tangy_tui.ui.base import Dialog
from tangy_tui.ui.clean_output import clean

LONGEST = 200  # characters of a line


class TellDialog(Dialog[str | None]):
    """Takes a line; Enter tells it, esc tells nothing."""

    DEFAULT_CSS = """
    TellDialog Input { margin: 1 0 0 0; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape", "nothing", "Tell nothing", priority=True)
    ]
    HELP = TELL_HELP

    def __init__(self, waits_for: str, sayable: Sequence[str]) -> None:
        """Make the dialog.

        Args:
            waits_for: the name of whom the game waits for, "" for nobody.
            sayable: words that say something now.
        """
        super().__init__(None)
        self._detail = clean(telling_words(waits_for, sayable))

    def compose(self) -> ComposeResult:
        """Lay out the words that can be told, and the line."""
        line = Input(max_length=LONGEST, id="told")
        line.cursor_blink = False
        box = Vertical(Static(self._detail, markup=False), line, id="tell", classes="box")
        box.border_title = Content(TELL)
        box.border_subtitle = TELL_KEYS
        yield box

    def on_mount(self) -> None:
        """Let the line be typed."""
        self.query_one(Input).focus()

    def on_input_submitted(self, event: Input.Submitted) -> None:
        """Tell what was typed."""
        event.stop()
        self.answer(event.value.strip() or None)

    def on_key(self, event: events.Key) -> None:
        """Let letters be letters: none is a key here."""
        if event.is_printable:
            event.stop()

    def action_nothing(self) -> None:
        """Tell nothing."""
        self.answer(None)
