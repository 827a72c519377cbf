"""Infrared pictures of a table at which people hold up shining triangles, with the truth."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from tests.hw.pictures import Image

WIDTH, HEIGHT = 640, 480
CORNERS = ((40.0, 440.0), (600.0, 440.0), (500.0, 200.0), (140.0, 200.0))
"""The table's corners in the picture: left near, right near, right far, left far."""

TABLE = ((1.2, 5.0), (8.8, 5.0), (8.8, 5.8), (1.2, 5.8))
SEATS = (2.0, 4.0, 6.0, 8.0)
OTHERS = ("disc", "ellipse", "square", "bar", "lamp", "ring", "polygon", "trapezium", "glint")

Point = tuple[float, float]
Outline = NDArray[np.float64]


@dataclass(frozen=True)
class Scene:
    """One picture and who asks in it: the numbers of the seats, from 0; `since` is in pictures.

    `hidden` are those whose sign is partly covered by a hand.
    """

    image: Image
    asking: frozenset[int]
    hidden: frozenset[int]
    since: int


def in_picture(point: Point) -> Point:
    """Return a place on the table, in metres, as a point in the picture."""
    table, corners = np.array(TABLE, np.float32), np.array(CORNERS, np.float32)
    there = cv2.getPerspectiveTransform(table, corners)
    x, y, w = there @ (point[0], point[1], 1.0)
    return float(x / w), float(y / w)


class Things:
    """Draws shining objects."""

    def __init__(self, rng: np.random.Generator) -> None:
        self._rng = rng

    def sign(self, middle: Point, size: float) -> Outline:
        """Return the corners of a sign: an equilateral triangle, turned and seen at an angle."""
        turned = np.radians(self._rng.uniform(-25, 25) + np.array((-90, 30, 150)))
        corners = np.stack((np.cos(turned), np.sin(turned)), axis=1) * size / np.sqrt(3)
        corners[:, 0] *= np.cos(np.radians(self._rng.uniform(0, 40)))
        corners[:, 1] *= np.cos(np.radians(self._rng.uniform(0, 30)))
        moved: Outline = corners + np.array(middle)
        return moved

    def other(self, image: Image, kind: str, at: Point, size: float, light: int) -> None:
        """Draw another shining object."""
        rng, half = self._rng, size / 2
        turn = float(rng.uniform(0, 180))
        box = {"square": (1.0, rng.uniform(0.75, 1)), "bar": (1.0, rng.uniform(0.15, 0.5))}
        if kind in ("disc", "lamp", "ring", "glint"):
            radius = half if kind != "glint" else rng.uniform(1, 3)
            wide = -1 if kind != "ring" else max(1, round(size / 8))
            cv2.circle(image, _at(at), round(radius * 16), light, wide, cv2.LINE_AA, 4)
        elif kind == "ellipse":
            axes = round(half * 16), round(half * 16 * rng.uniform(0.4, 0.8))
            cv2.ellipse(image, _at(at), axes, turn, 0, 360, light, -1, cv2.LINE_AA, 4)
        elif kind in box:
            wide_, high = box[kind]
            corners = cv2.boxPoints((at, (size * wide_, size * high), turn))
            _fill(image, corners, light)
        elif kind == "polygon":
            count = int(rng.integers(5, 9))
            turns = np.sort(np.linspace(0, 2 * np.pi, count, endpoint=False)) + np.radians(turn)
            far = half * rng.uniform(0.8, 1.1, count)
            _fill(image, np.stack((np.cos(turns) * far, np.sin(turns) * far), 1) + at, light)
        else:
            short = rng.uniform(0.5, 0.8) * half
            corners = np.array(((-half, half), (half, half), (short, -half), (-short, -half)))
            a = np.radians(turn)
            about = np.array(((np.cos(a), -np.sin(a)), (np.sin(a), np.cos(a))))
            _fill(image, corners @ about.T + at, light)


