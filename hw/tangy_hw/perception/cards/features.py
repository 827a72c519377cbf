"""Features of each cell of a rectified grid."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from tangy_hw.perception.cards import extent, synthesis
from tangy_hw.perception.cards.rectification import RIM, SIDE, RectifiedGrid
from tangy_profiles.card_face import CardLayout
from tangy_profiles.card_picture import draw_number

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Picture = NDArray[Any]
    Real = NDArray[Any]

HALF = SIDE // 2  # pixels of a cell in the half-size maps
AWAY = 8  # pixels from a cell's centre within which the centre of a chip is searched
BEYOND = 12  # pixels for chips of the neighbouring cells
SPOTS, APART = 11, 3  # spots per side of a cell with its surroundings; pixels between spots
OUTSIDE = 4, 10  # pixels outside the grid that show objects reaching in
STRANGE, DARK = 0.22, 0.25  # limits of paper: difference from grey, and brightness
INNER = 26  # pixels of a cell's middle with its number
LARGEST = 1.4  # scale above which details do not increase
INKED = 80  # percentile of the number contrasts of a card that counts as ink on paper
SHIFT = 2  # pixels that a number may be off its place

NAMES = (
    "print", "print here", "own number", "crossings least", "crossings mean",
    "colour disc", "colour ring", "colour uneven", "change disc", "change ring",
    "light disc", "light ring", "light uneven", "red", "blue", "offset",
    "colour middle", "change middle", "change cell", "colour cell",
    "corner colour least", "corner colour most", "corner light least", "corner change least",
    "corner change most", "white light", "white red", "white blue", "full light", "full colour",
    "bright", "kind", "best", "scale", "sharpness", "matched", "number contrast", "side change",
    "arm", "way out", "to a line", "beyond", "down", "across",
    "dyed", "dyed middle", "dyed around", "darker", "darker middle", "lighter middle", "disc",
    "disc to a line", "disc beyond", "disc over low", "disc under high", "best over low",
    "best under high", "dyed over low", "dyed under high", "print over low", "print under high",
    "black", *extent.NAMES, *synthesis.NAMES,
)  # fmt: skip
"""Names of the first features, in order."""
SEEN = ("colour", "lighter", "unlike")
"""Layers of the remaining features, spot by spot in a cell and around it.

