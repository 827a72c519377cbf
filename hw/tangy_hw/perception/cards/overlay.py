"""Draws a card reading over its image."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from tangy_hw.perception.cards.reader import CardReading
from tangy_profiles.cards import Deck

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Picture = NDArray[Any]

MARKED, HIDDEN, GRID = (60, 200, 0), (0, 140, 255), (255, 120, 0)  # blue, green, red
SIDE = 100  # side of a rectified cell in drawing units


def draw_reading(picture: Picture, reading: CardReading, deck: Deck) -> Picture:
    """Return the image (BGR) with the grid, marked cells circled, and hidden ones crossed."""
    import cv2
    import numpy as np

    drawn = picture.copy()
    thick = max(1, round(max(picture.shape[:2]) / 640))
    if reading.card is None:
        _write(drawn, reading.problem, (8 * thick, 24 * thick), thick)
        return drawn
    columns, rows = len(deck.columns), deck.rows
    here = np.array([(0, 0), (columns, 0), (columns, rows), (0, rows)], np.float32) * SIDE
    plane = cv2.getPerspectiveTransform(here, np.array(reading.corners, np.float32))

    def line(points: Any, tone: tuple[int, int, int], *, closed: bool = True) -> None:
        there = cv2.perspectiveTransform(np.array([points], np.float32) * SIDE, plane)
        whole = np.rint(there[0] * 16).astype(np.int32)
        cv2.polylines(drawn, [whole], closed, tone, thick, cv2.LINE_AA, 4)

    for row in range(rows + 1):
        line([(0, row), (columns, row)], GRID, closed=False)
    for column in range(columns + 1):
        line([(column, 0), (column, rows)], GRID, closed=False)
    turns = np.linspace(0, 2 * np.pi, 40, endpoint=False)
    ring = 0.42 * np.column_stack([np.cos(turns), np.sin(turns)]) + 0.5
    for cell in range(rows * columns):
        row, column = divmod(cell, columns)
        if reading.hidden >> cell & 1:
            for a, b in ((0.15, 0.85), (0.85, 0.15)):
                line([(column + a, row + 0.15), (column + b, row + 0.85)], HIDDEN, closed=False)
        elif reading.marked >> cell & 1:
            line(ring + np.array([column, row]), MARKED)
    _write(drawn, f"card {reading.card}", (8 * thick, 24 * thick), thick)
    return drawn


def _write(drawn: Picture, text: str, place: tuple[int, int], thick: int) -> None:
    """Write white text with a black outline, readable on any background."""
    import cv2

    for tone, wide in (((0, 0, 0), 4), ((255, 255, 255), 1)):
        cv2.putText(drawn, text, place, 0, 0.8 * thick, tone, wide * thick, cv2.LINE_AA)
