"""The corner tags of cards in a picture, and whether what looks like one is printed as one."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Any

from tangy_profiles.card_face import LAST_CARD, TAGS

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Picture = NDArray[Any]
    Real = NDArray[Any]

SMALL = 24.0  # pixels to the side of a tag, below which a quick look may miss it
LARGER = 2.0  # how many times larger a part of a picture is looked at when tags are missing

QUICK, THOROUGH, STEP = (11, 11), (7, 21), 14
"""Sides of the windows over which a picture is made black and white, in pixels."""

MODULES, RIM = 6, 2  # to a side of a tag, its black ones among them; and of paper around it
FINE = 4  # pixels of a module that is looked at
SMALLEST, PALEST = 10.0, 15.0
"""The side in pixels and the contrast in grey levels that a tag by itself has at least."""
APART, PAPER = 0.15, 0.55
"""How far apart its darkest white and its lightest black module are at least, and how light the
paper around it is, in its contrast. Measured: of 240 tags 1 % had less than .1 and none less than
.67; of what 82 pictures without cards had of such patterns, none had more than .07."""


@dataclass(frozen=True, eq=False)
class Tag:
    """A tag in a picture: of which card, in which of its corners, and its own four corners there.

    Corners are counted clockwise from the top left; those in the picture are pixels.
    """

    card: int
    corner: int
    corners: Real

    @property
    def side(self) -> float:
        """The side of a square as large as it, in pixels."""
        import cv2
        import numpy as np

        return float(np.sqrt(cv2.contourArea(self.corners.astype(np.float32))))

    def is_at(self, other: Tag) -> bool:
        """Say whether it is the same tag as another, at the same place."""
        apart = self.corners.mean(0) - other.corners.mean(0)
        same = (self.card, self.corner) == (other.card, other.corner)
        return same and float(abs(apart).max()) < 0.5 * max(self.side, other.side)


def tags_in(grey: Picture) -> list[Tag]:
    """Return the tags in a grey picture: after a quick look, or a thorough one if any are small."""
    tags = joined([], _detected(grey, QUICK))
    if not tags or min(tag.side for tag in tags) < SMALL:
        tags = joined(tags, _detected(grey, THOROUGH))
    return tags


def tags_enlarged(grey: Picture, box: tuple[int, int, int, int]) -> list[Tag]:
    """Return the tags in a box (left, top, right, bottom) of a picture, seen through a glass."""
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
    """Return all of these tags, each of them once."""
    kept = list(tags)
    for tag in more:
        if not any(tag.is_at(one) for one in kept):
            kept.append(tag)
    return kept


def is_printed(grey: Picture, tag: Tag) -> bool:
    """Say whether a tag (corners (4, 2) in px) is black on white paper, every module of it.

    In a picture full of detail some pattern may happen to be read as a tag.
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
    """Return the tags of cards that the detector finds, copies and all."""
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
