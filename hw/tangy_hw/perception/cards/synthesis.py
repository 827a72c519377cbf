"""Compares each cell with its card's print under the local light.

The contrast of a number is compared with that of the lines around it. Shadow, glare and blur change
both alike; a chip changes only the number, however clear or pale it is.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from tangy_hw.perception.cards.rectification import RIM, SIDE, RectifiedGrid

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Real = NDArray[Any]

INNER = 24  # pixels of a cell's middle that are compared
SHIFT = 2  # pixels that a number may be off its place
ALONG, EVERY = 22, 2  # pixels of a line used on each side of a cell; their spacing
ACROSS = 5  # pixels on both sides of a line
USUAL = 75  # percentile of a card's cells that counts as unmarked
LEAST = 0.01  # minimum contrast, relative to white

NAMES = (
    "contrast", "contrast middle", "contrast least", "contrast most", "contrast colours least",
    "contrast colours most", "contrast of usual", "middle of usual", "least of usual",
    "ink off lines", "paper off lines", "rest", "rest of usual", "lines", "lines sure",
    "lines apart", "white out", "alike",
)  # fmt: skip
"""Names of the columns, in order."""


def compared(flat: RectifiedGrid, expected: Real) -> Real:
    """Compare cells with their print; return a row of `NAMES` for each.

    `expected` (rows, columns) is the print, blurred as the image is, 0 to 1.
    """
    import numpy as np

    layers = np.empty((*expected.shape, 4), np.float32)
    layers[..., 1:] = flat.picture
    layers[..., 1:] /= 255
    layers[..., 0] = layers[..., 1:].sum(2) / 3
    rows, columns = ((side - 2 * RIM) // SIDE for side in expected.shape)
    fit = _fitted(layers, expected, rows, columns)
    lines = _lines(layers, expected, rows, columns)  # (cells, sides, (contrast, paper), layers)
    ordered = np.sort(lines[:, :, 0], 1)
    local = np.maximum((ordered[:, 1] + ordered[:, 2]) / 2, LEAST)  # one of them may be covered
    ratio = fit.contrast / local[:, None]
    everywhere, middle, quarters = ratio[:, 0, 0], ratio[:, 1, 0], ratio[:, 2:, 0]
    least, most = quarters.min(1), quarters.max(1)
    colours = ratio[:, 0, 1:]

    def usual(value: Real) -> float:
        return max(float(np.percentile(value, USUAL)), 0.2)

    papers = np.median(lines[:, :, 1, 0], 1)
    apart = fit.paper - papers
    ink = (fit.paper - fit.contrast[:, 0, 0]) - (papers - local[:, 0])
    strong = max(float(np.percentile(local[:, 0], USUAL)), LEAST)
    rest = fit.rest / local[:, 0]
    noise = max(float(np.percentile(fit.rest, 30)), 0.004)
    least_colour = flat.picture.min(2)
    inside = (least_colour > 250)[RIM:-RIM, RIM:-RIM].reshape(rows, SIDE, columns, SIDE)
    white = inside.mean((1, 3)).ravel()
    table: Real = np.stack(
        [
            everywhere, middle, least, most, colours.min(1), colours.max(1),
            everywhere / usual(everywhere), middle / usual(middle), least / usual(least),
            ink / strong, apart / strong, rest, fit.rest / noise,
            np.log(local[:, 0] / strong), np.log(local[:, 0] / noise),
            (ordered[:, 3, 0] - ordered[:, 0, 0]) / local[:, 0], white, fit.alike,
        ],
        1,
    )  # fmt: skip
    return np.clip(table, -6, 6).astype(np.float32)


@dataclass(frozen=True)
class _Fit:
    """Fit of the cells: contrast (cells, parts, layers), paper, residual, correlation."""

    contrast: Real
    paper: Real
    rest: Real
    alike: Real


@lru_cache(maxsize=2)
def _parts() -> Real:
    """Return masks of the parts of a cell: all, a disc in the middle, and four quarters."""
    import numpy as np

    v, u = (np.mgrid[:INNER, :INNER] - (INNER - 1) / 2).astype(np.float32)
    disc = np.hypot(u, v) < INNER * 0.36
    wide = [(v < 0) & (u < 0), (v < 0) & (u >= 0), (v >= 0) & (u < 0), (v >= 0) & (u >= 0)]
    return np.stack([np.ones_like(disc), disc, *wide]).reshape(6, -1).astype(np.float32)


def _fitted(layers: Real, expected: Real, rows: int, columns: int) -> _Fit:
    """Fit evenly lit paper and the contrast of the number to each cell."""
    import cv2
    import numpy as np

    cell = np.arange(rows * columns)
    edge, span = RIM + (SIDE - INNER) // 2, np.arange(INNER)
    y = (edge + cell // columns * SIDE)[:, None] + span
    x = (edge + cell % columns * SIDE)[:, None] + span
    there = expected[y[:, :, None], x[:, None]].reshape(len(cell), -1)
    light, wide = np.ascontiguousarray(layers[..., 0]), INNER + 2 * SHIFT
    moved, alike = np.zeros((len(cell), 2), int), np.zeros(len(cell), np.float32)
    for place, (top, left) in enumerate(zip(y[:, 0], x[:, 0], strict=True)):
        around = light[top - SHIFT : top - SHIFT + wide, left - SHIFT : left - SHIFT + wide]
        own = expected[top : top + INNER, left : left + INNER]
        match = cv2.matchTemplate(around, own, cv2.TM_CCOEFF_NORMED)
        moved[place] = divmod(int(match.argmax()), 2 * SHIFT + 1)
        alike[place] = match.max()
    ay, ax = y + moved[:, :1] - SHIFT, x + moved[:, 1:] - SHIFT
    seen = layers[ay[:, :, None], ax[:, None]].reshape(len(cell), INNER * INNER, -1)
    v, u = (np.mgrid[:INNER, :INNER] / INNER - 0.5).astype(np.float32).reshape(2, -1)
    ones = np.ones_like(there)
    basis = np.stack([there, ones * v, ones * u, ones], 1)  # (cells, 4, pixels)
    slopes = []
    for part in _parts():
        inside = np.flatnonzero(part)
        some = basis[:, :, inside]
        square = some @ some.swapaxes(1, 2) + 1e-3 * np.eye(4, dtype=np.float32)
        slopes.append(np.linalg.solve(square, some @ seen[:, inside]))
    whole = slopes[0]
    left = seen[..., 0] - (whole[:, None, :, 0] @ basis)[:, 0]
    return _Fit(
        np.stack([part[:, 0] for part in slopes], 1),
        whole[:, 0, 0] + whole[:, 3, 0],
        left.std(1),
        alike,
    )


def _lines(layers: Real, expected: Real, rows: int, columns: int) -> Real:
    """Measure the lines around each cell: (cells, four sides, contrast and paper, layers)."""
    import numpy as np

    whole = np.dstack([layers, expected])
    profiles = []
    for turned, (down, across) in (
        (whole, (rows, columns)),
        (whole.swapaxes(0, 1), (columns, rows)),
    ):
        reach = ACROSS + SHIFT
        line = RIM + np.arange(down + 1) * SIDE
        around = np.arange(-reach, reach + 1)
        edge = RIM + np.arange(across) * SIDE + (SIDE - ALONG) // 2
        part = turned[
            (line[:, None] + around)[:, :, None, None], edge[:, None] + np.arange(0, ALONG, EVERY)
        ]
        profiles.append(_profile(np.median(part, 3)))  # (lines, cells, (contrast, paper), layers)
    level, upright = profiles
    upright = upright.swapaxes(0, 1)
    sides = np.stack([level[:-1], level[1:], upright[:, :-1], upright[:, 1:]], 2)
    told: Real = sides.reshape(rows * columns, 4, 2, -1)
    return told


def _profile(seen: Real) -> Real:
    """Fit the expected profile of lines to samples across them: (lines, places, cells, layers)."""
    import numpy as np

    seen = seen.swapaxes(1, 2)  # (lines, cells, places, layers)
    there = seen[:, :, SHIFT:-SHIFT, -1]
    there = there - there.mean(2, keepdims=True)
    size = np.maximum((there**2).sum(2), 1e-2)
    span = there.shape[2]
    found = (
        np.stack(
            [
                np.einsum("lcp,lcpk->lck", there, seen[:, :, shift : shift + span, :-1])
                for shift in range(2 * SHIFT + 1)
            ],
            2,
        )
        / size[..., None, None]
    )
    best = found[..., 0].argmax(2)
    contrast = np.take_along_axis(found, best[..., None, None], 2)[:, :, 0]
    paper = np.percentile(seen[..., :-1], 75, axis=2)
    return np.stack([contrast, paper], 2)
