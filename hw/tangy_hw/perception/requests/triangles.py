"""Finds upright shining triangles in an infrared image: the signs with which people ask.

A bright spot is enlarged, cut out at half of its maximum brightness, where its edge is at any blur,
and compared with its minimum enclosing triangle.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import acos, degrees, exp, hypot
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from tangy_hw.drivers.camera_look import Image

CLOSE = 80  # pixels per side of an enlarged spot
MARGIN = 5  # pixels around a spot
COARSE = 4  # scale factor of the smaller image for the background
BEHIND = 23  # pixels in it up to which an object is a spot
EDGE = 75  # percentile of a spot's surroundings that counts as background
MOST_SPOTS = 60  # per image; the largest ones


class Triangle(NamedTuple):
    """A triangle in the image: its centre and side length in pixels; its probability."""

    x: float
    y: float
    size: float
    sure: float


@dataclass(frozen=True, slots=True)
class TriangleLimits:
    """Limits of triangles; set by `tests/bench/requests.py --tune`.

    `brighter`: difference to the background, of 255. `size`: mean side length in pixels, minimum
    and maximum. `fills`: share of the enclosing triangle (a disc .60, a square .5); `solid`: share
    of the convex hull; `corner`: sharpest and bluntest corner in degrees; `three`: share of the
    outline within which three corners approximate it.
    """

    brighter: float = 36.0
    size: tuple[float, float] = (9.0, 75.0)
    fills: float = 0.77
    solid: float = 0.90
    corner: tuple[float, float] = (36.0, 84.0)
    three: float = 0.10


USUAL = TriangleLimits()


class Shape(NamedTuple):
    """Shape of a spot (see `TriangleLimits`), and its enclosing triangle in the image."""

    fills: float
    solid: float
    sharpest: float
    bluntest: float
    corners: int
    x: float
    y: float
    size: float


def find_triangles(image: Image, limits: TriangleLimits = USUAL) -> list[Triangle]:
    """Return the triangles in an image (grey, or BGR), the most probable first."""
    found = [
        Triangle(shape.x, shape.y, shape.size, sure)
        for shape in shapes(image, limits)
        if (sure := how_sure(shape, limits)) > 0
    ]
    return sorted(found, key=lambda one: -one.sure)


def how_sure(shape: Shape, limits: TriangleLimits = USUAL) -> float:
    """Return the probability that a shape is a triangle."""
    least, most = limits.corner
    if (
        shape.fills < limits.fills
        or shape.solid < limits.solid
        or not least <= shape.sharpest <= shape.bluntest <= most
        or shape.corners != 3
    ):
        return 0.0
    return 1 / (1 + exp(-40 * (shape.fills - limits.fills) - 0.5))


def ahead_of_background(image: Image) -> Any:
    """Return a grey picture (0 to 255): how much brighter each pixel is than its background."""
    import cv2
    import numpy as np

    grey = _grey(image)
    size = (max(1, grey.shape[1] // COARSE), max(1, grey.shape[0] // COARSE))
    coarse = cv2.resize(grey, size, interpolation=cv2.INTER_AREA)
    behind = cv2.morphologyEx(coarse, cv2.MORPH_OPEN, np.ones((BEHIND, BEHIND), np.uint8))
    return cv2.subtract(grey, cv2.resize(cv2.blur(behind, (5, 5)), grey.shape[::-1]))


def _grey(image: Image) -> Any:
    import cv2

    return image if image.ndim == 2 else cv2.cvtColor(image, cv2.COLOR_BGR2GRAY)


def shapes(image: Image, limits: TriangleLimits = USUAL) -> list[Shape]:
    """Return the shapes (px) of all bright spots of a sign's size in an image (grey, or BGR)."""
    import cv2
    import numpy as np

    grey, ahead = _grey(image), cv2.blur(ahead_of_background(image), (3, 3))
    bright = cv2.threshold(ahead, limits.brighter, 255, cv2.THRESH_BINARY)[1]
    _, _, boxes, _ = cv2.connectedComponentsWithStats(bright, connectivity=4)
    low, high = limits.size
    sides = boxes[1:, 2:4].max(axis=1) if len(boxes) > 1 else np.empty(0)
    kept = boxes[1:][(sides >= low) & (sides <= 2 * high)]  # with its reflection, or a halo
    kept = kept[np.argsort(-kept[:, 4])][:MOST_SPOTS]
    found = (_shape(grey, *(int(one) for one in box[:4])) for box in kept)
    return [shape for shape in found if shape is not None and low <= shape.size <= high]


def _shape(grey: Any, left: int, top: int, width: int, height: int) -> Shape | None:
    """Measure the shape of one spot."""
    import cv2
    import numpy as np

    x, y = max(0, left - MARGIN), max(0, top - MARGIN)
    part = grey[y : top + height + MARGIN, x : left + width + MARGIN]
    scale = max(2.0, CLOSE / max(part.shape))
    large = cv2.resize(part, None, fx=scale, fy=scale, interpolation=cv2.INTER_CUBIC)
    large = cv2.GaussianBlur(large, (0, 0), 0.6 * scale)
    edge = np.concatenate((large[0], large[-1], large[:, 0], large[:, -1]))
    half = (float(np.percentile(large, 97)) + float(np.percentile(edge, EDGE))) / 2
    mask = cv2.threshold(large, half, 255, cv2.THRESH_BINARY)[1]
    contours, _ = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
    if not contours:
        return None
    contour = max(contours, key=cv2.contourArea)
    area = cv2.contourArea(contour)
    around, triangle = cv2.minEnclosingTriangle(contour)
    hull = cv2.contourArea(cv2.convexHull(contour))
    if triangle is None or around <= 0 or hull <= 0 or area < 25:
        return None
    points = [(float(a), float(b)) for a, b in triangle.reshape(3, 2)]
    angles = _angles(points)
    if angles is None:
        return None
    three = cv2.approxPolyDP(contour, USUAL.three * cv2.arcLength(contour, True), True)
    sides = [hypot(points[one][0] - points[one - 1][0], points[one][1] - points[one - 1][1])
             for one in range(3)]  # fmt: skip
    return Shape(
        area / around,
        area / hull,
        min(angles),
        max(angles),
        len(three),
        x + (sum(point[0] for point in points) / 3 + 0.5) / scale - 0.5,
        y + (sum(point[1] for point in points) / 3 + 0.5) / scale - 0.5,
        sum(sides) / 3 / scale,
    )


def _angles(points: list[tuple[float, float]]) -> list[float] | None:
    """Return the angles of a triangle in degrees, or None if it is degenerate."""
    angles = []
    for here in range(3):
        a, b, c = points[here], points[here - 1], points[here - 2]
        first, second = (b[0] - a[0], b[1] - a[1]), (c[0] - a[0], c[1] - a[1])
        long = hypot(*first) * hypot(*second)
        if long < 1e-6:
            return None
        across = (first[0] * second[0] + first[1] * second[1]) / long
        angles.append(degrees(acos(max(-1.0, min(1.0, across)))))
    return angles
