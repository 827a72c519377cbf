"""A yes or no before an action that cannot be undone."""

from __future__ import annotations

from collections.abc import Callable
from typing import ClassVar

from textual import events
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.content import Content
from textual.widgets import Static

from tangy_tui.text.keys import with_keys
from tangy_tui.ui.base import Dialog
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.keys import keymap_of
from tangy_tui.ui.type_ahead_guard import Clock, FreshKeys, yes_key_of

SINCE_SECONDS = 0.5
"""The interval between two looks at what happened since the question was asked."""


class ConfirmDialog(Dialog[bool]):
    """Asks a question; only y means yes, n or esc mean no. Ignores keys typed ahead."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("y", "nothing", "Yes"),
        Binding("n", "nothing", "No"),
    ]
    HELP = "Press {yes} for yes, n or esc for no."

    def __init__(
        self,
        question: str,
        detail: str = "",
        *,
        yes: str = "yes",
        no: str = "no",
        clock: Clock | None = None,
        also: Callable[[], str] | None = None,
        obsolete: Callable[[], bool] | None = None,
    ) -> None:
        """Create the dialog.

        Args:
            question: the question.
            detail: its consequences.
            yes: the words for yes.
            no: the words for no.
            clock: the time in s, to drop keys that were typed ahead.
            also: returns a sentence about what happened since, "" if nothing did.
            obsolete: returns whether there is nothing left to ask; the dialog then closes.
        """
        super().__init__(False)
        self._also, self._since = also, ""
        self._obsolete = obsolete
        self._question = clean(question)
        self._detail = clean(detail)
        self._words = (clean(yes), clean(no))
        self._clock = clock
        self._keys = FreshKeys()
        self.yes_key = "y"

    def compose(self) -> ComposeResult:
        """Lay out question, detail and keys."""
        self.yes_key = yes_key_of(self.app)
        if self._also is not None:
            self._since = clean(self._also())
        yield Static(self._content(), id="confirm", classes="box")

    def _content(self) -> Content:
        parts: list[str | tuple[str, str] | Content] = [(self._question, "bold")]
        if self._detail:
            parts += ["\n\n", with_keys(self._detail, keymap_of(self.app))]
        if self._since:
            parts += ["\n\n", self._since]
        yes, no = self._words
        for key, colour, words in ((self.yes_key.upper(), "$warning", yes), ("N", "$success", no)):
            parts += ["\n" if key == "N" else "\n\n", (key, f"{colour} bold"), f"  {words}"]
        return Content.assemble(*parts)

    def on_mount(self) -> None:
        """Accept keys from now on."""
        self._keys.watch(self, self._clock)
        if self._also is not None:
            self.set_interval(SINCE_SECONDS, self._tell_since)
        if self._obsolete is not None:
            self.set_interval(SINCE_SECONDS, self._close_if_obsolete)

    def _close_if_obsolete(self) -> None:
        """Close with no, if what it asks about is over."""
        assert self._obsolete is not None  # noqa: S101 - else it is not called
        if self._obsolete():
            self.answer(False)

    def _tell_since(self) -> None:
        """Add what happened since the question was asked."""
        assert self._also is not None  # noqa: S101 - else it is not called
        since = clean(self._also())
        if since != self._since:
            self._since = since
            self.query_one("#confirm", Static).update(self._content())

    def on_key(self, event: events.Key) -> None:
        """Answer with the key for yes, n or esc."""
        if not self._keys.take(event):
            return
        if event.key.lower() == self.yes_key:
            self.answer(True)
        elif event.key.lower() in ("n", "escape"):
            self.answer(False)

    def action_nothing(self) -> None:
        """Do nothing: `on_key` handles the keys, to check each of them."""
