"""Features of each cell of a rectified grid."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from tangy_hw.perception.cards import extent, synthesis
from tangy_hw.perception.cards.cell_maps import (
    HALF,
    around,
    cells,
    centres,
    corners,
    disc,
    dot,
    ring,
    sides,
    whole_cells,
)
from tangy_hw.perception.cards.layers import CardLayers, half_maps, layers_of
from tangy_hw.perception.cards.number_correlation import INNER, numbers_read
from tangy_hw.perception.cards.rectification import RIM, SIDE, RectifiedGrid
from tangy_profiles.card_face import CardLayout

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Real = NDArray[Any]

AWAY = 8  # pixels from a cell's centre within which the centre of a chip is searched
BEYOND = 12  # pixels for chips of the neighbouring cells
SPOTS, APART = 11, 3  # spots per side of a cell with its surroundings; pixels between spots
OUTSIDE = 4, 10  # pixels outside the grid that show objects reaching in
STRANGE, DARK = 0.22, 0.25  # limits of paper: difference from grey, and brightness
LARGEST = 1.4  # scale above which details do not increase
INKED = 80  # percentile of the number contrasts of a card that counts as ink on paper

OWN_NAMES = (
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
    "black", *extent.NAMES,
)  # fmt: skip
"""Names of the features that this module measures, in order."""
NAMES = (*OWN_NAMES, *synthesis.NAMES)
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
    import numpy as np

    rows, columns = face.deck.rows, len(face.deck.columns)
    layers = layers_of(flat)
    maps = half_maps(layers)
    dots = dot(np.ascontiguousarray(maps[..., :3]))
    read = numbers_read(layers.light, face, numbers, flat.scale)
    chips = _chips_of(maps, centres(rows, columns))
    signed = np.dstack([layers.dye, layers.lighter])
    features = {
        **_print_features(read, flat, rows, columns),
        **_chip_features(chips),
        **_cell_features(maps, dots, layers, rows, columns),
        **_extent_features(maps, dots, chips),
        **_signed_features(signed, chips.places, read),
        "black": _blackness(read, layers.expected, rows, columns),
    }
    own = np.stack([features[name] for name in OWN_NAMES], 1)
    named = np.hstack([own, synthesis.compared(flat, layers.expected)]).astype(np.float32)
    spots = _spots(np.dstack([signed, layers.shown]), chips.places)
    strange = layers.full_tint > STRANGE * np.maximum(layers.full_light, 0.05)
    strange |= layers.full_light < DARK
    bare = layers.expected > 0.9
    beside = _beside(np.where(bare, strange, False), bare, rows, columns)
    return CellFeatures(np.hstack([named, spots]), read[:, :2], beside)


@dataclass(frozen=True)
class _Places:
    """The most chip-like place in each cell of half-size maps; all (cells,).

    `y` and `x` are the cell's centre, `dy` and `dx` the offset from there, `strength` how chip-like
    the place is, and `beyond` how much more so a place just outside the cell is.
    """

    y: Real
    x: Real
    dy: Real
    dx: Real
    strength: Real
    beyond: Real

    @property
    def best(self) -> tuple[Real, Real]:
        """The row and the column of the place."""
        return self.y + self.dy, self.x + self.dx

    @property
    def off_line(self) -> Real:
        """The larger of the offsets down and across, in cells."""
        import numpy as np

        return np.asarray(np.maximum(np.abs(self.dx), np.abs(self.dy)) / HALF)


def _search(likeness: Real, middle: tuple[Real, Real]) -> _Places:
    """Find the most chip-like place in each cell.

    The search covers the neighbouring cells too: a chip that is centred there marks those.
    """
    import numpy as np

    y, x = middle
    span = np.arange(-BEYOND, BEYOND + 1)
    wide = np.pad(likeness, BEYOND, mode="edge")
    wide = wide[(y[:, None] + BEYOND + span)[:, :, None], (x[:, None] + BEYOND + span)[:, None]]
    inner = slice(BEYOND - AWAY, BEYOND + AWAY + 1)
    side = 2 * AWAY + 1
    best = wide[:, inner, inner].reshape(-1, side * side).argmax(1)
    dy, dx = best // side - AWAY, best % side - AWAY
    strength = likeness[y + dy, x + dx]
    return _Places(y, x, dy, dx, strength, wide.max((1, 2)) - strength)


@dataclass(frozen=True)
class _Chips:
    """The maps' means at the most chip-like `places`, each (cells, maps).

    `at` is over the area of a chip, `ring` over the ring around it, and `middle` over a chip at the
    cell's centre.
    """

    places: _Places
    at: Real
    ring: Real
    middle: Real


def _chips_of(maps: Real, middle: tuple[Real, Real]) -> _Chips:
    import numpy as np

    in_disc, in_ring = disc(maps), ring(np.ascontiguousarray(maps[..., :3]))
    chipped = in_disc[..., 0] - in_ring[..., 0] + 0.7 * (in_disc[..., 1] - in_ring[..., 1])
    places = _search(chipped, middle)
    return _Chips(places, in_disc[places.best], in_ring[places.best], in_disc[middle])


def _print_features(read: Real, flat: RectifiedGrid, rows: int, columns: int) -> dict[str, Real]:
    """Return the features of the printed numbers and lines."""
    import numpy as np

    crossings = around(flat.crossings.reshape(rows + 1, columns + 1))
    cells = len(read)
    return {
        "print": read[:, 0],
        "print here": read[:, 2],
        "own number": read[:, 0] - read[:, 1],
        "number contrast": read[:, 3],
        "crossings least": crossings.min(1),
        "crossings mean": crossings.mean(1),
        "scale": np.full(cells, np.log(min(flat.scale, LARGEST))),
        "sharpness": np.full(cells, np.median(flat.crossings)),
        "matched": np.full(cells, flat.matched / len(flat.crossings)),
    }


def _chip_features(chips: _Chips) -> dict[str, Real]:
    """Return the features of the most chip-like place in each cell, and of the cell's centre."""
    import numpy as np

    at, ringed, places = chips.at, chips.ring, chips.places
    deviation = np.sqrt(np.maximum(at[:, 8:10] - at[:, (0, 2)] ** 2, 0))
    strong = places.strength > 0.3
    kind = np.median(at[strong][:, [2, 3, 4]], 0) if strong.any() else np.full(3, 0.5)
    return {
        "colour disc": at[:, 0],
        "colour ring": ringed[:, 0],
        "colour uneven": deviation[:, 0],
        "change disc": at[:, 1],
        "change ring": ringed[:, 1],
        "light disc": at[:, 2],
        "light ring": ringed[:, 2],
        "light uneven": deviation[:, 1],
        "red": at[:, 3],
        "blue": at[:, 4],
        "offset": np.hypot(places.dx, places.dy) / HALF,
        "colour middle": chips.middle[:, 0],
        "change middle": chips.middle[:, 1],
        "full light": at[:, 5],
        "full colour": at[:, 6],
        "bright": at[:, 7],
        "kind": np.abs(at[:, [2, 3, 4]] - kind).sum(1),
        "best": places.strength,
        "to a line": places.off_line,
        "beyond": places.beyond,
        "down": np.abs(places.dy) / HALF,
        "across": np.abs(places.dx) / HALF,
    }


