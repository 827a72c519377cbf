"""What lies about on the simulated table: chips, hands with sleeves, and what is behind them."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise
from math import cos, hypot, pi, radians, sin, tan
from typing import TYPE_CHECKING, Any

from tangy_profiles.card_face import HEIGHT, WIDTH, Face

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Real = NDArray[Any]
    Tone = tuple[float, float, float]

HUES = {"red": 0, "orange": 24, "yellow": 50, "green": 130, "blue": 215, "purple": 285, "pink": 335}


@dataclass(frozen=True)
class Chip:
    """A chip that lies at (x, y) mm on the card; `clear` is how much light goes through."""

    radius: float
    tone: Tone  # blue, green, red: 0 to 1
    clear: float
    thick: float
    rim: float  # how much darker or lighter its rim is
    x: float = 0.0
    y: float = 0.0

    def at(self, x: float, y: float) -> Chip:
        """Return the chip at another place."""
        return replace(self, x=float(x), y=float(y))

    def thrown(
        self, random: np.random.Generator, middle: tuple[float, float], cell: float, neat: bool
    ) -> Chip:
        """Put the chip on a cell: near its middle, or one in ten towards the next cell."""
        most = 0.36 * cell
        if neat or random.random() > 0.12:
            dx, dy = random.normal(0, 0.075 * cell, 2)
        else:
            angle, far = random.uniform(0, 2 * pi), random.uniform(0.22, 0.36) * cell
            dx, dy = far * cos(angle), far * sin(angle)
        dx, dy = max(-most, min(most, dx)), max(-most, min(most, dy))
        return self.at(middle[0] + dx, middle[1] + dy)

    def clear_of(self, other: Chip) -> bool:
        """Say whether two chips can lie beside each other."""
        return hypot(self.x - other.x, self.y - other.y) > 0.92 * (self.radius + other.radius)


def some_chip(random: np.random.Generator) -> Chip:
    """Draw a kind of chip: mostly red ones of 19 mm, some of them translucent."""
    hue = "red" if random.random() < 0.6 else str(random.choice(list(HUES)))
    tone = _tone(
        HUES[hue] + random.normal(0, 5), random.uniform(0.6, 1.0), random.uniform(0.45, 0.95)
    )
    return Chip(
        radius=float(random.normal(9.5, 0.5)),
        tone=tone,
        clear=float(random.uniform(0.25, 0.7)) if random.random() < 0.4 else 0.0,
        thick=float(random.uniform(0.8, 3.0)),
        rim=float(random.uniform(-0.35, 0.25)),
    )


def _tone(hue: float, saturation: float, value: float) -> Tone:
    from colorsys import hsv_to_rgb

    red, green, blue = hsv_to_rgb(hue % 360 / 360, min(1, saturation), min(1, value))
    return blue, green, red


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
    """Draw a chip with its shadow, its side (as the camera's tilt shows it) and its top."""
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
        0.75,
        soft=chip.thick * scale * 0.35,
    )
    steps = max(1, round(high * scale / 1.5))
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
    )
    if not chip.clear:
        _disc(table, seen, chip.x + dx, chip.y + dy, chip.radius * 0.82, scale, around, tone, 0.0)
    if random.random() < 0.25:  # lamplight on its top
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
) -> None:
    """Lay a disc on the table: `clear` of what is beneath shines through, in its tone."""
    import numpy as np

    px, py, reach = (x + around) * scale, (y + around) * scale, radius * scale + 3 * soft + 2
    left, right = max(0, int(px - reach)), min(table.shape[1], int(px + reach) + 1)
    top, bottom = max(0, int(py - reach)), min(table.shape[0], int(py + reach) + 1)
    if left >= right or top >= bottom:
        return
    v, u = np.mgrid[top:bottom, left:right].astype(np.float32) + np.float32(0.5)
    far = np.hypot(u - px, v - py) - radius * scale
    inside = (1 / (1 + np.exp(np.clip(far / max(soft * 0.5, 0.2), -30, 30))))[..., None]
    box = np.s_[top:bottom, left:right]
    beneath = table[box]
    through = beneath * (clear * (tone if tone.any() else 1)) + (1 - clear) * tone
    # Where nothing lay, a shadow darkens nothing: the background is not in this layer.
    there = np.maximum(seen[box][..., None], inside if tone.any() else 0)
    table[box] = (beneath * (1 - inside) + through * inside) * np.where(tone.any(), 1, there)
    seen[box] = np.maximum(seen[box], inside[..., 0] if tone.any() else 0)


