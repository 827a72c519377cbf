"""The question whether a person complied: yes, no, or unknown."""

from __future__ import annotations

from typing import ClassVar

from textual import events
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.content import Content
from textual.widgets import Static

from tangy_tui.ui.base import Dialog
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.type_ahead_guard import Clock, FreshKeys


class AnswerDialog(Dialog[bool | None]):
    """Asks whether a person complied: y, n, or esc to leave it open. Ignores keys typed ahead."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("y", "nothing", "They did it"),
        Binding("n", "nothing", "They would rather not"),
        Binding("escape", "nothing", "Leave it open"),
    ]
    HELP = (
        "They did it if they did what they were asked, in time, after it was said this way. "
        "Press y if they did, n if they did not, and esc to leave it open."
    )

    def __init__(self, question: str, detail: str = "", *, clock: Clock | None = None) -> None:
        super().__init__(None)
        self._question = clean(question)
        self._detail = clean(detail)
        self._clock = clock
        self._keys = FreshKeys()

    def compose(self) -> ComposeResult:
        """Lay out question, detail and keys."""
        parts: list[str | tuple[str, str] | Content] = [(self._question, "bold")]
        if self._detail:
            parts += ["\n\n", self._detail]
        for key, word in (
            ("Y", "they did it"),
            ("N", "they would rather not"),
            ("esc", "leave it open"),
        ):
            parts += ["\n\n" if key == "Y" else "\n", (f"{key:<3}", "$primary bold"), f"  {word}"]
        yield Static(Content.assemble(*parts), id="answer", classes="box")

    def on_mount(self) -> None:
        """Accept keys from now on."""
        self._keys.watch(self, self._clock)

    def on_key(self, event: events.Key) -> None:
        """Answer by y, n or esc."""
        if not self._keys.take(event):
            return
        if event.key in ("y", "Y", "n", "N"):
            self.answer(event.key in ("y", "Y"))
        elif event.key == "escape":
            self.answer(None)

    def action_nothing(self) -> None:
        """Do nothing: `on_key` handles the keys, to check each of them."""
