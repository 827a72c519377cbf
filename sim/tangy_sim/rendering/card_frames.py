"""Renders camera frames of a card on a table, with ground truth.

A pinhole camera looks at a plane: the table top with a printed card, chips and hands. Light,
shadow, glare, blur, noise and JPEG artefacts are added. The same seed gives the same frames.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from tangy_profiles.card_face import HEIGHT, LAST_CARD, USUAL_SEED, WIDTH, CardLayout
from tangy_profiles.card_picture import draw_face
from tangy_profiles.cards import Deck
from tangy_sim.rendering.card_backgrounds import background
from tangy_sim.rendering.card_chips import Chip, faint_chip, put_chip, some_chip
from tangy_sim.rendering.card_hands import draw_hand
from tangy_sim.rendering.card_light import exposed, lit_scene, moved, project
from tangy_sim.rendering.card_odd_chips import odd_chip

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Picture = NDArray[Any]
    Real = NDArray[Any]

AROUND = 120.0  # mm of table around the card for hands and loose chips
ON_LINE = 1.5  # mm from a line within which the cell of a chip is ambiguous
HANDS = ("finger", "thumb", "flat", "blob", "bar")
MASTER = 8.0  # pixels per mm of the full-size face from which all sizes are made


@dataclass(frozen=True)
class View:
    """Parameters of a frame; `some_view` samples those that are not given.

    `pixels` is the size of a cell seen from straight above; angles are in degrees; `blur` and
    `motion` in pixels, `noise` in grey levels, `quality` is JPEG's.
    """

    pixels: float = 30.0
    tilt: float = 0.0
    tilted_to: float = 0.0
    spin: float = 0.0
    wide: float = 1.2  # focal length in image widths
    light: float = 0.8
    slope: float = 0.0
    warm: float = 0.0
    shadow: float = 0.0
    soft: float = 12.0  # pixels of the shadow's edge
    glare: float = 0.0
    blur: float = 0.5
    motion: float = 0.0
    noise: float = 3.0
    quality: int = 90
    bend: float = 0.0  # mm
    hand: str = ""  # or one of `HANDS`, or "thing" for another object
    grey: bool = False
    size: tuple[int, int] = (1280, 720)


@dataclass(frozen=True)
class RenderedFrame:
    """A rendered frame of a card, with ground truth.

    `marked` is a mask of the cells with a chip; `covered` the share of each cell under a hand, 0 to
    1; `corners` are the corners of the grid in the image; `between` is a mask of the cells at a
    line under the centre of a chip.
    """

    picture: Picture
    card: int | None
    marked: int
    covered: tuple[float, ...]
    view: View
    corners: tuple[tuple[float, float], ...]
    between: int = 0

    def unknown(self, share: float = 0.25) -> int:
        """Return a mask of the cells that nobody can decide: hidden by this share, or at a line."""
        hidden = sum(1 << cell for cell, part in enumerate(self.covered) if part >= share)
        return hidden | self.between


def some_view(random: np.random.Generator, **given: Any) -> View:
    """Sample a realistic view; given parameters are kept."""
    uniform, chance = random.uniform, random.random
    drawn = View(
        pixels=float(18 * (44 / 18) ** chance()),
        tilt=float(uniform(0, 50)),
        tilted_to=float(uniform(-180, 180)),
        spin=float(uniform(-180, 180)) if chance() < 0.4 else float(random.normal(0, 12)),
        wide=float(uniform(0.8, 1.6)),
        light=float(uniform(0.4, 1.08)),
        slope=float(uniform(0, 0.45)),
        warm=float(uniform(-0.16, 0.22)),
        shadow=float(uniform(0.2, 0.65)) if chance() < 0.3 else 0.0,
        soft=float(uniform(0.3, 25)) if chance() < 0.5 else 0.5,
        glare=float(uniform(0.2, 0.9)) if chance() < 0.25 else 0.0,
        blur=float(uniform(0.3, 1.0)),
        motion=float(uniform(1, 2.5)) if chance() < 0.15 else 0.0,
        noise=float(uniform(1, 7)),
        quality=int(uniform(55, 96)),
        bend=float(uniform(0, 1.2)) if chance() < 0.4 else 0.0,
        hand=str(random.choice(HANDS)) if chance() < 0.3 else "",
        grey=bool(chance() < 0.02),
    )
    return replace(drawn, **given)


class CardCamera:
    """Renders frames of cards of one deck on a table."""

    def __init__(
        self,
        deck: Deck,
        *,
        deck_seed: int = USUAL_SEED,
        title: str = "",
        straddling: float = 0.06,
        faint: float = 0.0,
        odd: float = 0.0,
        oddity: Callable[[np.random.Generator], Chip] = odd_chip,
    ) -> None:
        """Set up the camera; `straddling` is the probability of a carelessly placed chip.

        `faint` is the probability that the chips of a card are hard to see, `odd` that they are
        drawn by `oddity`: coins, beans or scraps of paper.
        """
        self.face = CardLayout(deck)
        self.straddling = straddling
        self.faint = faint
        self.odd = odd
        self.oddity = oddity
        self.deck_seed = deck_seed
        self.title = title

    def frames(self, seed: int, count: int, **given: Any) -> Iterator[RenderedFrame]:
        """Yield frames of random cards in random views; see `some_view` for the parameters."""
        import numpy as np

        for number in range(count):
            random = np.random.default_rng([seed, number])
            yield self.some_frame(random, some_view(random, **given))

    def some_frame(self, random: np.random.Generator, view: View) -> RenderedFrame:
        """Render a random card with random chips."""
        deck = self.face.deck
        cells = deck.rows * len(deck.columns)
        share = random.uniform(0, 0.65) if random.random() < 0.9 else 0.0
        marked = sum(1 << cell for cell in range(cells) if random.random() < share) & ~deck.free
        card = int(random.integers(1, LAST_CARD + 1))
        return self.take(card, self.chips(random, marked), view, random)

    def chips(self, random: np.random.Generator, marked: int) -> dict[int, Chip]:
        """Put chips of one kind on the marked cells, without overlaps."""
        deck = self.face.deck
        faint = self.faint > 0 and random.random() < self.faint
        kind = faint_chip(random) if faint else some_chip(random)
        if self.odd > 0 and random.random() < self.odd:
            kind = self.oddity(random)
        chips: dict[int, Chip] = {}
        for cell in range(deck.rows * len(deck.columns)):
            if not marked >> cell & 1:
                continue
            own = kind if random.random() < 0.9 else some_chip(random)
            for attempt in range(8):
                careless = self.straddling if attempt < 6 else 0.0
                chip = own.thrown(random, self.face.middle(cell), self.face.cell, careless)
                if all(chip.clear_of(other) for other in chips.values()):
                    chips[cell] = chip
                    break
        return chips

    def take(
        self, card: int, chips: dict[int, Chip], view: View, random: np.random.Generator
    ) -> RenderedFrame:
        """Render a card with these chips in this view."""
        import numpy as np

        face, cells = self.face, self.face.deck.rows * len(self.face.deck.columns)
        scale = float(np.clip(2.0 * view.pixels / face.cell, 1.0, 6.0))
        table, seen = self._table(card, chips, view, scale, random)
        covered = np.zeros(cells)
        if view.hand:
            mask = draw_hand(table, seen, view.hand, scale, AROUND, face, random)
            covered = self._covered(mask, scale)
        plane = _homography(view, face, random)
        picture = _photograph(table, seen, plane, scale, view, random)
        grid = face.grid
        ends = (
            (grid.left, grid.top),
            (grid.right, grid.top),
            (grid.right, grid.bottom),
            (grid.left, grid.bottom),
        )
        corners = project(plane, np.array(ends))
        return RenderedFrame(
            picture,
            card,
            sum(1 << cell for cell in chips),
            tuple(float(part) for part in covered),
            view,
            tuple((float(x), float(y)) for x, y in corners),
            self._between(chips),
        )

    def _between(self, chips: dict[int, Chip]) -> int:
        """Return a mask of the cells that a chip on a line marks or nearly marks."""
        face, cells = self.face, 0
        for own, chip in chips.items():
            reached = 0
            for cell in range(face.deck.rows * len(face.deck.columns)):
                x, y = face.middle(cell)
                if max(abs(chip.x - x), abs(chip.y - y)) <= face.cell / 2 + ON_LINE:
                    reached |= 1 << cell
            if reached != 1 << own:
                cells |= reached
        return cells & ~face.deck.free

    def _table(
        self,
        card: int,
        chips: dict[int, Chip],
        view: View,
        scale: float,
        random: np.random.Generator,
    ) -> tuple[Real, Real]:
        """Draw the card and the chips from above; return the image and its opacity (0 to 1)."""
        import cv2
        import numpy as np

        size = round(WIDTH * scale), round(HEIGHT * scale)
        master = _master(self.face, card, self.deck_seed, self.title)
        paper = cv2.resize(master, size, interpolation=cv2.INTER_AREA).astype(np.float32) / 255
        ink, white = random.uniform(0.0, 0.18), random.uniform(0.8, 1.0)
        paper = ink + (white - ink) * paper
        if view.bend:
            paper = _bent(paper, view.bend * scale, random)
        edge = round(AROUND * scale)
        across, down = size[0] + 2 * edge, size[1] + 2 * edge
        table = np.zeros((down, across, 3), np.float32)
        seen = np.zeros((down, across), np.float32)
        tone = 1 + random.normal(0, 0.012, 3).astype(np.float32)
        table[edge : edge + size[1], edge : edge + size[0]] = paper[..., None] * tone
        seen[edge : edge + size[1], edge : edge + size[0]] = 1
        loose = [
            some_chip(random).at(random.uniform(-60, WIDTH + 60), y)
            for y in (*random.uniform(-60, -15, random.integers(0, 3)),)
        ]
        for chip in (*chips.values(), *loose):
            put_chip(table, seen, chip, scale, AROUND, view.tilt, view.tilted_to, random)
        return table, seen

    def _covered(self, mask: Real, scale: float) -> NDArray[Any]:
        """Return the share of each cell under a hand, 0 to 1."""
        import numpy as np

        face, parts = self.face, []
        half = face.cell * 0.42
        for cell in range(face.deck.rows * len(face.deck.columns)):
            x, y = face.middle(cell)
            left, right = (round((x + side + AROUND) * scale) for side in (-half, half))
            top, bottom = (round((y + side + AROUND) * scale) for side in (-half, half))
            parts.append(float(mask[top:bottom, left:right].mean()))
        return np.array(parts)


@lru_cache(maxsize=300)
def _master(face: CardLayout, card: int, seed: int, title: str) -> Picture:
    return draw_face(face, card, seed, title, MASTER / 2)


def _bent(paper: Real, most: float, random: np.random.Generator) -> Real:
    """Bend the paper: displace the image by long waves, by at most `most` pixels."""
    import cv2
    import numpy as np

    down, across = paper.shape
    y, x = np.mgrid[0:down:8, 0:across:8].astype(np.float32)
    a, b, c, d = random.uniform(0, 2 * np.pi, 4)
    u, v = 2 * np.pi * x / across, 2 * np.pi * y / down
    shift = np.stack([np.sin(v + a) * np.cos(u / 2 + b), np.sin(u + c) * np.cos(v / 2 + d)], -1)
    shift = cv2.resize((0.7 * most * shift).astype(np.float32), (across, down))
    x, y = np.meshgrid(np.arange(across, dtype=np.float32), np.arange(down, dtype=np.float32))
    moved = cv2.remap(
        paper,
        x + shift[..., 0],
        y + shift[..., 1],
        cv2.INTER_LINEAR,
        borderMode=cv2.BORDER_REPLICATE,
    )
    return moved.astype(np.float32)


def _homography(view: View, face: CardLayout, random: np.random.Generator) -> NDArray[Any]:
    """Return the homography from mm on the card to pixels."""
    import numpy as np

    width, height = view.size
    focal = view.wide * width
    away = focal * face.cell / view.pixels  # mm
    tilt, to, spin = np.radians([view.tilt, view.tilted_to, view.spin])

    def about(angle: float) -> NDArray[Any]:
        return np.array(
            [[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]]
        )

    lean = np.array([[1, 0, 0], [0, np.cos(tilt), -np.sin(tilt)], [0, np.sin(tilt), np.cos(tilt)]])
    turn = about(to) @ lean @ about(spin - to)
    middle = np.array([[1, 0, -WIDTH / 2], [0, 1, -HEIGHT / 2], [0, 0, 1]])
    pose = np.column_stack([turn[:, 0], turn[:, 1], [0, 0, away]])
    lens = np.array([[focal, 0, width / 2], [0, focal, height / 2], [0, 0, 1]])
    plane = lens @ pose @ middle
    ends = project(plane, np.array([(0, 0), (WIDTH, 0), (WIDTH, HEIGHT), (0, HEIGHT)], float))
    low, high = ends.min(0), ends.max(0)
    shift = np.eye(3)
    for axis, length in enumerate((width, height)):
        room = length - (high[axis] - low[axis])
        place = random.uniform(0.02, 0.98) * room if room > 0 else room / 2
        shift[axis, 2] = place - low[axis]
    moved: NDArray[Any] = shift @ plane
    return moved


def _photograph(
    table: Real,
    seen: Real,
    plane: NDArray[Any],
    scale: float,
    view: View,
    random: np.random.Generator,
) -> Picture:
    """Render the table through the camera: light, shadow, glare, blur, noise, JPEG."""
    import cv2
    import numpy as np

    width, height = view.size
    behind = background(width, height, random)
    down, across = seen.shape
    to_mm = np.array([[1 / scale, 0, -AROUND], [0, 1 / scale, -AROUND], [0, 0, 1]])
    ends = project(plane @ to_mm, np.array([(0, 0), (across, 0), (across, down), (0, down)], float))
    low = np.clip(np.floor(ends.min(0)).astype(int) - 1, 0, (width, height))
    high = np.clip(np.ceil(ends.max(0)).astype(int) + 2, 0, (width, height))
    part = int(high[0] - low[0]), int(high[1] - low[1])
    fine = np.array([[2, 0, -2 * low[0] + 0.5], [0, 2, -2 * low[1] + 0.5], [0, 0, 1]], float)
    layers = np.dstack([table, seen])
    warped = cv2.warpPerspective(layers, fine @ plane @ to_mm, (2 * part[0], 2 * part[1]))
    warped = cv2.resize(warped, part, interpolation=cv2.INTER_AREA)
    box = np.s_[low[1] : high[1], low[0] : high[0]]
    behind[box] = behind[box] * (1 - warped[..., 3:]) + warped[..., :3]
    lit = lit_scene(behind, plane, view, random)
    if view.motion >= 1:
        lit = moved(lit, view.motion, random)
    if view.blur > 0.05:
        lit = cv2.GaussianBlur(lit, (0, 0), view.blur)
    return exposed(lit, view.noise, view.quality, random, grey=view.grey)
