"""Frames of cards in harsh light, moved, and with fingertips: conditions outside the training set.

Run by hand: `python -m tests.bench.card_harsh --frames 60` prints a table, a line for each trouble;
`--set chosen` counts the frames on which thresholds may be chosen, `--set quoted` (the default)
those for quoted figures: these differ in skins, hues and stripes, not in seeds alone.
`--marks` chooses the marks on cards: coloured chips, colourless chips and coins, pen crosses,
or nothing. `--draw DIR` writes the frames that were misread.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, TypeAlias

import cv2
import numpy as np
from numpy.typing import NDArray

from tangy_hw.perception.cards.reader import CardReader
from tangy_profiles.activity import load_activity
from tangy_profiles.card_face import HEIGHT, WIDTH, CardLayout
from tangy_sim.rendering.card_backgrounds import tone_of
from tangy_sim.rendering.card_chips import Chip
from tangy_sim.rendering.card_frames import CardCamera, RenderedFrame, View
from tests.bench.cards import HEAD, Bench, Count, timed

Picture: TypeAlias = NDArray[Any]
Random: TypeAlias = np.random.Generator

SCALE, EDGE = 4.0, 60.0  # pixels per mm, and mm around the card, of layers on the card
COVERED = 0.42  # of a cell to each side of its middle: a fingertip here counts as on the cell


@dataclass(frozen=True)
class Palette:
    """The parts of a set of frames: hues of chips, skins (red, green, blue), stripes in mm."""

    seed: int
    hues: tuple[float, ...]
    skins: tuple[tuple[int, int, int], ...]
    stripes: tuple[float, float]


CHOSEN = Palette(
    411_000,
    (0.0, 30.0, 120.0, 220.0, 300.0),
    ((255, 219, 172), (224, 172, 105), (141, 85, 36), (70, 42, 26)),
    (6.0, 18.0),
)
QUOTED = Palette(
    862_000,
    (352.0, 14.0, 48.0, 155.0, 200.0, 250.0, 325.0),
    (
        (250, 229, 208),
        (241, 194, 125),
        (198, 134, 86),
        (106, 62, 38),
        (48, 28, 20),
        (233, 170, 150),
    ),
    (3.0, 26.0),
)


def coloured(palette: Palette, random: Random) -> Chip:
    """Draw a kind of chip of a plain strong colour; some kinds are clear."""
    hue = float(random.choice(palette.hues)) + random.normal(0, 3)
    tone = tone_of(hue, random.uniform(0.55, 1.0), random.uniform(0.45, 1.0))
    clear = float(random.uniform(0.15, 0.5)) if random.random() < 0.3 else 0.0
    thick = float(random.uniform(0.05, 2.5))
    rim = float(random.uniform(-0.3, 0.2))
    return Chip(float(random.uniform(8.0, 11.0)), tone, clear, thick, rim)


def colourless(_: Palette, random: Random) -> Chip:
    """Draw a kind of colourless chip: white, grey and black ones, and coins."""
    grey = float(random.choice([0.06, 0.2, 0.4, 0.6, 0.8]))
    if random.random() < 0.35:
        tone = tone_of(random.uniform(20, 48), random.uniform(0.0, 0.5), random.uniform(0.4, 0.85))
        return Chip(float(random.uniform(8, 11.5)), tone, 0.0, 1.6, 0.15, ring=-0.2, relief=0.15)
    return Chip(float(random.uniform(8, 11)), tone_of(0, 0, grey), 0.0, 1.5, -0.2, outline=0.3)


Marks: TypeAlias = Callable[[Palette, Random], Chip]
CHIPS: dict[str, Marks] = {"coloured": coloured, "colourless": colourless}
PEN, NOTHING = "pen", "nothing"
MARKS = (*CHIPS, PEN, NOTHING)


@dataclass(frozen=True)
class Trouble:
    """The conditions that make a frame harsh."""

    name: str
    blinds: bool = False
    moves: bool = False
    glares: bool = False
    tips: bool = False


TROUBLES = (
    Trouble("plain"),
    Trouble("blinds", blinds=True),
    Trouble("moved", moves=True),
    Trouble("glaring", glares=True),
    Trouble("moved and glaring", moves=True, glares=True),
    Trouble("blinds, moved", blinds=True, moves=True),
    Trouble("fingertips", tips=True),
    Trouble("fingertips, glaring", tips=True, glares=True),
    Trouble("fingertips, blinds", tips=True, blinds=True),
)


class HarshCamera:
    """Takes frames of one trouble; the same palette and number give the same frame."""

    def __init__(self, camera: CardCamera, palette: Palette, marks: str = "coloured") -> None:
        self.camera = camera
        self.palette = palette
        self.marks = marks

    def frames(self, trouble: Trouble, count: int) -> Iterator[RenderedFrame]:
        """Yield the given number of frames."""
        at = next(n for n, one in enumerate(TROUBLES) if one.name == trouble.name)
        for number in range(count):
            yield self.frame(trouble, np.random.default_rng([self.palette.seed, at, number]))

    def frame(self, trouble: Trouble, random: Random) -> RenderedFrame:
        """Take a frame: render a card in good light, then apply the trouble."""
        size = (1280, 720) if random.random() < 0.5 else (900, 700)
        view = View(
            pixels=float(random.uniform(20, 42)),
            tilt=float(random.uniform(0, 35)),
            tilted_to=float(random.uniform(-180, 180)),
            spin=float(random.normal(0, 25)),
            light=float(random.uniform(0.75, 0.95)),
            slope=float(random.uniform(0, 0.15)),
            warm=float(random.uniform(-0.1, 0.15)),
            blur=0.4,
            noise=0.0,
            quality=100,
            size=size,
        )
        frame = self.camera.take(int(random.integers(1, 250)), self._chips(random), view, random)
        lit: Picture = frame.picture.astype(np.float32) / 255
        plane = _plane(self.camera.face, frame)
        covered: Picture = np.zeros(len(frame.covered))
        if self.marks == PEN:
            lit, marked = self._crosses(lit, plane, random)
            frame = replace(frame, marked=marked)
        if trouble.tips:
            lit, covered = self._fingers(lit, plane, random)
        if trouble.blinds:
            lit = np.asarray(lit * self._blinds(lit.shape, plane, random)[..., None])
        if trouble.glares:
            lit = np.asarray(lit * random.uniform(1.15, 2.0))
        if trouble.moves:
            lit = _smeared(lit, float(random.uniform(0.08, 0.3)) * view.pixels, random)
        lit = np.asarray(cv2.GaussianBlur(lit, (0, 0), float(random.uniform(0.3, 1.1))))
        lit = lit + random.normal(0, random.uniform(0.004, 0.02), lit.shape)
        quality = [cv2.IMWRITE_JPEG_QUALITY, int(random.uniform(45, 96))]
        packed = cv2.imencode(".jpg", np.clip(lit * 255, 0, 255).astype(np.uint8), quality)[1]
        picture: Picture = np.asarray(cv2.imdecode(packed, cv2.IMREAD_COLOR))
        return replace(frame, picture=picture, covered=tuple(map(float, covered)))

    def _chips(self, random: Random) -> dict[int, Chip]:
        """Put chips of one kind on some cells."""
        if self.marks not in CHIPS:
            return {}
        deck, kind = self.camera.face.deck, CHIPS[self.marks](self.palette, random)
        share = random.uniform(0.04, 0.5)
        return {
            cell: kind.thrown(random, self.camera.face.middle(cell), self.camera.face.cell, 0.03)
            for cell in range(deck.rows * len(deck.columns))
            if random.random() < share and not deck.free >> cell & 1
        }

    def _crosses(self, lit: Picture, plane: Picture, random: Random) -> tuple[Picture, int]:
        """Cross some cells out with a pen; return the picture and a mask of these cells."""
        face, layer, marked = self.camera.face, _blank(), 0
        ink = random.choice([0, 1, 2], p=[0.6, 0.25, 0.15])
        tone = np.array([[0.08, 0.08, 0.08], [0.55, 0.15, 0.1], [0.12, 0.1, 0.7]][ink])
        thick, share = random.uniform(0.5, 1.3), random.uniform(0.04, 0.5)
        for cell in range(face.deck.rows * len(face.deck.columns)):
            if random.random() >= share or face.deck.free >> cell & 1:
                continue
            marked |= 1 << cell
            middle = np.array(face.middle(cell)) + random.normal(0, 1, 2)
            for slope in (-1, 1):
                end = np.array([1.0, slope]) * random.uniform(6, 9.5) + random.normal(0, 0.8, 2)
                _limb(layer, middle - end, middle + end, thick, tone)
        return _laid(lit, layer, plane, 0.0), marked

    def _blinds(self, shape: tuple[int, ...], plane: Picture, random: Random) -> Picture:
        """Return the light that falls through blinds: stripes in the card's plane."""
        wide, way = random.uniform(*self.palette.stripes), random.uniform(0, np.pi)
        v, u = np.mgrid[0 : shape[0], 0 : shape[1]].astype(np.float32)
        back = np.linalg.inv(plane)
        there = np.stack([u, v, np.ones_like(u)], -1) @ back.T
        x, y = there[..., 0] / there[..., 2], there[..., 1] / there[..., 2]
        wave = np.sin((x * np.cos(way) + y * np.sin(way)) * np.pi / wide + random.uniform(0, 6))
        edge = random.uniform(0.02, 0.6)
        lit = 1 / (1 + np.exp(np.clip(-(wave - random.uniform(-0.4, 0.4)) / edge * 4, -30, 30)))
        dark = random.uniform(0.35, 0.75)
        return np.asarray(dark + (1 - dark) * lit, np.float32)

    def _fingers(self, lit: Picture, plane: Picture, random: Random) -> tuple[Picture, Picture]:
        """Lay one to three fingers on the card; return it and the covered share of each cell."""
        face, layer = self.camera.face, _blank()
        red, green, blue = self.palette.skins[random.integers(len(self.palette.skins))]
        skin = np.array([blue, green, red]) / 255
        x, y = (
            random.uniform(face.grid.left, face.grid.right),
            random.uniform(face.grid.top, face.grid.bottom),
        )
        way, thick = random.uniform(0, 2 * np.pi), random.uniform(5.5, 8.5)
        along = np.array([np.cos(way), np.sin(way)])
        aside = np.array([-along[1], along[0]])
        for finger in range(int(random.integers(1, 4))):
            tip = np.array([x, y]) + aside * finger * 2.1 * thick - along * random.uniform(-12, 12)
            _finger(layer, tip, along, thick, skin, random)
        if random.random() < 0.5:  # a sleeve begins near the tips
            begins = np.array([x, y]) + along * random.uniform(35, 70) + aside * thick * 2
            cloth = np.array(tone_of(random.uniform(0, 360), random.random(), random.random()))
            _limb(layer, begins, begins + along * 400, 26, cloth)
        return _laid(lit, layer, plane, random.uniform(0, 0.4)), _shares(face, layer[..., 3])


