"""How far an object on a cell extends: a chip ends on all sides, a finger continues on one."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Real = NDArray[Any]

NAMES = ("same way near", "same way far", "same ways", "same longest", "same way mean")
ANGLES = 24
FAR = (0.5, 0.62, 0.75, 0.87, 1.0, 1.12, 1.25)  # of a cell's side, from the centre of the chip
NEAR = 4  # of these radii count as near
SAME = 0.5  # of the contrast with paper: smaller differences may be the same object
PALE = 0.15  # minimum contrast with paper


def ways_out(covered: Real, y: Real, x: Real, side: int) -> tuple[Real, Real]:
    """Follow rays out of each cell; return how covered the most and the least covered ray are.

    All rays from a chip reach paper; one ray along a finger stays covered. Maps are (rows,
    columns), results (cells,).
    """
    import numpy as np

    ways = covered[_places(covered, y, x, 16, np.array([0.5, 0.62, 0.74, 0.86]) * side)].min(2)
    return ways.max(1), ways.min(1)


def same_ways(tones: Real, y: Real, x: Real, tone: Real, side: int) -> list[Real]:
    """Follow rays out of each cell over the same colour; return columns of `NAMES`, each (cells,).

    `tones` (rows, columns, 3) has brightness (1 for paper) and two colour differences (0 for
    paper); `tone` is the colour of the most chip-like place in each cell, centred at (y, x).
    """
    import numpy as np

    places = _places(tones[..., 0], y, x, ANGLES, np.array(FAR) * side)
    contrast = np.maximum(np.abs(tone - np.array([1.0, 0.0, 0.0])).sum(1), PALE)
    off = np.abs(tones[places] - tone[:, None, None]).sum(3) / contrast[:, None, None]
    off = np.minimum(off, 2)
    near, far = off[:, :, :NEAR].max(2), off.max(2)
    going_on = np.minimum.accumulate(off < SAME, 2).sum(2)
    return [
        near.min(1), far.min(1), (near < SAME).mean(1), going_on.max(1) / len(FAR),
        off.mean(2).min(1),
    ]  # fmt: skip


def _places(layer: Real, y: Real, x: Real, ways: int, far: Real) -> tuple[Real, Real]:
    """Return rows and columns of points on rays from each cell: (cells, rays, points)."""
    import numpy as np

    angles = np.arange(ways) * (2 * np.pi / ways)
    down = np.rint(np.sin(angles)[:, None] * far).astype(int)
    right = np.rint(np.cos(angles)[:, None] * far).astype(int)
    return (
        np.clip(y[:, None, None] + down, 0, layer.shape[0] - 1),
        np.clip(x[:, None, None] + right, 0, layer.shape[1] - 1),
    )
