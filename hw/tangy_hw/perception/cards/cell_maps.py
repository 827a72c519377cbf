"""Cells of a rectified grid: means over a chip's area, and the parts of each cell."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from tangy_hw.perception.cards.rectification import RIM, SIDE

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Real = NDArray[Any]

HALF = SIDE // 2  # pixels of a cell in the half-size maps


def disc(maps: Real) -> Real:
    """Average over the area of a chip."""
    import cv2

    return cv2.GaussianBlur(maps, (13, 13), 2.4)


def ring(maps: Real) -> Real:
    """Average over a ring around a chip."""
    import cv2

    outer, inner = 17, 13
    whole = cv2.boxFilter(maps, -1, (outer, outer), normalize=False)
    core = cv2.boxFilter(maps, -1, (inner, inner), normalize=False)
    return (whole - core) / (outer**2 - inner**2)


def dot(maps: Real) -> Real:
    """Average over a pixel and its neighbours."""
    import cv2

    return cv2.blur(maps, (3, 3))


def cells(layer: Real, rows: int, columns: int) -> Real:
    """Cut a map into its cells."""
    start = RIM // 2
    grid = layer[start : start + rows * HALF, start : start + columns * HALF]
    cut: Real = grid.reshape(rows, HALF, columns, HALF).swapaxes(1, 2).reshape(-1, HALF, HALF)
    return cut


def whole_cells(layer: Real, rows: int, columns: int) -> Real:
    """Cut an image of the grid into its cells."""
    grid = layer[RIM : RIM + rows * SIDE, RIM : RIM + columns * SIDE]
    cut: Real = grid.reshape(rows, SIDE, columns, SIDE).swapaxes(1, 2).reshape(-1, SIDE, SIDE)
    return cut


def centres(rows: int, columns: int) -> tuple[Real, Real]:
    """Return the row and the column of each cell's centre in half-size maps: (cells,) each."""
    y, x = _origins(rows, columns)
    return y + HALF // 2, x + HALF // 2


def around(at_crossings: Real) -> Real:
    """Return the values at the four line crossings of each cell."""
    import numpy as np

    a = at_crossings
    four: Real = np.stack([a[:-1, :-1], a[:-1, 1:], a[1:, :-1], a[1:, 1:]], -1)
    return four.reshape(-1, 4)


def corners(dots: Real, rows: int, columns: int) -> Real:
    """Sample the four corners of each cell, inside its lines."""
    import numpy as np

    y, x = _origins(rows, columns)
    inset = 2
    far = HALF - 1 - inset
    places = [(inset, inset), (inset, far), (far, inset), (far, far)]
    return np.stack([dots[y + a, x + b] for a, b in places], 1)


def sides(dots: Real, rows: int, columns: int) -> Real:
    """Sample the middle of the four sides of each cell, inside its lines."""
    import numpy as np

    y, x = _origins(rows, columns)
    half, inset = HALF // 2, 2
    far = HALF - 1 - inset
    return np.stack(
        [dots[y + a, x + b] for a, b in [(inset, half), (far, half), (half, inset), (half, far)]],
        1,
    )


def _origins(rows: int, columns: int) -> tuple[Real, Real]:
    """Return the row and the column of each cell's first pixel in half-size maps."""
    import numpy as np

    cell = np.arange(rows * columns)
    return RIM // 2 + cell // columns * HALF, RIM // 2 + cell % columns * HALF
