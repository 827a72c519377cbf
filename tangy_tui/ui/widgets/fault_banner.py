"""The banner of a fault, below the status line; hidden while there is no fault.

While Tangy asks a person for help, the banner shows its words in full.
"""

from __future__ import annotations

from collections.abc import Sequence

from rich.cells import cell_len
from textual import events
from textual.strip import Strip

from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.widgets.inks import InkedWidget
from tangy_tui.ui.widgets.rows import draw, shorten
from tangy_tui.ui.widgets.wrapping import wrap

SEEN, ESC_SEEN = "  [{acknowledge}] seen", "  [esc, then {acknowledge}] seen"
"""The key that acknowledges a fault; the second while an input line takes letters."""

MOST_LINES = 4
"""From this number of lines on, the screen gives the banner no more room."""


class FaultBanner(InkedWidget):
    """Tells the fault and its recovery, with the key that acknowledges it.

    Its screen gets the class `-banner-2` while the banner has two lines, and so on.
    """

    DEFAULT_CSS = """
    FaultBanner { height: 1; padding: 0 1; background: $panel; display: none; }
    FaultBanner.-there { display: block; }
    """

    def __init__(self) -> None:
        super().__init__(id="banner")
        self._forms: tuple[str, ...] = ()
        self._said = ""
        self._more = 0
        self._ink = "warn"
        self._key = ""
        self._lines: list[str] = []

    @property
    def words(self) -> str:
        """Its text in the longest form, "" if there is no fault."""
        return self._forms[0] if self._forms else ""

    @property
    def said(self) -> str:
        """Tangy's request for help."""
        return self._said

    def show(
        self,
        forms: Sequence[str],
        *,
        said: str = "",
        more: int = 0,
        critical: bool = False,
        key: str = "",
    ) -> None:
        """Show a fault; without a form, hide the banner.

        Args:
            forms: the text, from its longest to its shortest form.
            said: Tangy's request for help, shown below.
            more: the number of other faults.
            critical: whether the fault halts the robot.
            key: the key that acknowledges it.
        """
        ink = "bad" if critical else "warn"
        new = (tuple(clean(form) for form in forms), clean(said), more, ink, key)
        if new != (self._forms, self._said, self._more, self._ink, self._key):
            self._forms, self._said, self._more, self._ink, self._key = new
            self._lay_out()

    def on_resize(self, event: events.Resize) -> None:
        """Wrap again."""
        self._lay_out()

    def _lay_out(self) -> None:
        there = bool(self._forms)
        width = max(10, self.app.size.width - 2)  # its own width is 0 while it is hidden
        self._lines = wrap(f"“{self._said}”", width) if self._said and there else []
        self.set_class(there, "-there")
        lines = 1 + len(self._lines)
        self.styles.height = lines
        for count in range(1, MOST_LINES + 1):
            self.screen.set_class(there and count == min(lines, MOST_LINES), f"-banner-{count}")
        self.refresh()

    def render_line(self, y: int) -> Strip:
        """Draw a line; the first ends with the key."""
        width = self.size.width
        if y:
            text = self._lines[y - 1] if y <= len(self._lines) else ""
            return draw(self, ((shorten(text, width), "strong"),), width)
        more = f"  +{self._more} more" if self._more else ""
        room = width - cell_len(more) - cell_len(self._key)
        fitting = (form for form in self._forms if cell_len(form) <= room)
        words = next(fitting, shorten(self._forms[-1], room) if self._forms else "")
        gap = " " * (room - cell_len(words))
        row = ((words, self._ink), (more, "dim"), (gap, "text"), (self._key, "strong"))
        return draw(self, row, width)
