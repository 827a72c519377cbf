"""The board of calls: a line for each column of the deck, a dot for each number not called."""

from __future__ import annotations

from collections.abc import Sequence

from textual.strip import Strip

from tangy_profiles.cards import Column, Deck
from tangy_tui.ui.widgets.inks import InkedWidget
from tangy_tui.ui.widgets.rows import Row, Span, draw

LETTER = "B "
CELL = 3
"""Width of a number in cells."""


class CallBoard(InkedWidget):
    """One line for each column of the deck; if not all numbers fit, only the called ones."""

    DEFAULT_CSS = """
    CallBoard { height: auto; }
    """

    def __init__(self, deck: Deck, id: str | None = "board") -> None:
        super().__init__(id=id)
        self.border_title = "Called"
        self._deck = deck
        self._called: tuple[int, ...] = ()
        if not deck.columns:
            self.display = False  # this activity has no calls

    def show(self, called: Sequence[int]) -> None:
        """Show the numbers called so far."""
        new = tuple(called)
        if new != self._called:
            self._called = new
            self.border_title = f"Called: {len(new)}"
            self.refresh()

    def get_content_height(self, container: object, viewport: object, width: int) -> int:
        """Return one line for each column of the deck."""
        return max(1, len(self._deck.columns))

    def render_line(self, y: int) -> Strip:
        """Draw one column of the deck as a line."""
        width = self.size.width
        columns = self._deck.columns
        row = column_row(columns[y], self._called, width) if y < len(columns) else ()
        return draw(self, row, width)


def column_row(column: Column, called: Sequence[int], width: int) -> Row:
    """Format a column of the deck as a line of some cells: all numbers, or only the called ones."""
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
