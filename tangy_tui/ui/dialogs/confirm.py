"""A yes or no before something that cannot be taken back."""

from __future__ import annotations

from typing import ClassVar

from textual import events
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.content import Content
from textual.widgets import Static

from tangy_tui.ui.base import Dialog
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.type_ahead_guard import Clock, FreshKeys, clock_of


class ConfirmDialog(Dialog[bool]):
    """Asks a question; only y says yes, and n or esc say no. Keys typed ahead do not answer."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("y", "nothing", "Yes"),
        Binding("n", "nothing", "No"),
    ]
    HELP = "Press y for yes, n or esc for no."

    def __init__(
        self,
        question: str,
        detail: str = "",
        *,
        yes: str = "yes",
        no: str = "no",
        clock: Clock | None = None,
    ) -> None:
        super().__init__(False)
        self._question = clean(question)
        self._detail = clean(detail)
        self._words = (clean(yes), clean(no))
        self._clock = clock
        self._keys = FreshKeys()

    def compose(self) -> ComposeResult:
        """Lay out question, detail and keys."""
        parts: list[str | tuple[str, str] | Content] = [(self._question, "bold")]
        if self._detail:
            parts += ["\n\n", self._detail]
        yes, no = self._words
        parts += ["\n\n", ("Y", "$warning bold"), f"  {yes}\n", ("N", "$success bold"), f"  {no}"]
        yield Static(Content.assemble(*parts), id="confirm", classes="box")

    def on_mount(self) -> None:
        """Take note of the moment from which keys count."""
        self.call_after_refresh(self._keys.painted, self._clock or clock_of(self.app))

    def on_key(self, event: events.Key) -> None:
        """Answer by y, n or esc."""
        if not self._keys.take(event):
            return
        if event.key in ("y", "Y"):
            self.answer(True)
        elif event.key in ("n", "N", "escape"):
            self.answer(False)

    def action_nothing(self) -> None:
        """Do nothing: `on_key` has the keys, so that each can be looked at."""
