"""A message to read before continuing."""

from __future__ import annotations

from typing import ClassVar

from textual import events
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import VerticalScroll
from textual.content import Content
from textual.widgets import Static

from tangy_tui.ui.base import Dialog
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.type_ahead_guard import Clock, FreshKeys

CLOSING_KEYS = ("enter", "space", "escape", "q")


class MessageDialog(Dialog[None]):
    """Shows a text, one paragraph for each line, until Enter, space, esc or q."""

    BINDINGS: ClassVar[list[BindingType]] = [Binding("enter", "nothing", "Close")]
    DEFAULT_CSS = """
    MessageDialog Static { width: 100%; height: auto; }
    """
    HELP = "Read, and press Enter to go on."

    def __init__(
        self,
        text: str,
        title: str = "Tangy",
        *,
        clock: Clock | None = None,
    ) -> None:
        super().__init__(None)
        self._text = "\n".join(clean(line) for line in text.split("\n"))
        self._title = clean(title)
        self._clock = clock
        self._keys = FreshKeys()

    def compose(self) -> ComposeResult:
        """Lay out the text and the key."""
        box = VerticalScroll(Static(Content(self._text)), id="message", classes="box")
        box.border_title = Content(self._title)
        box.border_subtitle = "enter goes on"
        yield box

    def on_mount(self) -> None:
        """Focus the text, and accept keys from now on."""
        self.query_one(VerticalScroll).focus()
        self._keys.watch(self, self._clock)

    def on_key(self, event: events.Key) -> None:
        """Close on Enter, space, esc or q; the arrows scroll."""
        if event.key in CLOSING_KEYS and self._keys.take(event):
            self.answer(None)

    def action_nothing(self) -> None:
        """Do nothing: `on_key` handles the keys, to check each of them."""