def draw_hand(
    table: Real,
    seen: Real,
    kind: str,
    scale: float,
    around: float,
    face: Face,
    random: np.random.Generator,
) -> Real:
    """Draw a hand with its sleeve over the card; return where it is, 0 to 1."""
    import cv2
    import numpy as np

    skin, sleeve = np.zeros(seen.shape, np.uint8), np.zeros(seen.shape, np.uint8)
    if kind == "thing":
        return _draw_thing(table, seen, scale, around, face, random)

    def limb(mask: NDArray[np.uint8], points: list[tuple[float, float]], radius: float) -> None:
        ends = [(round((x + around) * scale), round((y + around) * scale)) for x, y in points]
        for a, b in pairwise(ends):
            cv2.line(mask, a, b, 255, max(1, round(2 * radius * scale)), cv2.LINE_AA)

    # The hand comes from `way`; `tip` is where its longest finger ends.
    way = random.uniform(0, 2 * pi)
    ux, uy = cos(way), sin(way)
    grid = face.grid
    if kind == "thumb":  # holds the card at its edge
        reach = random.uniform(8, 34)
        side = random.choice(4)
        tip = [
            (grid.left - 9 + reach, random.uniform(20, HEIGHT - 20)),
            (grid.right + 9 - reach, random.uniform(20, HEIGHT - 20)),
            (random.uniform(15, WIDTH - 15), HEIGHT - reach),
            (random.uniform(15, WIDTH - 15), reach),
        ][side]
        ux, uy = [(-1.0, 0.3), (1.0, 0.3), (0.2, 1.0), (-0.2, -1.0)][side]
    else:
        tip = (random.uniform(grid.left, grid.right), random.uniform(grid.top, grid.bottom))
    thick = random.uniform(7.5, 10.5)

    def from_tip(back: float, aside: float) -> tuple[float, float]:
        return tip[0] + ux * back - uy * aside, tip[1] + uy * back + ux * aside

    turn = random.choice([-1, 1])
    if kind == "flat":
        for finger, back in enumerate((6.0, 0.0, 3.0, 16.0)):
            aside = (finger - 1) * 2.15 * thick * turn
            limb(skin, [from_tip(back, aside * 1.1), from_tip(75, aside * 0.9)], thick)
        limb(skin, [from_tip(75, 20 * turn), from_tip(60, -42 * turn)], thick * 1.2)
        palm = (85.0, 40.0)
    elif kind == "thumb":
        limb(skin, [from_tip(0, 0), from_tip(30, 3 * turn), from_tip(60, 15 * turn)], thick * 1.2)
        palm = (85.0, 38.0)
    else:
        limb(skin, [from_tip(0, 0), from_tip(40, 2), from_tip(80, 0)], thick)
        for aside in (1.0, 1.9, 2.7):
            limb(skin, [from_tip(58, aside * 2 * thick * turn), from_tip(85, 12 * turn)], thick)
        palm = (88.0, 36.0)
    limb(skin, [from_tip(palm[0], 0), from_tip(palm[0] + 25, 0)], palm[1])
    begins = palm[0] + random.uniform(25, 70)
    limb(skin, [from_tip(palm[0], 0), from_tip(450, 0)], 28)
    limb(sleeve, [from_tip(begins + 40, 0), from_tip(450, 0)], random.uniform(36, 46))
    skin[sleeve > 0] = 0
    both = np.maximum(skin, sleeve).astype(np.float32) / 255
    shade = cv2.GaussianBlur(both, (0, 0), max(1.0, 5 * scale))
    fallen = np.roll(shade, (round(3 * scale), round(2 * scale)), (0, 1))
    table *= 1 - 0.45 * fallen[..., None]
    _cloth(table, seen, skin, _skin(random), scale, random)
    stuff = np.array(_tone(random.uniform(0, 360), random.uniform(0, 0.8), random.uniform(0.1, 1)))
    _cloth(table, seen, sleeve, stuff.astype(np.float32), scale, random, striped=True)
    return both


def _draw_thing(
    table: Real,
    seen: Real,
    scale: float,
    around: float,
    face: Face,
    random: np.random.Generator,
) -> Real:
    """Lay something else on the card: a cup, a sheet of paper, glasses; round or with corners."""
    import cv2
    import numpy as np

    both = np.zeros(seen.shape, np.uint8)
    x, y = random.uniform(face.grid.left, face.grid.right), random.uniform(20, HEIGHT - 20)
    size = random.uniform(34, 110, 2) * scale
    middle = ((x + around) * scale, (y + around) * scale)
    box = (middle, (float(size[0]), float(size[1])), random.uniform(0, 90))
    if random.random() < 0.5:
        cv2.ellipse(both, box, 255, -1, cv2.LINE_AA)
    else:
        cv2.fillPoly(both, [cv2.boxPoints(box).astype(np.int32)], 255, cv2.LINE_AA)
    shade = cv2.GaussianBlur(both.astype(np.float32) / 255, (0, 0), max(1.0, 3 * scale))
    table *= 1 - random.uniform(0, 0.4) * shade[..., None]
    like = random.choice(3)
    tone = _skin(random)
    if like:
        saturation = random.uniform(0, 1) if like == 1 else 0.05
        tone = np.array(_tone(random.uniform(0, 360), saturation, random.uniform(0.1, 1)))
    if random.random() < 0.5:
        _cloth(table, seen, both, tone, scale, random, striped=True)
    else:
        alpha = both.astype(np.float32)[..., None] / 255
        table *= 1 - alpha
        table += alpha * tone.astype(np.float32)
        np.maximum(seen, alpha[..., 0], out=seen)
    covered: Real = both.astype(np.float32) / 255
    return covered