def _fill(image: Image, corners: object, light: int) -> None:
    cv2.fillPoly(
        image, [np.round(np.asarray(corners) * 16).astype(np.int32)], light, cv2.LINE_AA, 4
    )


def _at(point: Point) -> tuple[int, int]:
    return round(point[0] * 16), round(point[1] * 16)


def sequence(
    seed: int, frames: int = 12, sizes: tuple[float, float] = (14, 50), *, signs: bool = True
) -> Iterator[Scene]:
    """Film the table: people who ask do so from the first picture on."""
    rng = np.random.default_rng(seed)
    things = Things(rng)
    still = _background(rng)
    size = float(rng.uniform(*sizes))
    asking = [seat for seat in range(len(SEATS)) if signs and rng.random() < 0.5]
    hand = {seat for seat in asking if rng.random() < 0.15}
    drawn = []
    for seat in asking:
        place = in_picture((SEATS[seat] + rng.uniform(-0.35, 0.35), rng.uniform(5.3, 5.75)))
        drawn.append((seat, things.sign(place, size), int(rng.integers(130, 255))))
    others = []
    for _ in range(rng.integers(1, 8)):
        free = (float(rng.uniform(0, WIDTH)), float(rng.uniform(0, HEIGHT)))
        on_table = in_picture((float(rng.uniform(1.3, 8.7)), float(rng.uniform(5.05, 5.75))))
        at = on_table if rng.random() < 0.6 else free
        if all(
            np.hypot(at[0] - s[:, 0].mean(), at[1] - s[:, 1].mean()) > 1.5 * size + 30
            for _, s, _ in drawn
        ):
            kind = str(rng.choice(OTHERS))
            others.append((kind, at, float(rng.uniform(10, 60)), int(rng.integers(110, 255))))
    for kind, at, wide, light in others:
        things.other(still, kind, at, wide, light)
        if kind == "lamp":
            halo = np.zeros_like(still)
            cv2.circle(halo, (round(at[0]), round(at[1])), round(wide), light, -1)
            still = np.maximum(
                still, (cv2.GaussianBlur(halo, (0, 0), wide / 2) * 0.6).astype(np.uint8)
            )
    blur, noise = float(rng.uniform(0.4, 1.6)), float(rng.uniform(1, 8))
    for number in range(frames):
        image = still.copy()
        hidden = set()
        for seat, corners, light in drawn:
            moved = corners + rng.normal(0, 0.7, 2)
            mirror = moved * (1, -1) + (0, 2 * moved[:, 1].max() + 2)
            _fill(image, mirror, max(20, light // 5))  # its reflection in the polished table
            _fill(image, moved, light)
            if seat in hand and number % 4 < 2:
                hidden.add(seat)
                edge = moved[rng.integers(3)]
                far = size * rng.uniform(0.1, 0.3)
                cv2.circle(image, _at(tuple(edge)), round(far * 16), 30, -1, cv2.LINE_AA, 4)
        values = cv2.GaussianBlur(image, (0, 0), blur).astype(np.float32)
        values += rng.standard_normal(values.shape, np.float32) * noise
        shown = np.clip(values, 0, 255).astype(np.uint8)
        yield Scene(shown, frozenset(asking), frozenset(hidden), number)


def _background(rng: np.random.Generator) -> Image:
    image = np.full((HEIGHT, WIDTH), int(rng.integers(8, 45)), np.uint8)
    cv2.fillPoly(image, [np.array(CORNERS, np.int32)], int(rng.integers(15, 70)))
    for seat in SEATS:
        x, y = in_picture((seat, 5.8))
        cv2.ellipse(
            image, (round(x), round(y) - 60), (30, 45), 0, 0, 360, int(rng.integers(30, 95)), -1
        )
    shade = np.linspace(rng.uniform(0.6, 1), rng.uniform(0.6, 1), WIDTH, dtype=np.float32)
    return np.asarray(cv2.GaussianBlur((image * shade).astype(np.uint8), (0, 0), 2), np.uint8)