def _cell_features(
    maps: Real, dots: Real, layers: CardLayers, rows: int, columns: int
) -> dict[str, Real]:
    """Return the features of each whole cell, its corners and its sides."""
    import cv2

    corner = corners(dots, rows, columns)
    size = maps.shape[1], maps.shape[0]
    middle = centres(rows, columns)
    white = cv2.resize(layers.near, size, interpolation=cv2.INTER_AREA)[middle] / layers.paper
    return {
        "change cell": cells(maps[..., 1], rows, columns).mean((1, 2)),
        "colour cell": cells(maps[..., 0], rows, columns).mean((1, 2)),
        "corner colour least": corner[:, :, 0].min(1),
        "corner colour most": corner[:, :, 0].max(1),
        "corner light least": corner[:, :, 2].min(1),
        "corner change least": corner[:, :, 1].min(1),
        "corner change most": corner[:, :, 1].max(1),
        "white light": white.mean(1),
        "white red": white[:, 2] - white[:, 1],
        "white blue": white[:, 0] - white[:, 1],
        "side change": sides(dots[..., 1], rows, columns).max(1),
    }


def _extent_features(maps: Real, dots: Real, chips: _Chips) -> dict[str, Real]:
    """Return the features of how far the object on each cell extends."""
    y, x = chips.places.best
    arm, way_out = extent.ways_out(dots[..., 0] + dots[..., 1], y, x, HALF)
    same = extent.same_ways(dot(maps[..., 2:5].copy()), y, x, chips.at[:, 2:5], HALF)
    return {"arm": arm, "way out": way_out, **dict(zip(extent.NAMES, same, strict=True))}


