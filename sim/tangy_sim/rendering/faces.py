"""Synthetic faces: like enough to faces for the cascades, distinct, and of no real person.

A number defines a person; their images differ in light, place and noise.
"""

from __future__ import annotations

from typing import Any

import cv2
import numpy as np

SIZE = 200  # pixels of an image's width; the face takes 60% of it
_FINE = 4  # oversampling factor


def drawn_face(
    person: int,
    picture: int = 0,
    *,
    size: int = SIZE,
    light: float = 1.0,
    blur: float = 0.0,
) -> Any:
    """Draw one image (BGR) of one person; light is a ratio, blur in px."""
    who, now = np.random.default_rng(person), np.random.default_rng((person, picture))
    side = 100 * _FINE
    face: Any = np.full((side, side, 3), now.uniform(95, 150, 3), np.float32)
    skin = np.array([150, 175, 215]) * who.uniform(0.8, 1.05)
    hair = np.array([40, 50, 60]) * who.uniform(0.4, 2.2)
    middle = np.array([50, 52]) + now.uniform(-1.5, 1.5, 2)
    turn = now.uniform(-4, 4)

    def oval(x: float, y: float, w: float, h: float, colour: Any, lean: float = 0.0) -> None:
        cos, sin = np.cos(np.radians(turn)), np.sin(np.radians(turn))
        centre = middle + np.array([x * cos - y * sin, x * sin + y * cos])
        where = tuple(int(value) for value in np.round(centre * _FINE))
        axes = (max(1, round(w * _FINE)), max(1, round(h * _FINE)))
        shade = tuple(float(value) for value in np.atleast_1d(colour) * np.ones(3))
        cv2.ellipse(face, where, axes, turn + lean, 0, 360, shade, -1, cv2.LINE_AA)

    width, long = who.uniform(24, 28), who.uniform(32, 37)
    oval(0, -8, width + who.uniform(2, 5), long + 2, hair)
    oval(0, 0, width, long, skin)
    oval(0, -long + who.uniform(2, 8), width * 0.9, who.uniform(4, 9), hair)
    apart, high = who.uniform(10.5, 13), who.uniform(-8.5, -6)
    brow, thick, lean = who.uniform(5, 7.5), who.uniform(0.9, 2.2), who.uniform(-12, 12)
    above, open_by = who.uniform(5.5, 8), who.uniform(1.7, 2.8)
    for side_of in (-1, 1):
        oval(side_of * apart, high, 7.5, 5, skin * 0.72)
        oval(side_of * apart, high - above, brow, thick, hair, side_of * lean)
        oval(side_of * apart, high, 4.6, open_by, np.array([225, 225, 225]))
        oval(side_of * apart + now.uniform(-0.4, 0.4), high, 2.3, 2.3, np.array([45, 35, 30]))
    nose = who.uniform(1.8, 3.6)
    oval(0, 5, nose * 0.8, 9, skin * 1.08)
    oval(0, who.uniform(10, 13), nose * 1.5, 1.6, skin * 0.62)
    mouth = who.uniform(6, 11)
    oval(0, who.uniform(18, 21), mouth, who.uniform(1.4, 3.2), np.array([85, 80, 160]))
    oval(0, 21 + now.uniform(-0.5, 0.5), mouth * 0.9, 0.6, np.array([50, 40, 90]))
    if who.uniform() < 0.4:
        oval(0, 29, mouth, 4, hair * 1.2)
    for _ in range(4):  # individual wrinkles and spots
        at, wide = who.uniform(-18, 18, 2), who.uniform(1, 5)
        oval(at[0], at[1], wide, who.uniform(0.4, 1.5), skin * who.uniform(0.75, 0.95), lean)
    slope = np.linspace(-1, 1, side)[None, :, None] * now.uniform(-0.15, 0.15)
    face = cv2.GaussianBlur(face, (0, 0), 0.6 * _FINE) * (1 + slope) * light
    small: Any = cv2.resize(face, (size, size), interpolation=cv2.INTER_AREA)
    if blur:
        small = cv2.GaussianBlur(small, (0, 0), blur)
    small = small * now.uniform(0.9, 1.1) + now.normal(0, 2, small.shape)
    return np.clip(small, 0, 255).astype(np.uint8)
