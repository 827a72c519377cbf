"""Rectifies a card's grid: refines its plane on the crossings of the grid lines."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from tangy_hw.perception.cards.card_detection import Sighting, project
from tangy_profiles.card_face import CardLayout
from tangy_profiles.card_picture import draw_face

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Picture = NDArray[Any]
    Real = NDArray[Any]
    Plane = NDArray[Any]

SIDE = 32  # pixels of a rectified cell
RIM = 20  # pixels around the grid
PATCH = 9  # half side of the template of a crossing, in pixels
MATCHES = 0.5  # minimum correlation of a crossing with its print
FEWEST = 12  # crossings that must match


@dataclass(frozen=True)
class RectifiedGrid:
    """A rectified grid, `SIDE` pixels per cell, with a rim.

    `scale` is image pixels per rectified pixel, `crossings` the correlation of each crossing with
    its print, -1 to 1, and `matched` the number of inliers.
    """

    picture: Picture
    expected: Picture
    scale: float
    crossings: Real
    matched: int
    plane: Plane


@lru_cache(maxsize=64)
def expected_grid(face: CardLayout, card: int, seed: int) -> Picture:
    """Return the expected image of a card's rectified grid: (rows, columns), grey."""
    import cv2

    drawn = draw_face(face, card, seed, "", SIDE / face.cell)
    width, height = _size(face)
    plane = _to_flat(face)
    scale = SIDE / face.cell
    plane = plane.copy()
    plane[:, :2] /= scale
    return cv2.warpPerspective(
        drawn, plane, (width, height), flags=cv2.INTER_LINEAR, borderValue=255.0
    )


def _size(face: CardLayout) -> tuple[int, int]:
    return len(face.deck.columns) * SIDE + 2 * RIM, face.deck.rows * SIDE + 2 * RIM


def _to_flat(face: CardLayout) -> Plane:
    """Return the transformation from mm on the card to rectified pixels."""
    import numpy as np

    scale = SIDE / face.cell
    return np.array(
        [
            [scale, 0, RIM - face.grid.left * scale],
            [0, scale, RIM - face.grid.top * scale],
            [0, 0, 1],
        ]
    )


def flatten(picture: Picture, seen: Sighting, face: CardLayout, seed: int) -> RectifiedGrid | None:
    """Return a card's rectified grid (rows, columns, 3); None if too few crossings match."""
    import cv2
    import numpy as np

    expected = expected_grid(face, seen.card, seed)
    corners = _corners(face)
    plane, matched = seen.plane, 0
    scores: Real = np.zeros(len(corners), np.float32)
    flat, scale = _warped(picture, plane, face)
    reach = 8 if seen.tags < 4 else 5
    for step in range(3):
        grey = cv2.cvtColor(flat, cv2.COLOR_BGR2GRAY)
        there, scores = _found(grey.astype(np.uint8), _softened(expected, scale), corners, reach)
        good = scores >= MATCHES
        if good.sum() < FEWEST:
            return None
        correction, inside = cv2.findHomography(
            corners[good].astype(np.float32), there[good], cv2.RANSAC, 1.5
        )
        if correction is None:
            return None
        matched = int(inside.sum())
        if matched < FEWEST:
            return None
        to_flat = _to_flat(face)
        plane = plane @ np.linalg.inv(to_flat) @ correction @ to_flat
        flat, scale = _warped(picture, plane, face)
        moved = float(np.abs(project(correction, corners) - corners).max())
        if moved < 0.5 or (step and moved < 1):
            break
        reach = 4
    return RectifiedGrid(flat, expected, scale, scores, matched, plane)


def _corners(face: CardLayout) -> Plane:
    import numpy as np

    return np.array(
        [
            (RIM + column * SIDE, RIM + row * SIDE)
            for row in range(face.deck.rows + 1)
            for column in range(len(face.deck.columns) + 1)
        ],
        float,
    )


def _warped(picture: Picture, plane: Plane, face: CardLayout) -> tuple[Picture, float]:
    """Rectify the grid; return it and the number of image pixels per rectified pixel."""
    import cv2
    import numpy as np

    back = plane @ np.linalg.inv(_to_flat(face))
    width, height = _size(face)
    ends = project(back, np.array([(0, 0), (width, 0), (width, height), (0, height)], float))
    area = float(cv2.contourArea(ends.astype(np.float32)))
    scale = max(1e-3, area / (width * height)) ** 0.5
    flags = cv2.WARP_INVERSE_MAP | cv2.INTER_LINEAR
    if scale <= 1.4:
        return cv2.warpPerspective(picture, back, (width, height), flags=flags), scale
    fine = int(np.ceil(min(scale, 8.0)))
    smaller = np.diag([1 / fine, 1 / fine, 1.0])
    smaller[:2, 2] = 0.5 / fine - 0.5
    large = cv2.warpPerspective(picture, back @ smaller, (width * fine, height * fine), flags=flags)
    return cv2.resize(large, (width, height), interpolation=cv2.INTER_AREA), scale


def _softened(expected: Picture, scale: float) -> Picture:
    """Blur the print as much as an image of this scale does."""
    import cv2

    sigma = min(2.5, 0.55 / scale)
    return cv2.GaussianBlur(expected, (0, 0), sigma).astype("uint8")


def _found(grey: Picture, expected: Picture, corners: Plane, reach: int) -> tuple[Real, Real]:
    """Find each crossing near its expected place; return the places, and the correlations."""
    import cv2
    import numpy as np

    there = np.zeros((len(corners), 2), np.float32)
    scores = np.zeros(len(corners), np.float32)
    height, width = grey.shape
    for place, (x, y) in enumerate(corners.astype(int)):
        print_ = expected[y - PATCH : y + PATCH + 1, x - PATCH : x + PATCH + 1]
        left, top = max(0, x - PATCH - reach), max(0, y - PATCH - reach)
        right, bottom = min(width, x + PATCH + reach + 1), min(height, y + PATCH + reach + 1)
        match = cv2.matchTemplate(grey[top:bottom, left:right], print_, cv2.TM_CCOEFF_NORMED)
        _, best, _, (u, v) = cv2.minMaxLoc(match)
        du = _peak(match[v, u - 1 : u + 2]) if 0 < u < match.shape[1] - 1 else 0.0
        dv = _peak(match[v - 1 : v + 2, u]) if 0 < v < match.shape[0] - 1 else 0.0
        there[place] = left + u + PATCH + du, top + v + PATCH + dv
        scores[place] = best
    return there, scores


def _peak(three: Real) -> float:
    """Return the peak of a parabola through three values, relative to the middle one."""
    bend = float(three[0] - 2 * three[1] + three[2])
    if bend > -1e-6:
        return 0.0
    return max(-0.5, min(0.5, float(three[0] - three[2]) / (2 * bend)))