def _blank() -> Picture:
    """Return an empty layer on the card and around it: blue, green, red, and opacity."""
    across, down = (round((side + 2 * EDGE) * SCALE) for side in (WIDTH, HEIGHT))
    return np.zeros((down, across, 4), np.float32)


def _laid(lit: Picture, layer: Picture, plane: Picture, shadow: float) -> Picture:
    """Lay a layer on the card, with a shadow of this strength around it."""
    to_mm = np.array([[1 / SCALE, 0, -EDGE], [0, 1 / SCALE, -EDGE], [0, 0, 1]])
    height, width = lit.shape[:2]
    laid = cv2.warpPerspective(layer, plane @ to_mm, (width, height), flags=cv2.INTER_AREA)
    alpha = laid[..., 3:]
    shade = cv2.GaussianBlur(alpha, (0, 0), 6)[..., None] * shadow
    return np.asarray(lit * (1 - shade) * (1 - alpha) + laid[..., :3])


def _plane(face: CardLayout, frame: RenderedFrame) -> Picture:
    """Return the transform from mm on the card to pixels, by the corners of the grid."""
    g = face.grid
    ends = [(g.left, g.top), (g.right, g.top), (g.right, g.bottom), (g.left, g.bottom)]
    here, there = np.array(ends, np.float32), np.array(frame.corners, np.float32)
    return np.asarray(cv2.getPerspectiveTransform(here, there))


