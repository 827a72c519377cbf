"""Something to read before going on: what went wrong, or where something was put."""

from __future__ import annotations

from typing import ClassVar

from textual import events
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.content import Content
from textual.widgets import Static

from tangy_tui.ui.base import Dialog
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.fresh_keys import Clock, FreshKeys, clock_of

CLOSING_KEYS = ("enter", "space", "escape", "q")


class MessageDialog(Dialog[None]):
    """Shows a text, one paragraph for each line, until Enter, space or esc."""

    BINDINGS: ClassVar[list[BindingType]] = [Binding("enter", "nothing", "Close")]
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
        box = Static(
            Content.assemble(
                self._text, "\n\n", ("Enter", "$primary bold"), ("  go on", "$ink-dim")
            ),
            id="message",
            classes="box",
        )
        box.border_title = Content(self._title)
        yield box

    def on_mount(self) -> None:
        """Take note of the moment from which keys count."""
        self.call_after_refresh(self._keys.painted, self._clock or clock_of(self.app))

    def on_key(self, event: events.Key) -> None:
        """Close on Enter, space or esc."""
        event.stop()
        if event.key in CLOSING_KEYS and self._keys.fresh(event):
            self.answer(None)

    def action_nothing(self) -> None:
        """Do nothing: `on_key` has the keys, so that each can be looked at."""
