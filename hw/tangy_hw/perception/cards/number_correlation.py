"""Correlates the cells of a rectified grid with the numbers that may be printed there."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING, Any

from tangy_hw.perception.cards.cell_maps import whole_cells
from tangy_hw.perception.cards.rectification import SIDE
from tangy_profiles.card_face import CardLayout
from tangy_profiles.card_picture import draw_number

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Picture = NDArray[Any]
    Real = NDArray[Any]

INNER = 26  # pixels of a cell's middle with its number
SHIFT = 2  # pixels that a number may be off its place


def numbers_read(light: Real, face: CardLayout, numbers: tuple[int, ...], scale: float) -> Real:
    """Correlate each cell with the numbers of its column.

    Returns:
        For each cell (n, 4): the best correlation with its own number, with any other, with its own
        at its exact place, and the contrast of the cell's middle.
    """
    import numpy as np

    rows, columns = face.deck.rows, len(face.deck.columns)
    cells = whole_cells(light, rows, columns)
    edge = (SIDE - INNER) // 2
    found = np.zeros((rows * columns, 4), np.float32)
    shifts = [(a, b) for a in range(-SHIFT, SHIFT + 1) for b in range(-SHIFT, SHIFT + 1)]
    windows = np.stack(
        [cells[:, edge + a : edge + a + INNER, edge + b : edge + b + INNER] for a, b in shifts],
        1,
    ).reshape(rows * columns, len(shifts), -1)
    windows = windows - windows.mean(2, keepdims=True)
    spread = np.linalg.norm(windows, axis=2, keepdims=True)
    windows = windows / np.maximum(spread, 1e-3)
    for place, column in enumerate(face.deck.columns):
        prints = _prints(face, column.low, column.high, round(min(1.5, scale), 1))
        here = np.arange(place, rows * columns, columns)
        match = windows[here] @ prints.T  # (cells, shifts, numbers)
        best = match.max(1)
        for order, cell in enumerate(here):
            own = numbers[cell] - column.low
            others = np.delete(best[order], own)
            found[cell] = (
                best[order, own],
                others.max() if others.size else -1.0,
                match[order, len(shifts) // 2, own],
                spread[cell, len(shifts) // 2, 0] / INNER,
            )
    return found


@lru_cache(maxsize=1000)
def _drawn(face: CardLayout, number: int) -> Picture:
    return draw_number(face, number, SIDE)


@lru_cache(maxsize=256)
def _prints(face: CardLayout, low: int, high: int, scale: float) -> Real:
    """Return templates of numbers at a scale, each a row with norm 1 and mean 0."""
    import cv2
    import numpy as np

    edge = (SIDE - INNER) // 2
    rows = []
    for number in range(low, high + 1):
        drawn = cv2.GaussianBlur(_drawn(face, number), (0, 0), min(2.5, 0.55 / scale))
        inner = drawn[edge : edge + INNER, edge : edge + INNER].astype(np.float32).ravel()
        inner = inner - inner.mean()
        rows.append(inner / max(float(np.linalg.norm(inner)), 1e-3))
    return np.array(rows, np.float32)
