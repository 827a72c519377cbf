"""The infrared camera over the bench's table: a dark room, and bright signs.

It sees the table from the robot's side. People who ask for help have a triangle up on the table.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping, Sequence
from math import ceil
from types import MappingProxyType
from typing import Any, TypeAlias

import cv2
import numpy as np
from numpy.typing import NDArray

from tangy_profiles.room import Room

SIZE = (320, 240)
CORNERS = ((20.0, 222.0), (300.0, 222.0), (262.0, 96.0), (58.0, 96.0))
"""Corners of the table in the image: left near, right near, right far, left far."""
WIDE = 8.0
"""Metres of table per SIZE[0] columns; the image of a longer table is a multiple as wide."""
SIGN = 19.0  # pixels per side
STRIP, STRIP_PITCH = (15.0, 5.0), 11.0
"""How wide and high a strip of an answer sign is, and how far to the next, in pixels."""
LETTERS, FIRST_STRIPS = "abcd", 2
NONE_SHOWN: Mapping[str, str] = MappingProxyType({})
VARIANTS = 5  # frames with different noise, sent in rotation
Corners: TypeAlias = tuple[
    tuple[float, float], tuple[float, float], tuple[float, float], tuple[float, float]
]
QUALITY = 92
NOISE = 3.0  # grey levels


def corners_in(room: Room) -> Corners:
    """Return the corners of a room's table, or tables, in the image, in pixels."""
    (a, b), (c, d), (e, f), (g, h) = CORNERS
    times = _times(room)
    return (a * times, b), (c * times, d), (e * times, f), (g * times, h)


def _times(room: Room) -> int:
    left, _, right, _ = room.table
    return ceil((right - left) / WIDE)


class InfraredCamera:
    """Produces the frames of the camera that watches the signs, as JPEG."""

    def __init__(self, room: Room, people: Sequence[str], *, seed: int) -> None:
        self._random = np.random.default_rng([seed, 8])
        self._people = list(people)
        left, near, right, far = room.table
        self._corners = corners_in(room)
        self._size = (SIZE[0] * _times(room), SIZE[1])
        corners = np.array(((left, near), (right, near), (right, far), (left, far)), np.float32)
        there = cv2.getPerspectiveTransform(corners, np.array(self._corners, np.float32))
        places = [
            (min(max(seat.x, left), right), near + 0.6 * (far - near))
            for seat in room.seated(len(self._people))
        ]
        seen = cv2.perspectiveTransform(np.array([places], np.float32), there)[0]
        self._places = {person: seen[seat] for seat, person in enumerate(self._people)}
        self._still = self._background()
        self._up: tuple[tuple[str, str], ...] | None = None
        self._frames: deque[bytes] = deque()
        self._shown: NDArray[np.float32] = self._still

    def frame(self, asking: Sequence[str], shown: Mapping[str, str] = NONE_SHOWN) -> bytes:
        """Return the next frame in which these people ask, and others show a letter ("a")."""
        up = (*((one, "") for one in sorted(asking)), *sorted(shown.items()))
        if up != self._up:
            self._up = up
            self._frames.clear()
            self._shown = self._drawn(up)
        if len(self._frames) < VARIANTS:
            grain = self._random.standard_normal(self._shown.shape, np.float32) * NOISE
            picture = np.clip(self._shown + grain, 0, 255).astype(np.uint8)
            packed = cv2.imencode(".jpg", picture, [cv2.IMWRITE_JPEG_QUALITY, QUALITY])[1]
            self._frames.appendleft(packed.tobytes())
        else:
            self._frames.rotate(1)
        return self._frames[0]

    def _background(self) -> NDArray[np.float32]:
        image = np.full((self._size[1], self._size[0]), 18, np.uint8)
        cv2.fillPoly(image, [np.array(self._corners, np.int32)], 38)
        for x, _ in self._places.values():
            cv2.ellipse(image, (round(float(x)), 62), (15, 24), 0, 0, 360, 60, -1)
        return cv2.GaussianBlur(image, (0, 0), 1.5).astype(np.float32)

    def _drawn(self, up: tuple[tuple[str, str], ...]) -> NDArray[np.float32]:
        image = self._still.copy()
        for person, letter in up:
            moved = self._places[person] + self._random.uniform(-3, 3, 2)
            if letter:
                self._draw_strips(image, moved, FIRST_STRIPS + LETTERS.index(letter))
                continue
            turned = np.radians(self._random.uniform(-12, 12) + np.array((-90, 30, 150)))
            corners = np.stack((np.cos(turned), np.sin(turned)), 1) * SIGN / np.sqrt(3) + moved
            outline = np.round(corners * 16).astype(np.int32)
            cv2.fillPoly(image, [outline], 225.0, cv2.LINE_AA, 4)
        return np.asarray(cv2.GaussianBlur(image, (0, 0), 0.7), np.float32)

    def _draw_strips(self, image: NDArray[np.float32], place: Any, count: int) -> None:
        """Draw a card with strips one above the other, a little tilted."""
        tilt = np.tan(np.radians(self._random.uniform(-4, 4)))
        for number in range(count):
            y = place[1] + (number - (count - 1) / 2) * STRIP_PITCH
            x = place[0] + tilt * (place[1] - y)
            half = STRIP[0] / 2, STRIP[1] / 2
            corners = [
                (x + a * half[0], y + a * half[0] * tilt + b * half[1])
                for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))
            ]
            outline = np.round(np.array(corners) * 16).astype(np.int32)
            cv2.fillPoly(image, [outline], 225.0, cv2.LINE_AA, 4)
