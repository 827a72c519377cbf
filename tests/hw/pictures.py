"""Pictures of random rooms for the tests and benches of cameras: no two seeds look alike."""

from __future__ import annotations

from typing import Any, TypeAlias

import cv2
import numpy as np
from numpy.typing import NDArray

Image: TypeAlias = NDArray[np.uint8]

WIDE = 16  # pixels of blur from which the picture is scaled down first


def room(seed: int, width: int = 1280, height: int = 720) -> Image:
    """Draw a room: a wall with objects, people, a table with a card or two."""
    rng = np.random.default_rng(seed)
    image = np.empty((720, 1280, 3), np.uint8)
    shade = np.linspace(rng.uniform(0.7, 1), rng.uniform(0.7, 1), 1280)[None, :, None]
    image[:] = shade * rng.integers(110, 220, 3)
    for _ in range(rng.integers(3, 9)):
        corner, size = rng.integers((0, 0), (1200, 400)), rng.integers((20, 20), (300, 250))
        cv2.rectangle(image, _at(corner), _at(corner + size), _colour(rng), -1)
        cv2.rectangle(image, _at(corner), _at(corner + size), _colour(rng), 3)
    for place in rng.uniform(0.1, 0.9, rng.integers(1, 5)):
        middle = np.array([place * 1280, rng.uniform(200, 320)])
        cv2.ellipse(
            image, _at(middle + np.array((0, 220))), (130, 170), 0, 0, 360, _colour(rng), -1
        )
        cv2.ellipse(
            image, _at(middle), (48, 62), 0, 0, 360, (120, 150, int(rng.integers(170, 230))), -1
        )
        for side in (-18, 18):
            cv2.circle(image, _at(middle + np.array((side, -8))), 6, (40, 40, 40), -1, cv2.LINE_AA)
    table = int(rng.integers(430, 520))
    cv2.rectangle(image, (0, table), (1280, 720), _colour(rng), -1)
    for _ in range(rng.integers(1, 4)):
        _card(image, rng, table)
    if (width, height) != (1280, 720):
        image = np.asarray(
            cv2.resize(image, (width, height), interpolation=cv2.INTER_AREA), np.uint8
        )
    return image


def _card(image: Image, rng: np.random.Generator, table: int) -> None:
    cell = int(rng.integers(18, 34))
    left, top = rng.integers((0, table), (1280 - 5 * cell, 720 - 5 * cell))
    cv2.rectangle(image, (left, top), (left + 5 * cell, top + 5 * cell), (245, 245, 245), -1)
    for row in range(5):
        for column in range(5):
            x, y = left + column * cell, top + row * cell
            cv2.rectangle(image, (x, y), (x + cell, y + cell), (20, 20, 20), 1)
            number, scale = str(rng.integers(1, 76)), cell / 50
            cv2.putText(
                image, number, (x + 4, y + cell - 6), 0, scale, (10, 10, 10), 1, cv2.LINE_AA
            )
            if rng.random() < 0.3:
                cv2.circle(image, (x + cell // 2, y + cell // 2), cell // 3, (30, 30, 200), -1)


def seen(
    image: Image,
    rng: np.random.Generator,
    *,
    light: float = 1.0,
    blur: float = 0.0,
    noise: float = 3.0,
    quality: int | None = None,
) -> Image:
    """Return a picture as a camera sees it, with a given light, blur (pixels), noise, JPEG."""
    values: Any = image
    if blur > WIDE:  # the same result, in a hundredth of the time
        small = cv2.resize(image, None, fx=1 / WIDE, fy=1 / WIDE, interpolation=cv2.INTER_AREA)
        small = cv2.GaussianBlur(small, (0, 0), blur / WIDE)
        values = cv2.resize(small, image.shape[1::-1], interpolation=cv2.INTER_CUBIC)
    elif blur:
        values = cv2.GaussianBlur(values, (0, 0), blur)
    shown = values.astype(np.float32) * light
    if noise:
        shown += rng.standard_normal(shown.shape, np.float32) * noise
    made: Image = np.clip(shown, 0, 255).astype(np.uint8)
    if quality is None:
        return made
    return np.asarray(cv2.imdecode(encoded(made, quality), cv2.IMREAD_COLOR), np.uint8)


def encoded(image: Image, quality: int = 85) -> Image:
    """Return a picture as JPEG."""
    return np.asarray(cv2.imencode(".jpg", image, [cv2.IMWRITE_JPEG_QUALITY, quality])[1], np.uint8)


def _at(point: NDArray[Any]) -> tuple[int, int]:
    return int(point[0]), int(point[1])


def _colour(rng: np.random.Generator) -> tuple[int, int, int]:
    blue, green, red = rng.integers(20, 230, 3)
    return int(blue), int(green), int(red)
