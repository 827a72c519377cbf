"""Finds answer signs in an infrared picture: bright strips one above the other, from A to D.

A sign has two strips for A, and one more for each letter that follows. People hold up a card with
strips of shining tape. A single strip is no sign: it may be the edge of something.
"""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Callable, Iterable
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

from tangy_hw.perception.requests.triangles import ahead_of_background

if TYPE_CHECKING:
    from tangy_hw.drivers.camera_look import Image

LETTERS = "abcd"
FEWEST = 2
"""The strips of the first letter; each letter has one more."""
BRIGHTER = 70  # than what is behind it, of 255
WIDE = (8, 60)  # pixels of a strip
THIN = 0.7  # how high a strip is at most, as a share of how wide it is
FULL = 0.7  # the share of its box that a strip fills at least
BESIDE = 0.4  # how far the next strip may be to the side, as a share of its width
ALIKE = 0.6  # the narrowest strip of a sign, as a share of the widest
GAP = 2.2  # from the middle of one strip to that of the next, in heights: at least this less 1
MOST_GAP = 3.6
OF, BEGINS, ENDS = 5, 3, 1
"""Of the last five pictures a letter must be in three; in one at most, and it is down again."""


class AnswerSign(NamedTuple):
    """A sign in the picture: its middle in pixels, its letter, and how sure it is (0 to 1)."""

    x: float
    y: float
    letter: str
    sure: float


class _Strip(NamedTuple):
    x: float
    y: float
    wide: float
    high: float


def find_answer_signs(image: Image) -> list[AnswerSign]:
    """Return the answer signs in a picture (grey, or BGR), from left to right."""
    left = sorted(_strips(image), key=lambda one: one.y)
    found: list[AnswerSign] = []
    while left:
        column = [left.pop(0)]
        for strip in tuple(left):
            if _follows(column[-1], strip):
                column.append(strip)
                left.remove(strip)
        place = len(column) - FEWEST
        if 0 <= place < len(LETTERS):
            found.append(_sign(column, LETTERS[place]))
    return sorted(found)


def _strips(image: Image) -> Iterable[_Strip]:
    import cv2

    bright = cv2.threshold(ahead_of_background(image), BRIGHTER, 255, cv2.THRESH_BINARY)[1]
    _, _, boxes, middles = cv2.connectedComponentsWithStats(bright, connectivity=4)
    for (_, _, wide, high, area), (x, y) in zip(boxes[1:], middles[1:], strict=True):
        fits = WIDE[0] <= wide <= WIDE[1] and high <= THIN * wide
        if fits and area >= FULL * wide * high:
            yield _Strip(float(x), float(y), float(wide), float(high))


def _follows(above: _Strip, below: _Strip) -> bool:
    """Say whether a strip can be the next one of the same sign."""
    widest = max(above.wide, below.wide)
    apart = (below.y - above.y) / max(1.0, (above.high + below.high) / 2)
    return (
        abs(below.x - above.x) <= BESIDE * widest
        and min(above.wide, below.wide) >= ALIKE * widest
        and GAP - 1 <= apart <= MOST_GAP
    )


def _sign(column: list[_Strip], letter: str) -> AnswerSign:
    """Return a sign; it is as sure as its strips are alike and evenly apart."""
    count = len(column)
    widths = [one.wide for one in column]
    gaps = [b.y - a.y for a, b in pairwise(column)]
    even = min(min(widths) / max(widths), min(gaps) / max(gaps))
    x, y = (sum(values) / count for values in ([s.x for s in column], [s.y for s in column]))
    return AnswerSign(x, y, letter, round(max(0.0, min(1.0, 1.6 * even - 0.6)), 2))


class AnswerPersistence:
    """Hysteresis over pictures: a seat shows a letter that is in three of five of them."""

    def __init__(self, seat_at: Callable[[float, float], int]) -> None:
        """Take what says at which seat (from 1, 0: none) a pixel is."""
        self._seat_at = seat_at
        self._seen: dict[int, deque[tuple[str, float]]] = {}
        self.shown: dict[int, tuple[str, float]] = {}
        """Each seat that shows a letter, with the letter and how sure it is."""
        self.found: dict[int, str] = {}
        """The letters in the last picture alone, by seat."""

    def look(self, image: Image) -> dict[int, tuple[str, float]]:
        """Take the next picture; return the letter at each seat, with its probability."""
        found = {self._seat_at(one.x, one.y): one for one in find_answer_signs(image)}
        self.found = {seat: one.letter for seat, one in found.items() if seat}
        for seat in (found.keys() | self._seen.keys()) - {0}:
            one, last = found.get(seat), self._seen.setdefault(seat, deque(maxlen=OF))
            last.append(("", 0.0) if one is None else (one.letter, one.sure))
            letters = Counter(letter for letter, _ in last if letter)
            letter, times = next(iter(letters.most_common(1)), ("", 0))
            if times >= BEGINS:
                sure = sum(share for name, share in last if name == letter) / letters.total()
                self.shown[seat] = letter, sure
            elif times <= ENDS:
                self.shown.pop(seat, None)
        return self.shown
