"""Card reader as in the paper, only for comparison: texture features, Hough lines and red blobs.

Texture features (SIFT; SURF is no longer available) match the image with the faces of all cards,
which gives the card and its plane; Hough lines give the grid; red cells are chips. It cannot report
uncertainty.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

from tangy_hw.perception.cards.reader import NO_TAGS, CardReader, CardReading
from tangy_profiles.card_face import HEIGHT, LAST_CARD, USUAL_SEED, WIDTH
from tangy_profiles.card_picture import draw_face
from tangy_profiles.cards import Deck

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Picture = NDArray[Any]
    Plane = NDArray[Any]

SCALE = 4.0  # pixels per mm of the reference faces
FEATURES = 400  # of each face
FEWEST = 10  # inliers of a homography
RED = 0.15  # share of a cell that must be red


class PaperReader:
    """Reads cards of one deck as the paper did."""

    def __init__(self, deck: Deck, title: str, deck_seed: int = USUAL_SEED) -> None:
        self._reader = CardReader(deck, deck_seed)
        self._title = title

    def read(self, picture: Picture) -> CardReading:
        """Read the card in an image (BGR)."""
        found = self._identified(picture)
        if found is None:
            return self._reader.nothing(NO_TAGS.replace("card", "known texture"))
        card, plane = found
        return self._marks(card, self._straight(picture, plane))

    @cached_property
    def _faces(self) -> tuple[Any, Any, Any]:
        """Matcher of all faces, card of each feature, and its position in mm."""
        import cv2
        import numpy as np

        finder = cv2.SIFT.create(FEATURES)
        descriptors, cards, places = [], [], []
        for card in range(1, LAST_CARD + 1):
            face = draw_face(self._reader.face, card, self._reader.deck_seed, self._title, SCALE)
            points, described = finder.detectAndCompute(face, None)
            descriptors.append(described)
            cards += [card] * len(points)
            places += [(p.pt[0] / SCALE, p.pt[1] / SCALE) for p in points]
        matcher = cv2.FlannBasedMatcher({"algorithm": 1, "trees": 4}, {"checks": 48})
        matcher.add([np.vstack(descriptors)])
        matcher.train()
        return matcher, np.array(cards), np.array(places, np.float32)

    def _identified(self, picture: Picture) -> tuple[int, Plane] | None:
        import cv2
        import numpy as np

        matcher, cards, places = self._faces
        grey = cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY)
        points, described = cv2.SIFT.create(1500).detectAndCompute(grey, None)
        if described is None or len(points) < FEWEST:
            return None
        there = np.array([p.pt for p in points], np.float32)
        nearest = [match[0] for match in matcher.knnMatch(described, k=1) if match]
        best: tuple[int, int, Plane] | None = None
        votes = np.bincount([cards[m.trainIdx] for m in nearest], minlength=LAST_CARD + 1)
        for card in votes.argsort()[::-1][:3]:
            mine = [m for m in nearest if cards[m.trainIdx] == card]
            if len(mine) < FEWEST:
                continue
            here = places[[m.trainIdx for m in mine]]
            plane, inside = cv2.findHomography(
                here, there[[m.queryIdx for m in mine]], cv2.RANSAC, 3.0
            )
            if plane is not None and (best is None or int(inside.sum()) > best[0]):
                best = int(inside.sum()), int(card), plane
        return None if best is None or best[0] < FEWEST else (best[1], best[2])

    def _straight(self, picture: Picture, plane: Plane) -> Picture:
        import cv2
        import numpy as np

        back = plane @ np.diag([1 / SCALE, 1 / SCALE, 1.0])
        size = round(WIDTH * SCALE), round(HEIGHT * SCALE)
        return cv2.warpPerspective(
            picture, back, size, flags=cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
        )

    def _marks(self, card: int, straight: Picture) -> CardReading:
        import cv2
        import numpy as np

        deck, face = self._reader.deck, self._reader.face
        grey = cv2.cvtColor(straight, cv2.COLOR_BGR2GRAY)
        lines = cv2.HoughLines(cv2.Canny(grey, 50, 150), 1, np.pi / 360, 120)
        found = np.empty((0, 2)) if lines is None else np.array(lines).reshape(-1, 2)
        upright = np.abs(found[(found[:, 1] < 0.05) | (found[:, 1] > np.pi - 0.05), 0])
        level = np.abs(found[np.abs(found[:, 1] - np.pi / 2) < 0.05, 0])
        x = _evenly(upright, face.grid.left * SCALE, face.cell * SCALE, len(deck.columns))
        y = _evenly(level, face.grid.top * SCALE, face.cell * SCALE, deck.rows)
        hue, strong, bright = cv2.split(cv2.cvtColor(straight, cv2.COLOR_BGR2HSV))
        red = ((hue < 10) | (hue > 170)) & (strong > 100) & (bright > 50)
        marked, side = deck.free, face.cell * SCALE
        for cell in range(deck.rows * len(deck.columns)):
            row, column = divmod(cell, len(deck.columns))
            left, top = round(x + column * side), round(y + row * side)
            part = red[top : round(top + side), left : round(left + side)]
            marked |= int(part.size > 0 and part.mean() > RED) << cell
        cells = tuple(float(marked >> c & 1) for c in range(deck.rows * len(deck.columns)))
        return CardReading(card, marked, 0, 1.0, cells, cards=(card,))


def _evenly(lines: Plane, start: float, side: float, count: int) -> float:
    """Return the start of a regular grid that best fits the found lines."""
    import numpy as np

    if not len(lines):
        return start
    shifts = np.arange(-0.4 * side, 0.4 * side, 1.0)
    wanted = start + side * np.arange(count + 1)
    off = np.abs(wanted[None, :, None] + shifts[:, None, None] - lines[None, None]).min(2)
    near = (off < 3).sum(1) - 1e-3 * np.abs(shifts)
    return float(start + shifts[near.argmax()])