def _limb(layer: Picture, near: Picture, far: Picture, thick: float, tone: Picture) -> None:
    """Draw a limb with a round end, `thick` mm to each side."""
    a, b = ([round(float(part + EDGE) * SCALE) for part in end] for end in (near, far))
    colour = [*(float(part) for part in tone), 1.0]
    cv2.line(layer, a, b, colour, round(2 * thick * SCALE), cv2.LINE_AA)


def _finger(
    layer: Picture, tip: Picture, along: Picture, thick: float, skin: Picture, random: Random
) -> None:
    """Draw a finger, lighter in its middle and redder at its end, with a nail."""
    end = tip + along * 300
    _limb(layer, tip, end, thick, skin * 0.8)
    _limb(layer, tip, end, thick * 0.8, skin * 0.92)
    _limb(layer, tip, end, thick * 0.5, skin)
    _limb(layer, tip, tip + along, thick * 0.7, skin * np.array([0.9, 0.92, 1.0]))
    if random.random() < 0.6:
        nail = skin + (1 - skin) * 0.35
        _limb(layer, tip + along * 2, tip + along * 8, thick * 0.5, nail)


def _shares(face: CardLayout, mask: Picture) -> Picture:
    """Return how much of each cell a layer covers."""
    half, found = face.cell * COVERED, []
    for cell in range(face.deck.rows * len(face.deck.columns)):
        x, y = face.middle(cell)
        left, right = (round((x + side + EDGE) * SCALE) for side in (-half, half))
        top, bottom = (round((y + side + EDGE) * SCALE) for side in (-half, half))
        found.append(float(np.clip(mask[top:bottom, left:right], 0, 1).mean()))
    return np.array(found)


