"""Chips on the simulated table: thick and thin, clear and opaque, of all colours."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import cos, hypot, pi, radians, sin, tan
from typing import TYPE_CHECKING, Any

from tangy_sim.rendering.card_backgrounds import Tone, tone_of

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Real = NDArray[Any]

STRADDLES = 0.46  # of a cell: maximum distance of a chip from the centre of the cell that it marks
HUES = {"red": 0, "orange": 24, "yellow": 50, "green": 130, "blue": 215, "purple": 285, "pink": 335}


@dataclass(frozen=True)
class Outline:
    """Outline of a chip, by default a disc.

    `long` is the ratio of length to width, `turn` its direction in rad; `corners` is the number of
    corners of a cut-out chip, `hole` the size of the hole in its middle relative to its radius.
    """

    long: float = 1.0
    turn: float = 0.0
    corners: int = 0
    hole: float = 0.0

    def beyond(self, u: Real, v: Real, radius: float) -> Real:
        """Return the signed distance (px) of points from the outline, negative inside."""
        import numpy as np

        along, aside = (
            u * cos(self.turn) + v * sin(self.turn),
            v * cos(self.turn) - u * sin(self.turn),
        )
        off: Real = np.hypot(along, aside * self.long)
        if self.corners:
            part = 2 * pi / self.corners
            way = np.arctan2(aside * self.long, along)
            off = off * np.cos((way + pi) % part - part / 2) / cos(part / 2) ** 0.5
        off = off - radius
        if self.hole:
            off = np.maximum(off, self.hole * radius - np.hypot(u, v))
        return off


DISC = Outline()


@dataclass(frozen=True)
class Chip:
    """A chip that lies at (x, y) mm on the card.

    `clear` is the share of light that passes through; it takes on the chip's colour, unless
    `washed`. `rim` is the relative brightness of the rim; `outline` and `ring` the darkness of a
    line around it and on it, 0 to 1; `relief` the roughness of its top, and `stripes` the number of
    white stripes on its edge. A `sheer` chip is a film: light passes it once, and it has no shadow.
    """

    radius: float
    tone: Tone
    clear: float
    thick: float
    rim: float
    outline: float = 0.0
    ring: float = 0.0
    washed: bool = False
    shape: Outline = DISC
    relief: float = 0.0
    stripes: int = 0
    sheer: bool = False
    x: float = 0.0
    y: float = 0.0

    def at(self, x: float, y: float) -> Chip:
        """Return the chip at another place, in mm."""
        return replace(self, x=float(x), y=float(y))

    def thrown(
        self,
        random: np.random.Generator,
        middle: tuple[float, float],
        cell: float,
        straddling: float,
    ) -> Chip:
        """Put the chip on a cell: near its centre, or with probability `straddling` anywhere in it.

        Its own centre always lies in the cell that it marks.
        """
        if random.random() < straddling:
            dx, dy = random.uniform(-STRADDLES * cell, STRADDLES * cell, 2)
        else:
            most = 0.36 * cell
            dx, dy = (max(-most, min(most, d)) for d in random.normal(0, 0.075 * cell, 2))
        return self.at(middle[0] + dx, middle[1] + dy)

    def clear_of(self, other: Chip) -> bool:
        """Return whether two chips can lie beside each other."""
        return hypot(self.x - other.x, self.y - other.y) > 0.92 * (self.radius + other.radius)


def some_chip(random: np.random.Generator) -> Chip:
    """Draw a random chip: mostly red ones of 19 mm, some of them translucent."""
    chance, uniform = random.random, random.uniform
    hue = "red" if chance() < 0.5 else str(random.choice(list(HUES)))
    tone = tone_of(HUES[hue] + random.normal(0, 5), uniform(0.5, 1.0), uniform(0.3, 1.0))
    colourless = chance() < 0.14
    if colourless:
        tone = tone_of(0, 0, float(random.choice([0.08, 0.2, 0.45, 0.6, 0.9, 0.97])))
    plain = chance() < 0.3  # thin as paper, and of one tone
    pale = min(tone) > 0.75
    outline = uniform(0.3, 0.8) if (pale and plain) or chance() < 0.15 else 0.0
    return Chip(
        radius=float(random.normal(9.5, 0.5) if chance() < 0.7 else uniform(7.7, 11.8)),
        tone=tone,
        clear=float(uniform(0.15, 0.68)) if chance() < 0.4 and not pale else 0.0,
        thick=0.05 if plain else float(uniform(0.8, 3.0)),
        rim=0.0 if plain else float(uniform(-0.35, 0.25)),
        outline=float(outline),
        ring=float(uniform(-0.5, 0.5)) if chance() < 0.12 else 0.0,
        washed=bool(chance() < 0.6),
    )


def faint_chip(random: np.random.Generator) -> Chip:
    """Draw a random chip that is hard to see: very translucent, or pale."""
    chance, uniform = random.random, random.uniform
    hue = float(random.choice([*HUES.values(), 180]))
    tone = tone_of(hue + random.normal(0, 8), uniform(0.15, 1.0), uniform(0.5, 1.0))
    if chance() < 0.25:  # smoke-grey
        tone = tone_of(hue, uniform(0.0, 0.12), uniform(0.05, 0.75))
    pale = chance() < 0.25
    if pale:
        tone = tone_of(hue, uniform(0.0, 0.12), uniform(0.9, 1.0))
    thin = chance() < 0.5
    return replace(
        some_chip(random),
        tone=tone,
        clear=0.0 if pale and chance() < 0.7 else float(uniform(0.4, 0.72)),
        thick=0.05 if thin else float(uniform(0.4, 2.5)),
        rim=0.0 if thin and not pale else float(uniform(-0.25, 0.1)),
        outline=float(uniform(0.1, 0.5)) if pale and thin else 0.0,
        washed=bool(chance() < 0.75),
    )


def put_chip(
    table: Real,
    seen: Real,
    chip: Chip,
    scale: float,
    around: float,
    tilt: float,
    tilted_to: float,
    random: np.random.Generator,
) -> None:
    """Draw a chip with its shadow, visible side and top; `scale` is in px per mm."""
    import numpy as np

    high = chip.thick * tan(radians(min(tilt, 70)))
    away = radians(tilted_to) - pi / 2
    dx, dy = high * cos(away), high * sin(away)
    tone = np.array(chip.tone, np.float32)
    light = random.uniform(0, 2 * pi)
    fall = chip.thick * 0.5
    _disc(
        table,
        seen,
        chip.x + fall * cos(light),
        chip.y + fall * sin(light),
        chip.radius * 1.04,
        scale,
        around,
        np.zeros(3, np.float32),
        0.95 if chip.sheer else 0.75,
        soft=chip.thick * scale * 0.35,
        shape=chip.shape,
    )
    steps = 0 if chip.sheer else max(1, round(high * scale / 1.5))
    for step in range(steps):
        part = step / steps
        _disc(
            table,
            seen,
            chip.x + dx * part,
            chip.y + dy * part,
            chip.radius,
            scale,
            around,
            tone * 0.6,
            chip.clear ** (1 / steps) if chip.clear else 0.0,
            shape=chip.shape,
        )
    _disc(
        table,
        seen,
        chip.x + dx,
        chip.y + dy,
        chip.radius,
        scale,
        around,
        tone * (1 + chip.rim),
        chip.clear,
        washed=chip.washed,
        shape=chip.shape,
    )
    top = chip.x + dx, chip.y + dy
    if not chip.clear and chip.rim:
        _disc(table, seen, *top, chip.radius * 0.82, scale, around, tone, 0.0, shape=chip.shape)
    if chip.relief or chip.stripes:
        _figure(table, chip, top, scale, around, random)
    if chip.outline:
        _circle(table, top, chip.radius, scale, around, tone * (1 - chip.outline))
    if chip.ring:
        _circle(table, top, chip.radius * 0.62, scale, around, tone * (1 + chip.ring))
    if random.random() < 0.25:  # reflection of a lamp
        spot = chip.radius * 0.4
        _disc(
            table,
            seen,
            chip.x + dx + spot * cos(light),
            chip.y + dy + spot * sin(light),
            chip.radius * random.uniform(0.15, 0.35),
            scale,
            around,
            np.ones(3, np.float32),
            random.uniform(0.3, 0.8),
            soft=scale,
        )


def _disc(
    table: Real,
    seen: Real,
    x: float,
    y: float,
    radius: float,
    scale: float,
    around: float,
    tone: Real,
    clear: float,
    soft: float = 0.7,
    washed: bool = False,
    shape: Outline = DISC,
) -> None:
    """Draw one layer of a chip; a share `clear` of the background shows through, in its tone."""
    import numpy as np

    px, py, reach = (x + around) * scale, (y + around) * scale, radius * scale + 3 * soft + 2
    left, right = max(0, int(px - reach)), min(table.shape[1], int(px + reach) + 1)
    top, bottom = max(0, int(py - reach)), min(table.shape[0], int(py + reach) + 1)
    if left >= right or top >= bottom:
        return
    v, u = np.mgrid[top:bottom, left:right].astype(np.float32) + np.float32(0.5)
    far = shape.beyond(u - px, v - py, radius * scale)
    inside = (1 / (1 + np.exp(np.clip(far / max(soft * 0.5, 0.2), -30, 30))))[..., None]
    box = np.s_[top:bottom, left:right]
    beneath = table[box]
    dye = tone if tone.any() and not washed else 1
    through = beneath * (clear * dye) + (1 - clear) * tone
    # A shadow outside the card is not drawn: the background is not in this layer.
    there = np.maximum(seen[box][..., None], inside if tone.any() else 0)
    table[box] = (beneath * (1 - inside) + through * inside) * np.where(tone.any(), 1, there)
    seen[box] = np.maximum(seen[box], inside[..., 0] if tone.any() else 0)


def _figure(
    table: Real,
    chip: Chip,
    middle: tuple[float, float],
    scale: float,
    around: float,
    random: np.random.Generator,
) -> None:
    """Make a chip's top uneven as a coin's, or its edge striped."""
    import cv2
    import numpy as np

    side = round(chip.radius * scale) + 1
    left, top = (round((place + around) * scale) - side for place in middle)
    if min(left, top) < 0 or left + 2 * side > table.shape[1] or top + 2 * side > table.shape[0]:
        return
    v, u = np.mgrid[-side:side, -side:side].astype(np.float32)
    within = chip.shape.beyond(u, v, chip.radius * scale) < -0.5
    part = table[top : top + 2 * side, left : left + 2 * side]
    if chip.relief:
        fine = int(random.integers(5, 12))
        small = random.normal(1, chip.relief, (fine, fine)).astype(np.float32)
        uneven = cv2.resize(small, (2 * side, 2 * side), interpolation=cv2.INTER_CUBIC)
        part *= np.where(within, np.clip(uneven, 0.3, 1.9), 1)[..., None]
    if chip.stripes:
        way = np.arctan2(v, u) + random.uniform(0, pi)
        edge = within & (np.hypot(u, v) > 0.66 * chip.radius * scale)
        part[edge & (np.sin(chip.stripes * way) > 0.3)] = 0.93


def _circle(
    table: Real, middle: tuple[float, float], radius: float, scale: float, around: float, tone: Real
) -> None:
    """Draw a thin circle."""
    import cv2

    x, y = (round((place + around) * scale * 16) for place in middle)
    line = [float(part) for part in tone]
    thick = max(1, round(0.9 * scale))
    cv2.circle(table, (x, y), round(radius * scale * 16), line, thick, cv2.LINE_AA, 4)
