"""The board of what was called: a line for each column of the deck, a dot for what was not."""

from __future__ import annotations

from collections.abc import Sequence

from textual.strip import Strip

from tangy_profiles.cards import Column, Deck
from tangy_tui.ui.widgets.inks import Inked
from tangy_tui.ui.widgets.rows import Row, Span, draw

LETTER = "B "
CELL = 3
"""Columns of the screen that a number takes."""


class CallBoard(Inked):
    """One line for each column; where not all numbers fit, only those that were called."""

    DEFAULT_CSS = """
    CallBoard { height: auto; }
    """

    def __init__(self, deck: Deck, id: str | None = "board") -> None:
        super().__init__(id=id)
        self.border_title = "Called"
        self._deck = deck
        self._called: tuple[int, ...] = ()
        if not deck.columns:
            self.display = False  # nothing is called in this activity

    def show(self, called: Sequence[int]) -> None:
        """Show what was called so far."""
        new = tuple(called)
        if new != self._called:
            self._called = new
            self.border_title = f"Called: {len(new)}"
            self.refresh()

    def get_content_height(self, container: object, viewport: object, width: int) -> int:
        """Take a line for each column of the deck."""
        return max(1, len(self._deck.columns))

    def render_line(self, y: int) -> Strip:
        """Draw one column of the deck as a line."""
        width = self.size.width
        columns = self._deck.columns
        row = column_row(columns[y], self._called, width) if y < len(columns) else ()
        return draw(self, row, width)


def column_row(column: Column, called: Sequence[int], width: int) -> Row:
    """Write a column of the deck as a line of so many cells: all numbers, or those called."""
    numbers = list(range(column.low, column.high + 1))
    if len(numbers) * CELL + len(LETTER) > width:
        numbers = [n for n in numbers if n in called]
    spans: list[Span] = [(f"{column.letter:<{len(LETTER)}}", "strong")]
    for number in numbers:
        if number not in called:
            spans.append((f"{'·':>{CELL}}", "dim"))
        else:
            last = number == called[-1]
            spans.append((f"{number:>{CELL}}", "robot" if last else "text"))
    return tuple(spans)