These are: difference from grey, brightness relative to the card's print, and colour difference to
the most chip-like place in the cell.
"""


@dataclass(frozen=True)
class CellFeatures:
    """Features of a card's cells: a row for each, with `NAMES` and then the spots of `SEEN`.

    `read` has the correlation with the card's own number, and the best with another number of the
    column, for each cell. `beside` is the share of the paper outside the grid, beside a cell at its
    edge, that an object covers: 0 to 1.
    """

    rows: Real
    read: Real
    beside: Real

    def compared(self, name: str) -> Real:
        """Return one feature of all cells (cells,)."""
        column: Real = self.rows[:, NAMES.index(name)]
        return column


def features_of(flat: RectifiedGrid, face: CardLayout, numbers: tuple[int, ...]) -> CellFeatures:
    """Measure the cells of a card."""
    import cv2
    import numpy as np

    rows, columns = face.deck.rows, len(face.deck.columns)
    smooth = cv2.GaussianBlur(flat.picture, (3, 3), 0)
    colour = smooth.astype(np.float32) + 1
    kernel = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (25, 25))
    white = cv2.GaussianBlur(cv2.dilate(smooth, kernel).astype(np.float32) + 1, (0, 0), 8)
    shown = colour / white
    light, tint = _light_and_tint(shown)
    blurred = cv2.GaussianBlur(flat.expected, (0, 0), min(2.5, 0.55 / flat.scale))
    expected = blurred.astype(np.float32) / 255

    read = _numbers_read(light, face, numbers, flat.scale)
    inked = light[(expected < 0.25)]
    ink = float(np.clip(np.percentile(inked, 30), 0.02, 0.7)) if inked.size else 0.3
    paper = np.median(white[RIM:-RIM:4, RIM:-RIM:4].reshape(-1, 3), 0)
    change = np.abs(light - (ink + (1 - ink) * expected))
    full_light, full_tint = _light_and_tint(colour / paper)
    least = cv2.min(cv2.min(*cv2.split(flat.picture)[:2]), flat.picture[..., 2])
    layers = [
        tint, change, light, shown[..., 2] - shown[..., 1], shown[..., 0] - shown[..., 1],
        full_light, full_tint, least > 250, tint**2, light**2,
    ]  # fmt: skip
    size = flat.picture.shape[1] // 2, flat.picture.shape[0] // 2
    maps = np.stack(
        [
            cv2.resize(layer.astype(np.float32), size, interpolation=cv2.INTER_AREA)
            for layer in layers
        ],
        -1,
    )
    in_disc, first = _disc(maps), np.ascontiguousarray(maps[..., :3])
    in_ring = _ring(first)
    chipped = in_disc[..., 0] - in_ring[..., 0] + 0.7 * (in_disc[..., 1] - in_ring[..., 1])

    start = RIM // 2
    cell = np.arange(rows * columns)
    y = start + cell // columns * HALF + HALF // 2
    x = start + cell % columns * HALF + HALF // 2
    # Search beyond the cell too: a chip centred there marks a neighbour.
    span = np.arange(-BEYOND, BEYOND + 1)
    wide = np.pad(chipped, BEYOND, mode="edge")
    wide = wide[(y[:, None] + BEYOND + span)[:, :, None], (x[:, None] + BEYOND + span)[:, None]]
    inner = slice(BEYOND - AWAY, BEYOND + AWAY + 1)
    side = 2 * AWAY + 1
    best = wide[:, inner, inner].reshape(-1, side * side).argmax(1)
    dy, dx = best // side - AWAY, best % side - AWAY
    at, ringed, middle = in_disc[y + dy, x + dx], in_ring[y + dy, x + dx], in_disc[y, x]
    deviation = np.sqrt(np.maximum(at[:, 8:10] - at[:, (0, 2)] ** 2, 0))

    dots = _dot(first)
    corners = _corners(dots, rows, columns)
    sides = _sides(dots[..., 1], rows, columns)
    whites = cv2.resize(white, size, interpolation=cv2.INTER_AREA)[y, x] / paper
    crossings = _around(flat.crossings.reshape(rows + 1, columns + 1))
    inside = _cells(maps[..., 1], rows, columns), _cells(maps[..., 0], rows, columns)
    strength = chipped[y + dy, x + dx]
    strong = strength > 0.3
    kind = np.median(at[strong][:, [2, 3, 4]], 0) if strong.any() else np.full(3, 0.5)
    row = [
        read[:, 0], read[:, 2], read[:, 0] - read[:, 1], crossings.min(1), crossings.mean(1),
        at[:, 0], ringed[:, 0], deviation[:, 0], at[:, 1], ringed[:, 1],
        at[:, 2], ringed[:, 2], deviation[:, 1], at[:, 3], at[:, 4], np.hypot(dx, dy) / HALF,
        middle[:, 0], middle[:, 1], inside[0].mean((1, 2)), inside[1].mean((1, 2)),
        corners[:, :, 0].min(1), corners[:, :, 0].max(1), corners[:, :, 2].min(1),
        corners[:, :, 1].min(1), corners[:, :, 1].max(1), whites.mean(1),
        whites[:, 2] - whites[:, 1], whites[:, 0] - whites[:, 1], at[:, 5], at[:, 6], at[:, 7],
        np.abs(at[:, [2, 3, 4]] - kind).sum(1), strength,
        np.full(len(cell), np.log(min(flat.scale, LARGEST))),
        np.full(len(cell), np.median(flat.crossings)),
        np.full(len(cell), flat.matched / len(flat.crossings)), read[:, 3], sides.max(1),
        *extent.ways_out(dots[..., 0] + dots[..., 1], y + dy, x + dx, HALF),
        np.maximum(np.abs(dx), np.abs(dy)) / HALF, wide.max((1, 2)) - strength,
        np.abs(dy) / HALF, np.abs(dx) / HALF,
    ]  # fmt: skip
    lighter = light - (ink + (1 - ink) * expected)
    dye = shown[..., (2, 0)] - shown[..., 1:2]
    dye -= np.median(dye[RIM:-RIM:4, RIM:-RIM:4].reshape(-1, 2), 0)
    row += _plainly(np.dstack([dye, lighter]), (y, x), (strength, read[:, 0]))
    edge = (SIDE - INNER) // 2
    printed = _whole_cells(expected, rows, columns)[:, edge : edge + INNER, edge : edge + INNER]
    black = read[:, 2] * read[:, 3] / np.maximum(printed.std((1, 2)), 1e-3)
    black /= max(float(np.percentile(black, INKED)), 0.02)
    row.append(black)
    row += extent.same_ways(_dot(maps[..., 2:5].copy()), y + dy, x + dx, at[:, 2:5], HALF)
    named = np.hstack([np.stack(row, 1), synthesis.compared(flat, expected)]).astype(np.float32)
    spots = _spots(np.dstack([dye, lighter, shown]), (y, x), (y + dy, x + dx))
    bare = expected > 0.9
    strange = (full_tint > STRANGE * np.maximum(full_light, 0.05)) | (full_light < DARK)
    beside = _beside(np.where(bare, strange, False), bare, rows, columns)
    return CellFeatures(np.hstack([named, spots]), read[:, :2], beside)


def _beside(strange: Real, bare: Real, rows: int, columns: int) -> Real:
    """Return the share of unusual colour in the bare paper beside the cells at the grid's edges."""
    import numpy as np

    near, far = OUTSIDE
    down, across = RIM + rows * SIDE, RIM + columns * SIDE
    found = np.zeros((rows, columns), np.float32)
    for part, where in (
        ((np.s_[RIM - far : RIM - near], np.s_[RIM:across]), np.s_[0, :]),
        ((np.s_[down + near : down + far], np.s_[RIM:across]), np.s_[-1, :]),
        ((np.s_[RIM:down], np.s_[RIM - far : RIM - near]), np.s_[:, 0]),
        ((np.s_[RIM:down], np.s_[across + near : across + far]), np.s_[:, -1]),
    ):
        along = 1 if where[0] == slice(None) else 0  # axis across the strip
        odd, paper = (layer[part].sum(along).reshape(-1, SIDE).sum(1) for layer in (strange, bare))
        found[where] = np.maximum(found[where], odd / np.maximum(paper, SIDE))
    return np.asarray(found.ravel())


