"""A page of text with lines to choose, like the links in a text browser."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

from textual.geometry import Size
from textual.message import Message

from tangy_tui.text.phrases import NONE_FOUND
from tangy_tui.ui.widgets.choosable import Choosable
from tangy_tui.ui.widgets.rows import Row
from tangy_tui.ui.widgets.wrapping import wrap

PAGE = 10
"""Cursor steps of a page up or down."""


class PageLine(NamedTuple):
    """One line, and the index of its choice, if it belongs to one."""

    row: Row = ()
    choice: int | None = None


Write = Callable[[int], Sequence[PageLine]]
"""Formats the page for a width in cells; the choices come in order."""


def paragraph(text: str, width: int, ink: str = "text") -> list[PageLine]:
    """Wrap a sentence."""
    return [PageLine(((line, ink),)) for line in wrap(text, width)]


def heading(text: str) -> list[PageLine]:
    """Format a heading with an empty line above it."""
    return [PageLine(), PageLine(((text, "robot"),))]


def _text(line: PageLine) -> str:
    return "".join(text for text, _ in line.row)


class Page(Choosable):
    """Up and down go to the next choice, or scroll if it is out of sight; Enter chooses it."""

    class Chosen(Message):
        """A line was chosen with Enter; `index` is that of the choice."""

        def __init__(self, page: Page, index: int) -> None:
            super().__init__()
            self.page = page
            self.index = index

        @property
        def control(self) -> Page:
            """The page that it was chosen on."""
            return self.page

    def __init__(
        self, write: Write | None = None, *, id: str | None = None, classes: str | None = None
    ) -> None:
        super().__init__(id=id, classes=classes)
        self._write = write
        self._lines: dict[int, range] = {}  # of each choice that is shown, by its position
        self._choices: list[int] = []  # their indices
        self.moved = False
        """Whether a key has moved the cursor, or scrolled."""

    @property
    def chosen(self) -> int | None:
        """The index of the choice at the cursor."""
        if self._cursor is None or self._cursor >= len(self._choices):
            return None
        return self._choices[self._cursor]

    @property
    def cursor(self) -> int | None:
        """The position of the choice at the cursor, from 0."""
        return self._cursor

    def show(self, write: Write, cursor: int | None = 0) -> None:
        """Replace the page, with the cursor on one of its choices."""
        self._write = write
        self._cursor = cursor
        self._show()

    def get_content_height(self, container: Size, viewport: Size, width: int) -> int:
        """Return the number of lines."""
        return len(self._write(width)) if self._write is not None and width > 0 else 0

    def action_choose(self, by: int) -> None:
        """Move the cursor to a choice in sight; otherwise scroll towards it."""
        self.moved = True
        if abs(by) > PAGE:
            super().action_choose(by)
            self.scroll_to(y=0 if by < 0 else self.max_scroll_y, animate=False, force=True)
            return
        step = by if abs(by) < PAGE else (1 if by > 0 else -1) * max(1, self._rows.height - 1)
        wanted = (-1 if self._cursor is None else self._cursor) + by
        places = self._lines.get(min(max(wanted, 0), len(self._lines) - 1))
        top = self.scroll_offset.y
        seen = range(top - abs(step), top + self._rows.height + abs(step))
        if places and wanted in self._lines and places[0] in seen and places[-1] in seen:
            super().action_choose(by)
        else:
            self.scroll_to(y=top + step, animate=False, force=True)
            if abs(by) == PAGE:
                self._follow(step)

    def _follow(self, step: int) -> None:
        """Move the cursor into sight after a page up or down."""
        top = self.scroll_offset.y
        seen = range(top, top + self._rows.height)
        found = [n for n, places in self._lines.items() if places[0] in seen]
        if found:
            self._cursor = found[-1] if step > 0 else found[0]
            self._rows.mark(dict.fromkeys(self._places(self._cursor), "cursor"))

    def _length(self) -> int:
        return len(self._lines)

    def _places(self, index: int) -> range:
        return self._lines.get(index, range(0))

    def _tell(self, index: int) -> None:
        if index in self._lines:
            self.post_message(self.Chosen(self, self._choices[index]))

    def _kept(self, lines: Sequence[PageLine]) -> Sequence[PageLine]:
        """Return the lines that match the filter; lines of one choice stay together."""
        if not self.filter:
            return lines
        texts: dict[int, str] = {}
        for line in lines:
            if line.choice is not None:
                texts[line.choice] = f"{texts.get(line.choice, '')} {_text(line)}"
        kept = [
            line
            for line in lines
            if self._has(_text(line) if line.choice is None else texts[line.choice])
        ]
        return kept or [PageLine(((NONE_FOUND, "dim"),))]

    def _show(self) -> None:
        width = self._rows.width
        if not self.is_attached or width <= 0 or self._write is None:
            return
        lines = self._kept(self._write(width))
        places: dict[int, range] = {}
        for y, line in enumerate(lines):
            if line.choice is not None:
                first = places.get(line.choice, range(y, y))
                places[line.choice] = range(first.start, y + 1)
        self._choices = list(places)
        self._lines = dict(enumerate(places.values()))
        if self._cursor is None or self._cursor >= len(self._lines):
            self._cursor = 0 if self._lines else None
        self._rows.put([line.row for line in lines])
        under = range(0) if self._cursor is None else self._places(self._cursor)
        self._rows.mark(dict.fromkeys(under, "cursor"))
