"""Doubts marks that differ from the card's other marks, because people mostly use one kind of chip.

False marks have no colour where chips have one (a stripe of shadow, blurred or glaring print), or
the colour of skin (a fingertip). If no mark has a colour, the card is marked with a pen, coins, or
white or grey chips; then a mark is doubted only if its number is bare on a card with many undecided
cells.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from tangy_hw.perception.cards.classifier import HIDDEN, MARKED, UNMARKED
from tangy_hw.perception.cards.features import CellFeatures

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Real = NDArray[Any]

# Chosen on 520 frames of stripes, glare, motion and fingers, in which 2,300 cells with chips and 36
# without were classified as marked; `tests.bench.card_harsh` makes such frames, and others for
# testing.
COLOURED = 0.15
"""Difference from the paper's colour, relative to its brightness, of a coloured chip; the palest
had .151."""
PALE = 0.3
"""Share of the usual colour of the card's coloured marks below which a mark has none. Chips had .63
and more, bare cells .28 and less."""
FLESH = 0.6
"""Share of the usual colour below which a mark with the hue of skin may be a finger."""
SKIN = -70.0, -8.0
"""Range of skin hues: degrees of blue over red, each minus green."""
BARE = 0.55
"""Correlation with its number above which the number of a colourless mark is bare: 95 in 100 of
such chips and coins had less."""
MUDDLED = 6
"""Minimum of undecided visible cells for this rule. Cards with bare cells classified as
marked had 10 or more, cards with coins or white chips mostly none."""
BESIDE = 0.3
"""Probability of hidden cells beside which a finger may end."""


def unlike_others(measured: CellFeatures, parts: Real, told: Real, across: int) -> Real:
    """Return which marks differ so much from the others that they may be false.

    Args:
        measured: features of a card's cells.
        parts: class probabilities (cells, classes).
        told: decided cells (cells,) bool.
        across: number of the grid's columns.

    Returns:
        The doubted marks (cells,) bool.
    """
    import numpy as np

    marks = told & (parts[:, MARKED] > parts[:, UNMARKED])
    colour = np.maximum(measured.compared("dyed"), measured.compared("dyed middle"))
    coloured = marks & (colour >= COLOURED)
    usual = float(np.median(colour[coloured])) if coloured.any() else COLOURED / PALE
    pale = colour < PALE * usual
    mostly = 2 * int(coloured.sum()) > int(marks.sum())
    muddled = int((~told & (parts[:, HIDDEN] < BESIDE)).sum()) >= MUDDLED
    bare = pale & (measured.compared("print") >= BARE) if muddled else np.zeros_like(pale)
    doubted: Real = marks & (bare | (pale & mostly) | _fingers(measured, parts, coloured, across))
    return doubted


def _fingers(measured: CellFeatures, parts: Real, coloured: Real, across: int) -> Real:
    """Return which cells may show the end of a finger."""
    import numpy as np

    colour = np.maximum(measured.compared("dyed"), measured.compared("dyed middle"))
    way = np.degrees(np.arctan2(measured.compared("blue"), measured.compared("red")))
    flesh = (way >= SKIN[0]) & (way <= SKIN[1])
    usual = float(np.median(colour[coloured])) if coloured.any() else 0.0
    faint = flesh & (colour < FLESH * usual)
    beside = _beside((parts[:, HIDDEN] >= BESIDE).reshape(-1, across))
    if (coloured & ~(flesh & beside)).any():  # there are chips elsewhere to compare with
        return np.asarray(faint)
    return np.asarray(faint | (flesh & beside))


def _beside(hidden: Real) -> Real:
    """Return which cells have a hidden neighbour (cells,) bool."""
    import numpy as np

    rows, columns = hidden.shape
    wide = np.pad(hidden, 1)
    near = [wide[y : y + rows, x : x + columns] for y in range(3) for x in range(3)]
    return np.asarray(np.any(near, 0).ravel())
