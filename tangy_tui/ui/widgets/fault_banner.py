"""The banner of a fault: one line under the status line, there only while there is a fault."""

from __future__ import annotations

from typing import ClassVar

from rich.cells import cell_len
from textual.strip import Strip
from textual.widget import Widget

from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.themes import INK_CLASSES
from tangy_tui.ui.widgets.rows import draw, shorten

SEEN = "  [a] seen"


class FaultBanner(Widget):
    """Says what is wrong and what is done about it, with the key that says it was seen."""

    COMPONENT_CLASSES: ClassVar[set[str]] = set(INK_CLASSES)
    DEFAULT_CSS = """
    FaultBanner { height: 1; padding: 0 1; background: $panel; display: none; }
    FaultBanner.-there { display: block; }
    """

    def __init__(self) -> None:
        super().__init__(id="banner")
        self._words = ""
        self._ink = "warn"
        self._seen = False

    @property
    def words(self) -> str:
        """What it says; nothing while there is no fault."""
        return self._words

    def show(self, words: str, *, critical: bool = False, seen: bool = False) -> None:
        """Say this; `seen` is a fault that somebody has acknowledged. Empty: go away."""
        ink = "bad" if critical else "warn"
        if (words, ink, seen) != (self._words, self._ink, self._seen):
            self._words, self._ink, self._seen = clean(words), ink, seen
            self.set_class(bool(words), "-there")
            self.refresh()

    def render_line(self, y: int) -> Strip:
        """Draw the line; what is to be done with it stands at its end at every width."""
        width = self.size.width
        key = "" if self._seen else SEEN
        words = shorten(self._words, width - cell_len(key))
        gap = " " * (width - cell_len(words) - cell_len(key))
        return draw(self, ((words, self._ink), (gap, "text"), (key, "strong")), width)