def _signed_features(signed: Real, chips: _Places, read: Real) -> dict[str, Real]:
    """Return the features of faint discs by signed means, in which noise cancels out.

    They are also compared with the card's other cells, because chips are mostly of one kind.

    Args:
        signed: two colour differences, and the brightness relative to the print, each (rows,
            columns).
        chips: the most chip-like places by unsigned means.
        read: the correlations of the numbers.
    """
    import cv2
    import numpy as np

    small = (signed.shape[1] // 2, signed.shape[0] // 2)
    maps = cv2.resize(signed, small, interpolation=cv2.INTER_AREA)
    inner, outer = disc(maps), ring(maps)
    apart = inner - outer
    dyed = np.hypot(apart[..., 0], apart[..., 1])
    dark = -apart[..., 2]
    middle = chips.y, chips.x
    places = _search(dyed + np.abs(dark), middle)
    at = places.best
    dye = np.hypot(inner[at][:, 0], inner[at][:, 1])
    features = {
        "dyed": dye,
        "dyed middle": np.hypot(inner[middle][:, 0], inner[middle][:, 1]),
        "dyed around": dyed[at],
        "darker": dark[at],
        "darker middle": dark[middle],
        "lighter middle": inner[middle][:, 2],
        "disc": places.strength,
        "disc to a line": places.off_line,
        "disc beyond": places.beyond,
    }
    compared = {
        "disc": places.strength, "best": chips.strength, "dyed": dye, "print": read[:, 0]
    }  # fmt: skip
    for name, value in compared.items():
        low, high = np.percentile(value, (20, 90))
        features |= {f"{name} over low": value - low, f"{name} under high": value - high}
    return features


def _blackness(read: Real, expected: Real, rows: int, columns: int) -> Real:
    """Return how much ink of its own number each cell shows, 1 for a clean number: (cells,)."""
    import numpy as np

    edge = (SIDE - INNER) // 2
    middles = whole_cells(expected, rows, columns)[:, edge : edge + INNER, edge : edge + INNER]
    black = read[:, 2] * read[:, 3] / np.maximum(middles.std((1, 2)), 1e-3)
    black /= max(float(np.percentile(black, INKED)), 0.02)
    return np.asarray(black)


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


def _spots(layers: Real, chips: _Places) -> Real:
    """Sample spots of each cell and its surroundings; return a row of `SEEN` for each."""
    import cv2
    import numpy as np

    small = (layers.shape[1] // 2, layers.shape[0] // 2)
    halved = np.dstack(
        [cv2.resize(part, small, interpolation=cv2.INTER_AREA) for part in cv2.split(layers)]
    )
    dots = np.dstack([cv2.blur(part, (APART, APART)) for part in cv2.split(halved)])
    span = (np.arange(SPOTS) - SPOTS // 2) * APART
    y, x = (place[:, None, None] for place in (chips.y, chips.x))
    here = dots[y + span[:, None], x + span]
    there = dots[chips.best][:, None, None, 3:]
    unlike = np.abs(here[..., 3:] - there).sum(-1)
    rows: Real = np.stack([np.hypot(here[..., 0], here[..., 1]), here[..., 2], unlike], 1)
    return rows.reshape(len(rows), -1)
