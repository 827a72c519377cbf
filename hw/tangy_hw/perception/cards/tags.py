"""Detects the corner tags of cards, and checks whether a detected pattern is a printed tag."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Any

from tangy_profiles.card_face import LAST_CARD, TAGS

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Picture = NDArray[Any]
    Real = NDArray[Any]

SMALL = 24.0  # pixels of a tag's side below which a quick search may miss it
LARGER = 2.0  # scale at which a part of an image is searched for missing tags

QUICK, THOROUGH, STEP = (11, 11), (7, 21), 14
"""Window sizes of the adaptive threshold, in pixels."""

MODULES, RIM = 6, 2  # modules per side of a tag with its black border; of the white margin
FINE = 4  # pixels per rectified module
SMALLEST, PALEST = 10.0, 15.0
"""Minimum side in pixels, and contrast in grey levels, of a single tag."""
APART, PAPER = 0.15, 0.55
"""Minimum gap between its darkest white and lightest black module, and brightness of the margin, in
units of its contrast. Measured: of 240 tags, 1 % had less than .1 and none less than .67; of such
patterns in 82 images without cards, none had more than .07."""


@dataclass(frozen=True, eq=False)
class Tag:
    """A tag in an image: its card, its corner of the card, and its own four corners.

    Corners are counted clockwise from the top left; `corners` (4, 2) are in pixels.
    """

    card: int
    corner: int
    corners: Real

    @property
    def side(self) -> float:
        """Side of a square of the same area, in pixels."""
        import cv2
        import numpy as np

        return float(np.sqrt(cv2.contourArea(self.corners.astype(np.float32))))

    def is_at(self, other: Tag) -> bool:
        """Return whether it is the same tag as another, at the same place."""
        apart = self.corners.mean(0) - other.corners.mean(0)
        same = (self.card, self.corner) == (other.card, other.corner)
        return same and float(abs(apart).max()) < 0.5 * max(self.side, other.side)


def tags_in(grey: Picture) -> list[Tag]:
    """Return the tags in a grey image; if a quick search finds none or small ones, search again."""
    tags = joined([], _detected(grey, QUICK))
    if not tags or min(tag.side for tag in tags) < SMALL:
        tags = joined(tags, _detected(grey, THOROUGH))
    return tags


def tags_enlarged(grey: Picture, box: tuple[int, int, int, int]) -> list[Tag]:
    """Return the tags in a box (left, top, right, bottom) of an image, after enlarging it."""
    import cv2
    import numpy as np

    left, top, right, bottom = box
    part = grey[top:bottom, left:right]
    large = cv2.resize(part, None, fx=LARGER, fy=LARGER, interpolation=cv2.INTER_CUBIC)
    return [
        Tag(tag.card, tag.corner, (tag.corners + 0.5) / LARGER - 0.5 + np.array([left, top]))
        for tag in _detected(large.astype(np.uint8), THOROUGH)
    ]


def joined(tags: list[Tag], more: list[Tag]) -> list[Tag]:
    """Return the union of two lists of tags, without duplicates."""
    kept = list(tags)
    for tag in more:
        if not any(tag.is_at(one) for one in kept):
            kept.append(tag)
    return kept


def is_printed(grey: Picture, tag: Tag) -> bool:
    """Return whether every module of a tag (corners (4, 2) in px) is clearly black or white.

    In an image full of detail, some pattern may be decoded as a tag by chance.
    """
    import cv2
    import numpy as np

    if tag.side < SMALLEST:
        return False
    low, high = RIM * FINE, (RIM + MODULES) * FINE
    whole = (MODULES + 2 * RIM) * FINE
    flat = np.array([(low, low), (high, low), (high, high), (low, high)], np.float32)
    plane = cv2.getPerspectiveTransform(tag.corners.astype(np.float32), flat)
    seen = cv2.warpPerspective(grey, plane, (whole, whole), borderMode=cv2.BORDER_REPLICATE)
    parts = seen.astype(np.float32).reshape(whole // FINE, FINE, whole // FINE, FINE)
    modules = parts[:, 1:-1, :, 1:-1].mean((1, 3))
    printed = modules[RIM:-RIM, RIM:-RIM]
    inside = printed[1:-1, 1:-1]
    rim = np.concatenate([printed[0], printed[-1], printed[1:-1, 0], printed[1:-1, -1]])
    white = inside > (inside.max() + rim.min()) / 2
    if not white.any():
        return False
    light, dark = inside[white], np.concatenate([rim, inside[~white]])
    contrast = float(light.mean() - dark.mean())
    around = modules[RIM - 1 : 1 - RIM, RIM - 1 : 1 - RIM]
    paper = np.concatenate([around[0], around[-1], around[1:-1, 0], around[1:-1, -1]])
    return bool(
        contrast >= PALEST
        and light.min() - dark.max() >= APART * contrast
        and np.percentile(paper, 25) - dark.mean() >= PAPER * contrast
    )


def _detected(grey: Picture, windows: tuple[int, int]) -> list[Tag]:
    """Return the tags that the detector finds, including copies."""
    found, ids, _ = _detector(windows).detectMarkers(grey)
    return [
        Tag(*divmod(int(tag), len(TAGS)), found[place][0].astype(float))
        for place, tag in enumerate(() if ids is None else ids.ravel())
        if 1 <= tag // len(TAGS) <= LAST_CARD
    ]


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
