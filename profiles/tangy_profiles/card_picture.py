"""The picture of a card, for the screen, the simulated camera and the reader."""

from __future__ import annotations

from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tangy_profiles.card_face import HEIGHT, TAGS, WIDTH, Box, CardLayout, PrintedText, tag_ids
from tangy_profiles.errors import TangyError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Picture = NDArray[np.uint8]

CAPITALS = 0.729  # height of a capital letter in DejaVu Sans Bold, relative to the font size
FINE = 4  # factor of supersampling


@cache
def font_file() -> Path:
    """Find the font of the cards, DejaVu Sans Bold, which comes with matplotlib.

    Raises:
        TangyError: it is missing.
    """
    found = find_spec("matplotlib")
    if found is not None and found.origin is not None:
        path = Path(found.origin).parent / "mpl-data" / "fonts" / "ttf" / "DejaVuSans-Bold.ttf"
        if path.is_file():
            return path
    raise TangyError("The typeface of the cards is missing: install matplotlib again.")


@cache
def tag_modules(tag: int) -> tuple[tuple[bool, ...], ...]:
    """Return the modules of a tag, row by row; True is white."""
    import cv2

    dictionary = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_4X4_1000)
    picture = cv2.aruco.generateImageMarker(dictionary, tag, 6)
    return tuple(tuple(bool(module) for module in row) for row in picture)


def white_modules(card: int) -> list[Box]:
    """Return the white modules of a card's tags, in mm, to draw on black tags."""
    white: list[Box] = []
    for tag, place in zip(tag_ids(card), TAGS, strict=True):
        side = (place.right - place.left) / 6
        for row, modules in enumerate(tag_modules(tag)):
            for column, module in enumerate(modules):
                if module:
                    x, y = place.left + column * side, place.top + row * side
                    white.append(Box(x, y, x + side, y + side))
    return white


def draw_face(face: CardLayout, card: int, seed: int, title: str, scale: float) -> Picture:
    """Draw a card in grey, with `scale` pixels per mm."""
    from PIL import Image, ImageDraw

    size = round(WIDTH * scale), round(HEIGHT * scale)
    large = FINE * scale
    picture = Image.new("L", (FINE * size[0], FINE * size[1]), 255)
    draw = ImageDraw.Draw(picture)
    for box in (*TAGS, *face.lines()):
        _fill(draw, box, large, 0)
    for box in white_modules(card):
        _fill(draw, box, large, 255)
    for words in face.words(card, seed, title):
        _write(draw, words, large)
    return _array(picture.resize(size, Image.Resampling.BOX))


def draw_number(face: CardLayout, number: int, side: int) -> Picture:
    """Draw the number of a cell, without lines, as a square of `side` pixels in grey."""
    from PIL import Image, ImageDraw

    picture = Image.new("L", (FINE * side, FINE * side), 255)
    words = PrintedText(str(number), face.cell / 2, face.cell / 2, face.number_high)
    _write(ImageDraw.Draw(picture), words, FINE * side / face.cell)
    return _array(picture.resize((side, side), Image.Resampling.BOX))


def _fill(draw: Any, box: Box, scale: float, grey: int) -> None:
    left, top = round(box.left * scale), round(box.top * scale)
    right, bottom = round(box.right * scale), round(box.bottom * scale)
    draw.rectangle((left, top, right - 1, bottom - 1), fill=grey)


def _write(draw: Any, words: PrintedText, scale: float) -> None:
    font = _font(round(words.high / CAPITALS * scale))
    place = words.x * scale, (words.y + words.high / 2) * scale
    draw.text(place, words.text, font=font, fill=0, anchor="ms")


@cache
def _font(size: int) -> Any:
    from PIL import ImageFont

    return ImageFont.truetype(str(font_file()), max(1, size))


def _array(picture: Any) -> Picture:
    import numpy as np

    return np.asarray(picture, dtype=np.uint8)
