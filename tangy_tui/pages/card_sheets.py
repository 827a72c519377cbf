"""Printed cards, two to a sheet, and the tally sheet for called numbers."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import UTC, datetime
from typing import TYPE_CHECKING

from tangy_profiles.activity import Activity
from tangy_profiles.card_face import HEIGHT, TAGS, WIDTH, Box, CardLayout
from tangy_profiles.card_picture import CAPITALS, font_file, white_modules

if TYPE_CHECKING:
    from fpdf import FPDF

PAPERS = {"a4": (297.0, 210.0), "letter": (279.4, 215.9), "a5": (148.0, 210.0)}
"""Width and height of a sheet in mm: two cards side by side, or one on A5, which is cut."""
CUT = 4.0  # mm, the length of a cut mark
POINTS = 72 / 25.4  # to the mm
LONG_AGO = datetime(2000, 1, 1, tzinfo=UTC)  # a fixed date: the same cards give the same file


def card_sheets(activity: Activity, cards: Sequence[int], seed: int, paper: str) -> bytes:
    """Create a PDF of cards, two to a sheet with cut marks (A5: one), and of the call sheet."""
    from fpdf import FPDF

    width, height = PAPERS[paper]
    beside = 2 if width > height else 1
    size = min(width, height), max(width, height)
    pdf = FPDF("landscape" if beside == 2 else "portrait", unit="mm", format=size)
    pdf.set_creation_date(LONG_AGO)
    pdf.set_title(f"{activity.title}: cards {cards[0]} to {cards[-1]}, deck {seed}")
    pdf.set_auto_page_break(False)
    pdf.set_margin(0)
    pdf.add_font("cards", fname=font_file())
    face = CardLayout(activity.deck)
    scale = min(width / beside / WIDTH, height / HEIGHT)
    for place, card in enumerate(cards):
        if place % beside == 0:
            pdf.add_page()
            if beside == 2:
                _cut_marks(pdf, width, height, scale)
        left = width / 2 - WIDTH * scale * (beside / 2 - place % beside)
        pen = _Pen(pdf, left, (height - HEIGHT * scale) / 2, scale)
        for box in (*TAGS, *face.lines()):
            pen.fill(box)
        for box in white_modules(card):
            pen.fill(box, white=True)
        for words in face.words(card, seed, activity.title):
            pen.write(words.text, words.x, words.y, words.high)
    _call_sheet(pdf, activity, seed, *size)
    return bytes(pdf.output())


class _Pen:
    """Draws in a card's mm on a sheet, with the card's position and scale."""

    def __init__(self, pdf: FPDF, left: float, top: float, scale: float) -> None:
        self._pdf, self._left, self._top, self._scale = pdf, left, top, scale

    def fill(self, box: Box, *, white: bool = False) -> None:
        self._pdf.set_fill_color(255 if white else 0)
        self._pdf.rect(
            self._left + box.left * self._scale,
            self._top + box.top * self._scale,
            (box.right - box.left) * self._scale,
            (box.bottom - box.top) * self._scale,
            style="F",
        )

    def write(self, text: str, x: float, y: float, high: float) -> None:
        self._pdf.set_font("cards", size=high / CAPITALS * self._scale * POINTS)
        self._pdf.text(
            self._left + x * self._scale - self._pdf.get_string_width(text) / 2,
            self._top + (y + high / 2) * self._scale,
            text,
        )


def _cut_marks(pdf: FPDF, width: float, height: float, scale: float) -> None:
    """Draw short grey lines where the cards are cut, except at the edges of the sheet."""
    pdf.set_draw_color(120)
    pdf.set_line_width(0.2)
    middle, across, down = width / 2, WIDTH * scale, HEIGHT * scale
    top, left = (height - down) / 2, middle - across
    for x in (left, middle, left + 2 * across):
        if 1 < x < width - 1:
            pdf.line(x, 0, x, max(CUT, top - 1))
            pdf.line(x, height, x, min(height - CUT, top + down + 1))
    for y in (top, top + down):
        if 1 < y < height - 1:
            for x in (0.0, width - CUT, middle - CUT / 2):
                pdf.line(x, y, x + CUT, y)


def _call_sheet(pdf: FPDF, activity: Activity, seed: int, width: float, height: float) -> None:
    """Add an upright page with every number of the deck and a box to tick it."""
    deck = activity.deck
    pdf.add_page(orientation="portrait")
    pen = _Pen(pdf, 0, 0, 1)
    pen.write(f"{activity.title}: what was called", width / 2, 18, 5)
    pen.write(f"deck {seed}", width / 2, 27, 3)
    longest = max(column.high - column.low + 1 for column in deck.columns)
    across = (width - 30) / len(deck.columns)
    down = min((height - 70) / longest, 16)
    pdf.set_draw_color(0)
    pdf.set_line_width(0.3)
    for place, column in enumerate(deck.columns):
        x = 15 + (place + 0.5) * across
        pen.write(column.letter, x, 40, 6)
        for row, number in enumerate(range(column.low, column.high + 1)):
            y = 50 + (row + 0.5) * down
            side = min(down, across) * 0.5
            pen.write(str(number), x - across * 0.15, y, min(down, across) * 0.35)
            pdf.rect(x + across * 0.15, y - side / 2, side, side)
