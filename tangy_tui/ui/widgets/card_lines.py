"""A card as lines of text: marked, wrongly marked, missed and hidden numbers."""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil, sqrt
from typing import TYPE_CHECKING

from tangy_profiles.scene import CardView
from tangy_tui.ui.widgets.rows import Row, Span

if TYPE_CHECKING:
    from tangy_hw.perception.camera_hub import SeenCard

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
    """Format a card, one line for each row; a card is square, or a little wider than high."""
    columns = max(1, ceil(sqrt(len(card.numbers))))
    lines: list[Row] = []
    for first in range(0, len(card.numbers), columns):
        places = range(first, min(first + columns, len(card.numbers)))
        lines.append(tuple(_cell(card, place) for place in places))
    return lines


SEEN_LEGEND: Row = (
    ("[7]", "good"),
    (" marked  ", "dim"),
    ("░7░", "warn"),
    (" not seen", "dim"),
)


def seen_card_lines(card: SeenCard, letters: Sequence[str]) -> list[Row]:
    """Format a card as the robot read it, below its letters; hidden numbers are hatched."""
    lines: list[Row] = [tuple((_fill(letter, "  "), "strong") for letter in letters)]
    for first in range(0, len(card.numbers), card.columns):
        places = range(first, min(first + card.columns, len(card.numbers)))
        lines.append(tuple(_seen_cell(card, place) for place in places))
    return lines


def _seen_cell(card: SeenCard, place: int) -> Span:
    number = str(card.numbers[place])
    if card.free >> place & 1:
        return "free".rjust(CELL), "dim"
    if card.hidden >> place & 1:
        return _fill(number, "░░"), "warn"
    if card.marked >> place & 1:
        return _fill(number, "[]"), "good"
    return _fill(number, "  "), "text"


def _cell(card: CardView, place: int) -> Span:
    number = str(card.numbers[place])
    marked, called = card.marked >> place & 1, card.called >> place & 1
    match marked, called:
        case 1, 1:
            return _fill(number, "[]"), "good"
        case 1, 0:
            return _fill(number, "!!"), "bad"
        case 0, 1:
            return _fill(number, "??"), "warn"
        case _:
            return _fill(number, "  "), "dim"


def _fill(number: str, marks: str) -> str:
    return f"{marks[0]}{number}{marks[1]}".rjust(CELL)
