"""Lines of styled text: how line-drawing widgets store, compare and draw them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from rich.cells import cell_len, set_cell_size
from rich.segment import Segment
from textual.geometry import Region, Size
from textual.scroll_view import ScrollView
from textual.strip import Strip

from tangy_tui.ui.widgets.inks import InkedWidget

Span = tuple[str, str]
"""A piece of text and its ink."""

Row = tuple[Span, ...]
"""One line."""


def fit(text: str, width: int) -> str:
    """Return text in exactly `width` cells: padded with spaces, or cut with an ellipsis."""
    if width <= 0:
        return ""
    if cell_len(text) <= width:
        return set_cell_size(text, width)
    return set_cell_size(text, width - 1).rstrip().ljust(width - 1) + "…" if width > 1 else "…"


def shorten(text: str, width: int) -> str:
    """Return text in at most `width` cells, cut with an ellipsis."""
    if cell_len(text) <= width:
        return text
    return set_cell_size(text, width - 1).rstrip() + "…" if width > 0 else ""


def shorten_name(name: str, width: int) -> str:
    """Return a name in at most `width` cells; a number at its end is kept: "User 12" as "U…12"."""
    number = name[len(name.rstrip("0123456789")) :]
    if cell_len(name) <= width or not number or len(number) + 2 > width:
        return shorten(name, width)
    return shorten(name[: -len(number)], width - len(number)) + number


def draw(widget: InkedWidget, row: Row, width: int, over: str = "") -> Strip:
    """Draw one line over the whole width of a widget."""
    segments = [
        Segment(text, widget.ink("blank" if text.isspace() else name, over))
        for text, name in row
        if text
    ]
    return Strip(segments).adjust_cell_length(width, widget.ink("blank", over))


class Rows:
    """The lines of a scrollable widget; redraws only those that changed."""

    def __init__(self, widget: RowView) -> None:
        self._widget = widget
        self._rows: list[Row] = []
        self._marks: dict[int, str] = {}
        self._strips: dict[int, Strip] = {}
        self._width = 0

    def __len__(self) -> int:
        return len(self._rows)

    @property
    def width(self) -> int:
        """The width of a line in cells."""
        return self._widget.scrollable_content_region.width

    @property
    def height(self) -> int:
        """The number of visible lines."""
        return self._widget.scrollable_content_region.height

    def put(self, rows: Sequence[Row], marks: Mapping[int, str] | None = None) -> None:
        """Replace the lines; `marks` names the ink over a whole line (cursor, now)."""
        new_marks = dict(marks or {})
        old = self._rows
        changed = {
            y
            for y in range(max(len(old), len(rows)))
            if y >= len(old)
            or y >= len(rows)
            or old[y] != rows[y]
            or self._marks.get(y) != new_marks.get(y)
        }
        self._rows = list(rows)
        self._marks = new_marks
        if len(rows) != len(old):
            self._widget.virtual_size = Size(0, len(rows))
        self.redraw(changed)

    def mark(self, marks: Mapping[int, str]) -> None:
        """Replace the marks over whole lines."""
        changed = {y for y in {*self._marks, *marks} if self._marks.get(y) != marks.get(y)}
        self._marks = dict(marks)
        self.redraw(changed)

    def redraw(self, changed: set[int]) -> None:
        """Redraw some lines, if they are visible."""
        top = self._widget.scroll_offset.y
        width = self._widget.size.width
        regions: list[Region] = []
        for y in changed:
            self._strips.pop(y, None)
            if top <= y < top + self._widget.size.height:
                regions.append(Region(0, y - top, width, 1))
        if regions and self._widget.is_attached:
            self._widget.refresh(*regions)

    def forget(self) -> None:
        """Clear the cache after a change of colours."""
        self._strips.clear()

    def strip(self, y: int) -> Strip:
        """Return line `y` of the widget, drawn or from the cache."""
        width = self.width
        if width != self._width:
            self._strips.clear()
            self._width = width
        index = y + self._widget.scroll_offset.y
        if index not in self._strips:
            row = self._rows[index] if index < len(self._rows) else ()
            self._strips[index] = draw(self._widget, row, width, self._marks.get(index, ""))
        return self._strips[index]

    def show(self, index: int) -> None:
        """Scroll as little as needed to show a line."""
        top, height = self._widget.scroll_offset.y, max(1, self.height)
        if index < top:
            self._widget.scroll_to(y=index, animate=False, force=True)
        elif index >= top + height:
            self._widget.scroll_to(y=index - height + 1, animate=False, force=True)


class RowView(ScrollView, InkedWidget):
    """A scrollable widget made of rows: `_rows.put` sets them, and redraws the changed ones."""

    DEFAULT_CSS = """
    RowView { overflow-x: hidden; scrollbar-size-vertical: 1; scrollbar-gutter: stable; }
    """

    def __init__(self, *, id: str | None = None, classes: str | None = None) -> None:
        super().__init__(id=id, classes=classes)
        self._rows = Rows(self)

    def notify_style_update(self) -> None:
        """Redraw in the new colours."""
        super().notify_style_update()
        self._rows.forget()

    def render_line(self, y: int) -> Strip:
        """Draw one line."""
        return self._rows.strip(y)
