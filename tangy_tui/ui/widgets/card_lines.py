"""The card beside the robot as a few lines of text: what is marked, wrongly marked, missed."""

from __future__ import annotations

from math import ceil, sqrt

from tangy_profiles.scene import CardView
from tangy_tui.ui.widgets.rows import Row, Span

CELL = 5  # columns of one number with its marks

LEGEND: Row = (
    ("[7]", "good"),
    (" marked  ", "dim"),
    ("!7!", "bad"),
    (" wrong  ", "dim"),
    ("?7?", "warn"),
    (" missed", "dim"),
)


def card_lines(card: CardView) -> list[Row]:
    """Write a card, one line for each of its rows; cards are as wide as high, or a bit wider."""
    columns = max(1, ceil(sqrt(len(card.numbers))))
    lines: list[Row] = []
    for first in range(0, len(card.numbers), columns):
        places = range(first, min(first + columns, len(card.numbers)))
        lines.append(tuple(_cell(card, place) for place in places))
    return lines


def _cell(card: CardView, place: int) -> Span:
    number = str(card.numbers[place])
    marked, called = card.marked >> place & 1, card.called >> place & 1
    match marked, called:
        case 1, 1:
            return f"[{number}]".rjust(CELL), "good"
        case 1, 0:
            return f"!{number}!".rjust(CELL), "bad"
        case 0, 1:
            return f"?{number}?".rjust(CELL), "warn"
        case _:
            return f"{number} ".rjust(CELL), "dim"
