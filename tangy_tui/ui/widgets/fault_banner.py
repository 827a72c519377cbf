"""The banner of a fault: under the status line, there only while there is a fault.

While Tangy asks somebody for help, its words stand there in full, whatever room there is below.
"""

from __future__ import annotations

from collections.abc import Sequence

from rich.cells import cell_len
from textual import events
from textual.strip import Strip

from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.widgets.inks import Inked
from tangy_tui.ui.widgets.rows import draw, shorten
from tangy_tui.ui.widgets.wrapping import wrap

SEEN, ESC_SEEN = "  [{acknowledge}] seen", "  [esc {acknowledge}] seen"
"""The key that says that a fault was seen; and while keys are letters of a line."""

MOST_LINES = 4
"""Lines from which the screen gives no more room to the banner."""


class FaultBanner(Inked):
    """Says what is wrong and what is done about it, with the key that says it was seen.

    The screen that it is on has the class `-banner-2` while it has two lines, and so on.
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
        """What it says, at its longest; nothing while there is no fault."""
        return self._forms[0] if self._forms else ""

    @property
    def said(self) -> str:
        """What Tangy asks somebody for."""
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
        """Say this; without a form go away.

        Args:
            forms: the same from its longest to its shortest form.
            said: what Tangy asks somebody for, which stands below.
            more: how many other faults there are.
            critical: whether it halts the robot.
            key: which key takes it away.
        """
        ink = "bad" if critical else "warn"
        new = (tuple(clean(form) for form in forms), clean(said), more, ink, key)
        if new != (self._forms, self._said, self._more, self._ink, self._key):
            self._forms, self._said, self._more, self._ink, self._key = new
            self._lay_out()

    def on_resize(self, event: events.Resize) -> None:
        """Give the words the lines that they need."""
        self._lay_out()

    def _lay_out(self) -> None:
        there = bool(self._forms)
        width = max(10, self.app.size.width - 2)  # while it is hidden it has none itself
        self._lines = wrap(f"“{self._said}”", width) if self._said and there else []
        self.set_class(there, "-there")
        lines = 1 + len(self._lines)
        self.styles.height = lines
        for count in range(1, MOST_LINES + 1):
            self.screen.set_class(there and count == min(lines, MOST_LINES), f"-banner-{count}")
        self.refresh()

    def render_line(self, y: int) -> Strip:
        """Draw a line; what is to be done with it stands at the end of the first."""
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
