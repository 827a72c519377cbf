"""Detects the cards in an image, and the plane of each."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from tangy_hw.perception.cards.tags import Tag, is_printed, joined, tags_enlarged, tags_in
from tangy_profiles.card_face import HEIGHT, TAGS, WIDTH

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Picture = NDArray[Any]
    Plane = NDArray[Any]

NEAR_ENOUGH = 4.0  # mm that a tag's corner may be off the plane through the card's other tags
ELSEWHERE = 1.5  # tag sides off its place on a card, from which it belongs to a copy of the card
MOST_LARGER = 1_000_000  # pixels of an image up to which all of it is enlarged


@dataclass(frozen=True)
class Sighting:
    """A possible card: its number, the number of detected tags, and its plane.

    `plane` is the homography from mm on the card to pixels. `sure` says whether there is a card,
    legible or not: several tags lie on one plane, or the only one looks printed.
    """

    card: int
    tags: int
    plane: Plane
    sure: bool = True

    @property
    def cell_area(self) -> float:
        """Pixels that a square mm in the middle of the card covers."""
        import numpy as np

        x, y = WIDTH / 2, HEIGHT / 2
        corners = project(self.plane, np.array([(x, y), (x + 1, y), (x, y + 1)], float))
        (a, b), (c, d) = corners[1] - corners[0], corners[2] - corners[0]
        return float(abs(a * d - b * c))


def project(plane: Plane, points: NDArray[Any]) -> NDArray[Any]:
    """Project points (n, 2) of the card into the image, in px."""
    import numpy as np

    seen = np.column_stack([points, np.ones(len(points))]) @ plane.T
    there: NDArray[Any] = seen[:, :2] / seen[:, 2:]
    return there


def find_cards(grey: Picture) -> list[Sighting]:
    """Find all cards in a grey image, the best first, without verifying them.

    Two copies of one card are two sightings.
    """
    tags = tags_in(grey)
    found = _sightings(grey, tags)
    if found and found[0].tags == len(TAGS):
        return found
    if found and found[0].tags > 1:  # the others are nearby
        box = _around(found[0], grey.shape)
    elif grey.size <= MOST_LARGER:
        box = (0, 0, grey.shape[1], grey.shape[0])
    else:
        return found
    return _sightings(grey, joined(tags, tags_enlarged(grey, box)))


def _sightings(grey: Picture, tags: list[Tag]) -> list[Sighting]:
    cards: dict[int, list[Tag]] = defaultdict(list)
    for tag in sorted(tags, key=lambda tag: -tag.side):
        cards[tag.card].append(tag)
    found = [seen for of_card in cards.values() for seen in _copies(grey, of_card)]
    return sorted(found, key=lambda seen: (-seen.tags, -seen.cell_area))


def _copies(grey: Picture, tags: list[Tag]) -> list[Sighting]:
    """Return the sightings of one card from its tags, the largest first: mostly one."""
    found: list[Sighting] = []
    left = tags
    while left:
        corners = {tag.corner: tag for tag in reversed(left)}  # largest of each corner
        laid = _through(corners)
        if laid is None:
            break
        plane, kept = laid
        sure = len(kept) > 1 or is_printed(grey, kept[0])
        found.append(Sighting(kept[0].card, len(kept), plane, sure))
        left = [tag for tag in left if tag not in kept and _is_elsewhere(tag, plane, kept)]
    return found


def _is_elsewhere(tag: Tag, plane: Plane, kept: list[Tag]) -> bool:
    """Return whether a tag cannot belong to the card on a plane through other tags."""
    if len(kept) == 1 and tag.corner != kept[0].corner:
        return False  # the plane is too uncertain
    place = project(plane, _on_card(tag.corner)).mean(0)
    off = float(abs(tag.corners.mean(0) - place).max())
    return off > ELSEWHERE * tag.side


def _on_card(corner: int) -> NDArray[Any]:
    """Return the positions of a tag's four corners on the card, in mm."""
    import numpy as np

    box = TAGS[corner]
    ends = [(box.left, box.top), (box.right, box.top)]
    return np.array([*ends, (box.right, box.bottom), (box.left, box.bottom)])


def _through(tags: dict[int, Tag]) -> tuple[Plane, list[Tag]] | None:
    """Fit a plane to the tags of a card, without outliers.

    Returns:
        The plane and its tags; None if there is none.
    """
    import cv2
    import numpy as np

    kept = dict(tags)
    while kept:
        here = np.vstack([_on_card(corner) for corner in kept])
        there = np.vstack([tag.corners for tag in kept.values()])
        back, _ = cv2.findHomography(there, here)
        if back is None or abs(np.linalg.det(back)) < 1e-12:
            return None
        off = np.abs(project(back.astype(float), there) - here).max(1).reshape(-1, 4).max(1)
        if off.max() <= NEAR_ENOUGH:
            plane = np.linalg.inv(back.astype(float))
            return plane / plane[2, 2], list(kept.values())
        if len(kept) == 2:  # either may be wrong; the smaller is less certain
            kept.pop(min(kept, key=lambda corner: kept[corner].side))
        else:
            kept.pop(_worst(kept))
    return None


def _worst(tags: dict[int, Tag]) -> int:
    """Return the tag without which the others fit best."""
    import cv2
    import numpy as np

    def without(corner: int) -> float:
        here = np.vstack([_on_card(other) for other in tags if other != corner])
        there = np.vstack([tag.corners for other, tag in tags.items() if other != corner])
        back, _ = cv2.findHomography(there, here)
        if back is None:
            return float("inf")
        return float(np.abs(project(back.astype(float), there) - here).max())

    return min(tags, key=without)


def _around(seen: Sighting, shape: tuple[int, ...]) -> tuple[int, int, int, int]:
    """Return the box of the image that a card should fill, with a margin."""
    import numpy as np

    ends = np.array([(-8, -8), (WIDTH + 8, -8), (WIDTH + 8, HEIGHT + 8), (-8, HEIGHT + 8)], float)
    there = project(seen.plane, ends)
    low = np.clip(np.nan_to_num(there.min(0)), 0, None).astype(int)
    high = np.clip(np.nan_to_num(there.max(0)) + 1, 0, (shape[1], shape[0])).astype(int)
    if high[0] - low[0] < 20 or high[1] - low[1] < 20:
        return 0, 0, shape[1], shape[0]
    return int(low[0]), int(low[1]), int(high[0]), int(high[1])
