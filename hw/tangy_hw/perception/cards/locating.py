"""Where cards are in a picture: their corner tags, and the plane that these lie on."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Any

from tangy_profiles.card_face import HEIGHT, LAST_CARD, TAGS, WIDTH

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Picture = NDArray[Any]
    Plane = NDArray[Any]

NEAR_ENOUGH = 4.0  # mm that a tag's corner may lie off the plane through the card's other tags
LARGER = 2.0  # how many times larger a picture is looked at when tags are missing
MOST_LARGER = 1_000_000  # pixels of such a larger picture's origin

QUICK, THOROUGH, STEP = (11, 11), (7, 21), 14
"""Sides of the windows over which a picture is made black and white, in pixels."""


@dataclass(frozen=True)
class Sighting:
    """A card that may be there: its number, how many of its tags were seen, and its plane.

    `plane` takes mm on the card to pixels of the picture.
    """

    card: int
    tags: int
    plane: Plane

    @property
    def cell_area(self) -> float:
        """The pixels that a square mm in the middle of the card covers."""
        import numpy as np

        x, y = WIDTH / 2, HEIGHT / 2
        corners = project(self.plane, np.array([(x, y), (x + 1, y), (x, y + 1)], float))
        (a, b), (c, d) = corners[1] - corners[0], corners[2] - corners[0]
        return float(abs(a * d - b * c))


def project(plane: Plane, points: NDArray[Any]) -> NDArray[Any]:
    """Return where points of the card are in the picture."""
    import numpy as np

    seen = np.column_stack([points, np.ones(len(points))]) @ plane.T
    there: NDArray[Any] = seen[:, :2] / seen[:, 2:]
    return there


def find_cards(grey: Picture) -> list[Sighting]:
    """Find the cards in a grey picture, the surest first; none of them is verified yet."""
    import cv2
    import numpy as np

    tags = _tags(grey, 1.0, QUICK)
    found = _sightings(tags)
    if found and found[0].tags == len(TAGS):
        return found
    if not found or found[0].tags < 2:
        for tag, corners in _tags(grey, 1.0, THOROUGH).items():
            tags.setdefault(tag, corners)
        found = _sightings(tags)
    if found and found[0].tags == len(TAGS):
        return found
    if found and found[0].tags > 1:  # the others are near
        box = _around(found[0], grey.shape)
    elif grey.size <= MOST_LARGER:
        box = (0, 0, grey.shape[1], grey.shape[0])
    else:
        return found
    left, top, right, bottom = box
    part = grey[top:bottom, left:right]
    large = cv2.resize(part, None, fx=LARGER, fy=LARGER, interpolation=cv2.INTER_CUBIC)
    for tag, corners in _tags(large.astype(np.uint8), LARGER, THOROUGH).items():
        tags.setdefault(tag, corners + np.array([left, top]))
    return _sightings(tags)


def _tags(grey: Picture, scale: float, windows: tuple[int, int]) -> dict[int, NDArray[Any]]:
    """Return the corners of the tags in a picture; the largest where one is seen twice."""
    found: dict[int, NDArray[Any]] = {}
    corners, ids, _ = _detector(windows).detectMarkers(grey)
    for place, tag in enumerate(() if ids is None else ids.ravel()):
        seen = (corners[place][0] + 0.5) / scale - 0.5
        if tag not in found or _area(seen) > _area(found[int(tag)]):
            found[int(tag)] = seen.astype(float)
    return found


@cache
def _detector(windows: tuple[int, int]) -> Any:
    import cv2

    parameters = cv2.aruco.DetectorParameters()
    parameters.adaptiveThreshWinSizeMin, parameters.adaptiveThreshWinSizeMax = windows
    parameters.adaptiveThreshWinSizeStep = STEP
    parameters.minMarkerPerimeterRate = 0.02
    parameters.perspectiveRemovePixelPerCell = 6
    dictionary = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_4X4_1000)
    return cv2.aruco.ArucoDetector(dictionary, parameters)


def _area(corners: NDArray[Any]) -> float:
    import cv2
    import numpy as np

    return float(cv2.contourArea(corners.astype(np.float32)))


def _sightings(tags: dict[int, NDArray[Any]]) -> list[Sighting]:
    cards: dict[int, dict[int, NDArray[Any]]] = defaultdict(dict)
    for tag, corners in tags.items():
        if 1 <= tag // 4 <= LAST_CARD:
            cards[tag // 4][tag % 4] = corners
    found = [seen for card, corners in cards.items() for seen in [_through(card, corners)] if seen]
    return sorted(found, key=lambda seen: (-seen.tags, -seen.cell_area))


def _through(card: int, tags: dict[int, NDArray[Any]]) -> Sighting | None:
    """Lay a plane through the tags of a card, without those that do not lie on it."""
    import cv2
    import numpy as np

    on_card = {
        corner: np.array(
            [(b.left, b.top), (b.right, b.top), (b.right, b.bottom), (b.left, b.bottom)]
        )
        for corner, b in enumerate(TAGS)
    }
    kept = dict(tags)
    while kept:
        here = np.vstack([on_card[corner] for corner in kept])
        there = np.vstack([kept[corner] for corner in kept])
        back, _ = cv2.findHomography(there, here)
        if back is None or abs(np.linalg.det(back)) < 1e-12:
            return None
        off = np.abs(project(back.astype(float), there) - here).max(1).reshape(-1, 4).max(1)
        if off.max() <= NEAR_ENOUGH:
            plane = np.linalg.inv(back.astype(float))
            return Sighting(card, len(kept), plane / plane[2, 2])
        if len(kept) == 2:  # which of two is wrong cannot be seen: the smaller is less sure
            kept.pop(min(kept, key=lambda corner: _area(kept[corner])))
        else:
            kept.pop(_worst(kept, on_card))
    return None


def _worst(tags: dict[int, NDArray[Any]], on_card: dict[int, NDArray[Any]]) -> int:
    """Return the tag without which the others lie best on one plane."""
    import cv2
    import numpy as np

    def without(corner: int) -> float:
        here = np.vstack([on_card[other] for other in tags if other != corner])
        there = np.vstack([tags[other] for other in tags if other != corner])
        back, _ = cv2.findHomography(there, here)
        if back is None:
            return float("inf")
        return float(np.abs(project(back.astype(float), there) - here).max())

    return min(tags, key=without)


def _around(seen: Sighting, shape: tuple[int, ...]) -> tuple[int, int, int, int]:
    """Return the box of the picture that a card should fill, and a little more."""
    import numpy as np

    ends = np.array([(-8, -8), (WIDTH + 8, -8), (WIDTH + 8, HEIGHT + 8), (-8, HEIGHT + 8)], float)
    there = project(seen.plane, ends)
    low = np.clip(np.nan_to_num(there.min(0)), 0, None).astype(int)
    high = np.clip(np.nan_to_num(there.max(0)) + 1, 0, (shape[1], shape[0])).astype(int)
    if high[0] - low[0] < 20 or high[1] - low[1] < 20:
        return 0, 0, shape[1], shape[0]
    return int(low[0]), int(low[1]), int(high[0]), int(high[1])
