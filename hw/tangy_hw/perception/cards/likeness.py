"""Marks that are unlike the card's other marks: people mark with chips of one kind mostly.

What looks like a mark and is none has no colour where chips have one (a stripe of shadow, blurred
or glaring print), or that of skin (a fingertip). Where no mark has a colour, a card is marked with
a pen, coins, or white or grey chips: none of these is doubted, unless its number lies bare on a
card of which much cannot be told.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from tangy_hw.perception.cards.classifier import HIDDEN, MARKED, UNMARKED
from tangy_hw.perception.cards.features import Measured

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Real = NDArray[Any]

# Chosen on 520 frames of stripes, glare, motion and fingers, on which 2,300 cells with chips and
# 36 without were told marked; `tests.bench.card_harsh` makes such frames, and others to count on.
COLOURED = 0.15
"""How far from the paper's colour, in its light, a chip of a colour is; the palest had .151."""
PALE = 0.3
"""Of the usual colour of the card's coloured marks: what has less is taken to have none. Chips had
.63 and more, bare cells .28 and less."""
FLESH = 0.6
"""Of that: what has less, and the hue of skin, may be a finger."""
SKIN = -70.0, -8.0
"""Between these directions of colour (degrees, blue over red, each less green) skin lies."""
BARE = 0.55
"""The correlation with its number from which the number of a colourless mark lies bare: of such
chips and coins, 95 in 100 had less."""
MUDDLED = 6
"""Cells in sight that cannot be told, from which much of a card cannot: where bare cells were told
marked there were 10 and more, on cards with coins or white chips mostly none."""
BESIDE = 0.3
"""How probably hidden a cell is beside which a finger may end."""


def unlike_others(measured: Measured, parts: Real, told: Real, across: int) -> Real:
    """Return which marks are so unlike the others that they may be none.

    Args:
        measured: what was measured of a card's cells.
        parts: how probable each class is, (cells, classes).
        told: which cells are told, (cells,) bool.
        across: columns of the grid.

    Returns:
        Which of the cells that are told marked are doubted, (cells,) bool.
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


def _fingers(measured: Measured, parts: Real, coloured: Real, across: int) -> Real:
    """Return which cells may show the end of a finger."""
    import numpy as np

    colour = np.maximum(measured.compared("dyed"), measured.compared("dyed middle"))
    way = np.degrees(np.arctan2(measured.compared("blue"), measured.compared("red")))
    flesh = (way >= SKIN[0]) & (way <= SKIN[1])
    usual = float(np.median(colour[coloured])) if coloured.any() else 0.0
    faint = flesh & (colour < FLESH * usual)
    beside = _beside((parts[:, HIDDEN] >= BESIDE).reshape(-1, across))
    if (coloured & ~(flesh & beside)).any():  # there are chips elsewhere, to compare it with
        return np.asarray(faint)
    return np.asarray(faint | (flesh & beside))


def _beside(hidden: Real) -> Real:
    """Return which cells have a hidden one beside them or at a corner, (cells,) bool."""
    import numpy as np

    rows, columns = hidden.shape
    wide = np.pad(hidden, 1)
    near = [wide[y : y + rows, x : x + columns] for y in range(3) for x in range(3)]
    return np.asarray(np.any(near, 0).ravel())
