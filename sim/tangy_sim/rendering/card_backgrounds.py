"""Backgrounds of simulated cards: wood, cloth, photographs, coloured objects."""

from __future__ import annotations

from math import cos, pi, sin
from typing import TYPE_CHECKING, Any, TypeAlias

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Real = NDArray[Any]

Tone: TypeAlias = "tuple[float, float, float]"  # blue, green, red: 0 to 1


def tone_of(hue: float, saturation: float, value: float) -> Tone:
    """Return the tone of a hue in degrees, a saturation and a value."""
    from colorsys import hsv_to_rgb

    red, green, blue = hsv_to_rgb(hue % 360 / 360, min(1, saturation), min(1, value))
    return blue, green, red


def background(width: int, height: int, random: np.random.Generator) -> Real:
    """Draw a table top or room: wood, checked or dotted cloth, or coloured objects."""
    import cv2
    import numpy as np

    base = np.array(
        tone_of(random.uniform(0, 360), random.uniform(0, 0.7), random.uniform(0.15, 0.95)),
        np.float32,
    )
    v, u = np.mgrid[0:height:2, 0:width:2].astype(np.float32)
    angle = random.uniform(0, pi)
    s, t = u * cos(angle) + v * sin(angle), v * cos(angle) - u * sin(angle)
    kind = random.choice(["wood", "checks", "dots", "plain", "things", "photograph", "print"])
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
    if kind == "photograph":
        pattern = 1 + _unsharp(u.shape, random)
    rough = random.normal(0, 1, (height // 16 + 2, width // 16 + 2)).astype(np.float32)
    pattern = pattern * (1 + 0.05 * cv2.resize(rough, (u.shape[1], u.shape[0])))
    scene = pattern.astype(np.float32)[..., None] * base
    for _ in range(int(random.integers(3, 14)) if kind in ("things", "plain") else 2):
        tone = [
            float(c)
            for c in tone_of(random.uniform(0, 360), random.uniform(0, 1), random.uniform(0, 1))
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
    if kind == "print":  # a printed page, or another maker's card
        for line in range(20, u.shape[0], 34):
            words = " ".join(str(random.integers(1, 99)) for _ in range(24))
            cv2.putText(scene, words, (5, line), 0, 0.9, [0.1, 0.1, 0.1], 2, cv2.LINE_AA)
    return np.asarray(cv2.resize(np.clip(scene, 0, 1), (width, height)), np.float32)


def _unsharp(shape: tuple[int, ...], random: np.random.Generator) -> Real:
    """Draw spots of all sizes, larger ones with more contrast, as in photographs."""
    import cv2
    import numpy as np

    spots = np.zeros(shape, np.float32)
    for size in (2, 4, 8, 16, 32, 64, 128):
        small = random.normal(0, 0.04 * size**0.4, (shape[0] // size + 2, shape[1] // size + 2))
        spots += cv2.resize(small.astype(np.float32), shape[::-1], interpolation=cv2.INTER_CUBIC)
    return spots
