"""How far what lies on a cell reaches: a chip ends all around, a finger goes on the way it came."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Real = NDArray[Any]

NAMES = ("same way near", "same way far", "same ways", "same longest", "same way mean")
ANGLES = 24
FAR = (0.5, 0.62, 0.75, 0.87, 1.0, 1.12, 1.25)  # of a cell's side, from a chip's middle
NEAR = 4  # so many of them are near
SAME = 0.5  # of its contrast with paper: what is less unlike may be the same thing
PALE = 0.15  # the least contrast with paper


def ways_out(covered: Real, y: Real, x: Real, side: int) -> tuple[Real, Real]:
    """Follow straight ways out of a cell; return how well the most and the least hidden are.

    From a chip every way leads over paper; a finger is hidden all along the way that it came.
    """
    import numpy as np

    ways = covered[_places(covered, y, x, 16, np.array([0.5, 0.62, 0.74, 0.86]) * side)].min(2)
    return ways.max(1), ways.min(1)


def same_ways(tones: Real, y: Real, x: Real, tone: Real, side: int) -> list[Real]:
    """Follow ways out over what has the same tone; return columns of `NAMES`.

    `tones` is a map of light (paper has 1) and two differences of colours (paper has 0); `tone`
    is that of what is most like a chip in each cell, whose middle is at (y, x).
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
    """Return rows and columns of a map on straight ways out: cells, ways, places."""
    import numpy as np

    angles = np.arange(ways) * (2 * np.pi / ways)
    down = np.rint(np.sin(angles)[:, None] * far).astype(int)
    right = np.rint(np.cos(angles)[:, None] * far).astype(int)
    return (
        np.clip(y[:, None, None] + down, 0, layer.shape[0] - 1),
        np.clip(x[:, None, None] + right, 0, layer.shape[1] - 1),
    )