def _skin(random: np.random.Generator) -> Real:
    import numpy as np

    dark = random.uniform(0, 1)
    tone = _tone(
        random.uniform(8, 26), 0.25 + 0.35 * dark + random.normal(0, 0.05), 0.95 - 0.6 * dark
    )
    return np.array(tone, np.float32)


def _cloth(
    table: Real,
    seen: Real,
    mask: NDArray[np.uint8],
    tone: Real,
    scale: float,
    random: np.random.Generator,
    *,
    striped: bool = False,
) -> None:
    """Lay skin or cloth on the table: rounder and darker towards its edges, a little uneven."""
    import cv2
    import numpy as np

    if not mask.any():
        return
    left, top, across, down = cv2.boundingRect(mask)
    box = np.s_[top : top + down, left : left + across]
    mask, table, seen = mask[box], table[box], seen[box]
    deep = cv2.distanceTransform((mask > 127).astype(np.uint8), cv2.DIST_L2, 3) / (9 * scale)
    shade = 0.62 + 0.38 * np.sqrt(np.clip(deep, 0, 1))
    small = random.normal(0, 1, (mask.shape[0] // 12 + 2, mask.shape[1] // 12 + 2))
    uneven = cv2.resize(small.astype(np.float32), mask.shape[::-1], interpolation=cv2.INTER_CUBIC)
    shade = shade * (1 + 0.04 * uneven)
    if striped and random.random() < 0.5:
        v, u = np.mgrid[0 : mask.shape[0], 0 : mask.shape[1]].astype(np.float32)
        angle, wide = random.uniform(0, pi), random.uniform(3, 15) * scale
        stripes = np.sin((u * cos(angle) + v * sin(angle)) * 2 * pi / wide) > 0
        shade = shade * np.where(stripes, 1.0, random.uniform(0.4, 0.9))
    alpha = (mask.astype(np.float32) / 255)[..., None]
    table *= 1 - alpha
    table += alpha * tone * shade.astype(np.float32)[..., None]
    np.maximum(seen, alpha[..., 0], out=seen)


def background(width: int, height: int, random: np.random.Generator) -> Real:
    """Draw a table top or room: wood, cloth with checks or dots, or things of all colours."""
    import cv2
    import numpy as np

    base = np.array(
        _tone(random.uniform(0, 360), random.uniform(0, 0.7), random.uniform(0.15, 0.95)),
        np.float32,
    )
    v, u = np.mgrid[0:height:2, 0:width:2].astype(np.float32)
    angle = random.uniform(0, pi)
    s, t = u * cos(angle) + v * sin(angle), v * cos(angle) - u * sin(angle)
    kind = random.choice(["wood", "checks", "dots", "plain", "things"])
    wide = random.uniform(12, 90)
    if kind == "wood":
        grain = cv2.resize(
            random.normal(0, 1, (height // 6 + 2, 4)).astype(np.float32), (u.shape[1], u.shape[0])
        )
        pattern = 1 + 0.1 * grain + 0.06 * np.sin(t / random.uniform(2, 6) + 3 * grain)
    elif kind == "checks":
        pattern = 0.7 + 0.3 * ((s // wide + t // wide) % 2)
    elif kind == "dots":
        near = np.hypot(s % wide - wide / 2, t % wide - wide / 2) < wide * 0.3
        pattern = np.where(near, random.uniform(0.3, 1.6), 1.0)
    else:
        pattern = np.ones_like(u)
    rough = random.normal(0, 1, (height // 16 + 2, width // 16 + 2)).astype(np.float32)
    pattern = pattern * (1 + 0.05 * cv2.resize(rough, (u.shape[1], u.shape[0])))
    scene = pattern.astype(np.float32)[..., None] * base
    for _ in range(int(random.integers(3, 14)) if kind in ("things", "plain") else 2):
        tone = [
            float(c)
            for c in _tone(random.uniform(0, 360), random.uniform(0, 1), random.uniform(0, 1))
        ]
        x, y = int(random.uniform(0, u.shape[1])), int(random.uniform(0, u.shape[0]))
        size = int(random.uniform(10, 120))
        if random.random() < 0.5:
            cv2.circle(scene, (x, y), size // 2, tone, -1, cv2.LINE_AA)
        else:
            box = ((x, y), (size, int(size * random.uniform(0.3, 2))), random.uniform(0, 90))
            cv2.fillPoly(scene, [cv2.boxPoints(box).astype(np.int32)], tone, cv2.LINE_AA)
        if random.random() < 0.4:
            cv2.putText(scene, str(random.integers(1, 75)), (x, y), 0, 1, [0.0, 0.0, 0.0], 2)
    return np.asarray(cv2.resize(np.clip(scene, 0, 1), (width, height)), np.float32)
