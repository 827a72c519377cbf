"""Hands with sleeves, and other objects, over a simulated card."""

from __future__ import annotations

from itertools import pairwise
from math import cos, pi, sin
from typing import TYPE_CHECKING, Any

from tangy_profiles.card_face import HEIGHT, WIDTH, CardLayout
from tangy_sim.rendering.card_backgrounds import tone_of

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Real = NDArray[Any]


def draw_hand(
    table: Real,
    seen: Real,
    kind: str,
    scale: float,
    around: float,
    face: CardLayout,
    random: np.random.Generator,
) -> Real:
    """Draw a hand with its sleeve over the card; return its mask, 0 to 1."""
    import cv2
    import numpy as np

    skin, sleeve = np.zeros(seen.shape, np.uint8), np.zeros(seen.shape, np.uint8)
    if kind in ("blob", "bar", "thing"):
        mask = _shape(kind, skin, scale, around, face, random)
        return _lay(table, seen, mask, scale, random, skin=kind == "blob")

    def limb(mask: NDArray[np.uint8], points: list[tuple[float, float]], radius: float) -> None:
        ends = [(round((x + around) * scale), round((y + around) * scale)) for x, y in points]
        for a, b in pairwise(ends):
            cv2.line(mask, a, b, 255, max(1, round(2 * radius * scale)), cv2.LINE_AA)

    # The hand comes from the direction `way`; `tip` is the end of its longest finger.
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
    stuff = tone_of(random.uniform(0, 360), random.uniform(0, 0.9), random.uniform(0.05, 1))
    _cloth(table, seen, sleeve, np.array(stuff, np.float32), scale, random, striped=True)
    return both


def _shape(
    kind: str,
    mask: NDArray[np.uint8],
    scale: float,
    around: float,
    face: CardLayout,
    random: np.random.Generator,
) -> NDArray[np.uint8]:
    """Draw an outline with or without corners: a fist, a bar (an arm, a ruler), a cup, a sheet."""
    import cv2
    import numpy as np

    x, y = random.uniform(face.grid.left, face.grid.right), random.uniform(20, HEIGHT - 20)
    middle = np.array([x + around, y + around]) * scale
    if kind == "bar":
        way, half = random.uniform(0, 2 * pi), random.uniform(7, 30) * scale
        along, aside = np.array([cos(way), sin(way)]), np.array([-sin(way), cos(way)]) * half
        far = middle + along * 450 * scale
        points = np.array([middle - aside, middle + aside, far + aside, far - aside])
        if random.random() < 0.5:  # rounded end
            cv2.circle(mask, middle.astype(int).tolist(), round(half), 255, -1, cv2.LINE_AA)
    elif random.random() < 0.5:
        size = [float(side) for side in random.uniform(34, 110, 2) * scale]
        box = (middle.tolist(), size, random.uniform(0, 180))
        cv2.ellipse(mask, box, 255, -1, cv2.LINE_AA)
        return mask
    elif kind == "thing":
        size = [float(side) for side in random.uniform(34, 110, 2) * scale]
        points = cv2.boxPoints((middle.tolist(), size, random.uniform(0, 90)))
    else:
        corners = int(random.integers(4, 11))
        angles = np.sort(random.uniform(0, 2 * pi, corners))
        far = random.uniform(18, 70, corners)[:, None] * scale
        points = middle + far * np.column_stack([np.cos(angles), np.sin(angles)])
    cv2.fillPoly(mask, [points.astype(np.int32)], 255, cv2.LINE_AA)
    return mask


def _lay(
    table: Real,
    seen: Real,
    mask: NDArray[np.uint8],
    scale: float,
    random: np.random.Generator,
    *,
    skin: bool,
) -> Real:
    """Put an object with this mask on the card; return the mask, 0 to 1."""
    import cv2
    import numpy as np

    covered: Real = mask.astype(np.float32) / 255
    if random.random() < 0.6:
        shade = cv2.GaussianBlur(covered, (0, 0), max(1.0, 3 * scale))
        table *= 1 - random.uniform(0, 0.4) * shade[..., None]
    tone = _skin(random)
    if not skin and random.random() < 0.8:
        saturation = random.uniform(0, 1) if random.random() < 0.65 else 0.03
        dyed = tone_of(random.uniform(0, 360), saturation, random.uniform(0.05, 1))
        tone = np.array(dyed, np.float32)
    if random.random() < 0.4:
        _cloth(table, seen, mask, tone, scale, random, striped=not skin)
    else:
        alpha = covered[..., None]
        table *= 1 - alpha
        table += alpha * tone
        np.maximum(seen, covered, out=seen)
    if random.random() < 0.2:
        found, _ = cv2.findContours(
            (mask > 127).astype(np.uint8), cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE
        )
        edge = [float(part) for part in tone * 0.7]
        cv2.drawContours(table, found, -1, edge, max(1, round(0.8 * scale)), cv2.LINE_AA)
    return covered


def _skin(random: np.random.Generator) -> Real:
    import numpy as np

    dark = random.uniform(0, 1)
    tone = tone_of(
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
    """Draw skin or cloth on the table: darker towards its edges, slightly uneven."""
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
    if random.random() < 0.25:  # flat lighting
        shade = np.ones_like(shade)
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
