"""A dialog with a page of text, which scrolls, and closes without an answer."""

from __future__ import annotations

from textual.app import ComposeResult
from textual.containers import Vertical
from textual.content import Content

from tangy_tui.ui.base import Dialog
from tangy_tui.ui.widgets.page import Page, PageLine


class PageDialog(Dialog[None]):
    """The base of dialogs to read: they write the page, and bind keys to `close`."""

    DEFAULT_CSS = """
    PageDialog > .box { width: 78; padding: 0 1; }
    PageDialog Page { height: auto; max-height: 1fr; }
    """

    def __init__(self, title: str, keys: str = "esc closes") -> None:
        """Create the dialog with the title and the keys on the border of its box."""
        super().__init__(None)
        self._title, self._keys = title, keys

    def compose(self) -> ComposeResult:
        """Lay out the page."""
        box = Vertical(Page(self.write), classes="box")
        box.border_title = Content(self._title)
        box.border_subtitle = self._keys
        yield box

    def on_mount(self) -> None:
        """Focus the page."""
        self.query_one(Page).focus()

    def action_close(self) -> None:
        """Close the dialog."""
        self.answer(None)

    def write(self, width: int) -> list[PageLine]:
        """Format the page for a width in cells."""
        raise NotImplementedError
