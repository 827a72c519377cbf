"""Context features of a cell from its card's other cells: chips are alike, and hands are large."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Real = NDArray[Any]

LOOKS = (
    "colour disc", "light disc", "red", "blue", "dyed", "dyed around", "darker", "disc", "best",
    "change disc", "print", "middle of usual", "contrast of usual", "least of usual", "alike",
    "black", "rest of usual", "colour ring", "change ring",
)  # fmt: skip
"""Features in which a cell is compared with its card's clearly marked and unmarked cells."""
TOLD = 8  # bound on log odds

NAMES = (
    "own mark", "own hidden",
    "near hidden most", "near hidden", "beside hidden most", "any hidden", "hidden",
    "near mark most", "near mark", "beside mark most", "marks", "most marked", "sure marks",
    "unsure", "unsure near", "rim", "reached", "unlike marked", "unlike unmarked",
    *(f"{name} of marked" for name in LOOKS), *(f"{name} of unmarked" for name in LOOKS),
)  # fmt: skip


def context_of(parts: Real, looks: Real, beside: Real, columns: int) -> Real:
    """Return a row of `NAMES` for each cell (cards, cells).

    `parts` are the class probabilities (cards, cells, classes) by the cell alone, `looks` the
    standardised features `LOOKS` (cards, cells, features), `beside` is that of `Measured`, and
    `columns` the number of the grid's columns.
    """
    import numpy as np

    cells = parts.shape[1]
    rows = cells // columns
    parts = np.clip(parts, 1e-6, 1)
    mark, hidden = parts[..., 1] / (parts[..., 0] + parts[..., 1]), parts[..., 2]
    own = np.clip(np.log(parts[..., 1] / parts[..., 0]), -TOLD, TOLD)
    own_hidden = np.clip(np.log(hidden / (1 - hidden + 1e-6)), -TOLD, TOLD)
    doubt = np.minimum(mark, 1 - mark) * (1 - hidden)
    all_near = _near(np.stack([mark * (1 - hidden), hidden, doubt], -1), rows, columns)
    near, next_to = all_near, all_near[:, :, :4]
    others = cells - 1.0

    def but_own(values: Real) -> Real:
        told: Real = (values.sum(1, keepdims=True) - values) / others
        return told

    def most_but_own(values: Real) -> Real:
        ordered = np.sort(values, 1)
        first, second = ordered[:, -1:], ordered[:, -2:-1]
        told: Real = np.where(values >= first, second, first)
        return told

    seen_mark, seen_not = mark * (1 - hidden), (1 - mark) * (1 - hidden)
    sure = (seen_mark > 0.95).astype(np.float32)
    off = []
    for weight in (seen_mark**2, seen_not**2):
        total = weight.sum(1, keepdims=True) - weight
        mean = (weight[..., None] * looks).sum(1, keepdims=True) - weight[..., None] * looks
        mean /= np.maximum(total, 1e-3)[..., None]
        far = np.clip(looks - mean, -6, 6)
        off.append(far * np.minimum(total, 1)[..., None])
    down, across = np.divmod(np.arange(cells), columns)
    rim = (down == 0) | (down == rows - 1) | (across == 0) | (across == columns - 1)
    table = [
        own, own_hidden,
        near[..., 1].max(2), near[..., 1].mean(2), next_to[..., 1].max(2),
        most_but_own(hidden), but_own(hidden),
        near[..., 0].max(2), near[..., 0].mean(2), next_to[..., 0].max(2),
        but_own(seen_mark), most_but_own(seen_mark), but_own(sure),
        but_own(doubt), near[..., 2].max(2), np.broadcast_to(rim, mark.shape), beside,
        np.sqrt((off[0] ** 2).mean(2)), np.sqrt((off[1] ** 2).mean(2)),
    ]  # fmt: skip
    told: Real = np.concatenate([np.stack(table, -1), *off], -1).astype(np.float32)
    return told


def _near(values: Real, rows: int, columns: int) -> Real:
    """Return the values of each cell's eight neighbours (cards, cells, 8, values); 0 outside."""
    import numpy as np

    cards = len(values)
    grid = values.reshape(cards, rows, columns, -1)
    wide = np.pad(grid, ((0, 0), (1, 1), (1, 1), (0, 0)))
    places = [(0, 1), (2, 1), (1, 0), (1, 2), (0, 0), (0, 2), (2, 0), (2, 2)]
    around = [wide[:, a : a + rows, b : b + columns] for a, b in places]
    return np.stack(around, 3).reshape(cards, rows * columns, 8, -1)