def _plainly(layers: Real, middle: tuple[Real, Real], known: tuple[Real, Real]) -> list[Real]:
    """Measure faint discs with signed means, in which noise cancels out.

    `layers` (rows, columns, 3) are two colour differences, and the brightness relative to the
    print. The results are also compared with the card's other cells, because chips are mostly of
    one kind.
    """
    import cv2
    import numpy as np

    small = (layers.shape[1] // 2, layers.shape[0] // 2)
    maps = cv2.resize(layers, small, interpolation=cv2.INTER_AREA)
    inner, outer = _disc(maps), _ring(maps)
    apart = inner - outer
    dyed = np.hypot(apart[..., 0], apart[..., 1])
    dark = -apart[..., 2]
    strong = dyed + np.abs(dark)
    y, x = middle
    span = np.arange(-BEYOND, BEYOND + 1)
    wide = np.pad(strong, BEYOND, mode="edge")
    wide = wide[(y[:, None] + BEYOND + span)[:, :, None], (x[:, None] + BEYOND + span)[:, None]]
    near = slice(BEYOND - AWAY, BEYOND + AWAY + 1)
    side = 2 * AWAY + 1
    best = wide[:, near, near].reshape(-1, side * side).argmax(1)
    dy, dx = best // side - AWAY, best % side - AWAY
    at = y + dy, x + dx
    disc, dye = strong[at], np.hypot(inner[at][:, 0], inner[at][:, 1])
    strength, printed = known
    rows = [
        dye, np.hypot(inner[y, x, 0], inner[y, x, 1]), dyed[at], dark[at], dark[y, x],
        inner[y, x, 2], disc, np.maximum(np.abs(dx), np.abs(dy)) / HALF,
        wide.max((1, 2)) - disc,
    ]  # fmt: skip
    for value in (disc, strength, dye, printed):
        low, high = np.percentile(value, (20, 90))
        rows += [value - low, value - high]
    return rows


def _spots(layers: Real, middle: tuple[Real, Real], best: tuple[Real, Real]) -> Real:
    """Sample spots of each cell and its surroundings; return a row of `SEEN` for each."""
    import cv2
    import numpy as np

    small = (layers.shape[1] // 2, layers.shape[0] // 2)
    halved = np.dstack(
        [cv2.resize(part, small, interpolation=cv2.INTER_AREA) for part in cv2.split(layers)]
    )
    dots = np.dstack([cv2.blur(part, (APART, APART)) for part in cv2.split(halved)])
    span = (np.arange(SPOTS) - SPOTS // 2) * APART
    y, x = (place[:, None, None] for place in middle)
    here = dots[y + span[:, None], x + span]
    there = dots[best][:, None, None, 3:]
    unlike = np.abs(here[..., 3:] - there).sum(-1)
    rows: Real = np.stack([np.hypot(here[..., 0], here[..., 1]), here[..., 2], unlike], 1)
    return rows.reshape(len(rows), -1)


def _light_and_tint(picture: Real) -> tuple[Real, Real]:
    """Return the brightness of each pixel, and its difference from grey."""
    import cv2

    blue, green, red = cv2.split(picture)
    light = (blue + green + red) / 3
    return light, cv2.max(cv2.max(blue, green), red) - cv2.min(cv2.min(blue, green), red)


def _numbers_read(light: Real, face: CardLayout, numbers: tuple[int, ...], scale: float) -> Real:
    """Correlate each cell with the numbers of its column.

    Returns:
        For each cell (n, 4): the best correlation with its own number, with any other, with its own
        at its exact place, and the contrast of the cell's middle.
    """
    import numpy as np

    rows, columns = face.deck.rows, len(face.deck.columns)
    cells = _whole_cells(light, rows, columns)
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


def _disc(maps: Real) -> Real:
    """Average over the area of a chip."""
    import cv2

    return cv2.GaussianBlur(maps, (13, 13), 2.4)


def _ring(maps: Real) -> Real:
    """Average over a ring around a chip."""
    import cv2

    outer, inner = 17, 13
    whole = cv2.boxFilter(maps, -1, (outer, outer), normalize=False)
    core = cv2.boxFilter(maps, -1, (inner, inner), normalize=False)
    return (whole - core) / (outer**2 - inner**2)


def _dot(maps: Real) -> Real:
    import cv2

    return cv2.blur(maps, (3, 3))


def _cells(layer: Real, rows: int, columns: int) -> Real:
    """Cut a map into its cells."""
    start = RIM // 2
    grid = layer[start : start + rows * HALF, start : start + columns * HALF]
    cut: Real = grid.reshape(rows, HALF, columns, HALF).swapaxes(1, 2).reshape(-1, HALF, HALF)
    return cut


def _whole_cells(layer: Real, rows: int, columns: int) -> Real:
    """Cut an image of the grid into its cells."""
    grid = layer[RIM : RIM + rows * SIDE, RIM : RIM + columns * SIDE]
    cut: Real = grid.reshape(rows, SIDE, columns, SIDE).swapaxes(1, 2).reshape(-1, SIDE, SIDE)
    return cut


def _around(at_crossings: Real) -> Real:
    """Return the values at the four line crossings of each cell."""
    import numpy as np

    a = at_crossings
    four: Real = np.stack([a[:-1, :-1], a[:-1, 1:], a[1:, :-1], a[1:, 1:]], -1)
    return four.reshape(-1, 4)


def _corners(dots: Real, rows: int, columns: int) -> Real:
    """Sample the four corners of each cell, inside its lines."""
    import numpy as np

    cell = np.arange(rows * columns)
    y = RIM // 2 + cell // columns * HALF
    x = RIM // 2 + cell % columns * HALF
    inset = 2
    far = HALF - 1 - inset
    places = [(inset, inset), (inset, far), (far, inset), (far, far)]
    return np.stack([dots[y + a, x + b] for a, b in places], 1)


def _sides(dots: Real, rows: int, columns: int) -> Real:
    """Sample the middle of the four sides of each cell, inside its lines."""
    import numpy as np

    cell = np.arange(rows * columns)
    y = RIM // 2 + cell // columns * HALF
    x = RIM // 2 + cell % columns * HALF
    half, inset = HALF // 2, 2
    far = HALF - 1 - inset
    return np.stack(
        [dots[y + a, x + b] for a, b in [(inset, half), (far, half), (half, inset), (half, far)]],
        1,
    )