def _smeared(lit: Picture, length: float, random: Random) -> Picture:
    """Smear a picture over a number of pixels in one direction."""
    way, half = random.uniform(0, np.pi), int(np.ceil(length / 2)) + 1
    kernel = np.zeros((2 * half + 1, 2 * half + 1), np.float32)
    for step in np.linspace(-length / 2, length / 2, 64):
        kernel[round(half + step * np.sin(way)), round(half + step * np.cos(way))] += 1
    return np.asarray(cv2.filter2D(lit, -1, kernel / kernel.sum()))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--frames", type=int, default=40, help="of each trouble")
    parser.add_argument("--set", choices=["chosen", "quoted"], default="quoted")
    parser.add_argument("--marks", choices=MARKS, default="coloured")
    parser.add_argument("--draw", type=Path)
    options = parser.parse_args()
    cv2.setNumThreads(1)
    activity = load_activity("bingo")
    bench, reader = Bench(activity), CardReader(activity.deck)
    palette = CHOSEN if options.set == "chosen" else QUOTED
    harsh = HarshCamera(bench.camera, palette, options.marks)
    print(HEAD, flush=True)
    everything = Count()
    for trouble in TROUBLES:
        count = Count()
        for number, frame in enumerate(harsh.frames(trouble, options.frames)):
            called = bench.called(frame, np.random.default_rng([palette.seed, number, 1]))
            reading = timed(reader.read, frame.picture, count)
            before = count.wrong_cells
            for into in (count, everything):
                bench.count(into, frame, reading, called)
            if options.draw and count.wrong_cells > before:
                options.draw.mkdir(parents=True, exist_ok=True)
                name = f"{trouble.name}-{number}.png".replace(", ", "-").replace(" ", "-")
                cv2.imwrite(str(options.draw / name), frame.picture)
        everything.seconds += count.seconds
        print(count.line(trouble.name), flush=True)
    print(everything.line("all"), flush=True)


if __name__ == "__main__":
    main()
