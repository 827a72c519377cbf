"""Writes only the changed cells of a screen.

Textual paints whole widgets, some of them two or three times for one change, with the full
colours of every segment: 20 kB for a question of two lines. Over a slow link, the user waits for
that. `ScreenDiff` remembers the content of each cell, and turns an update into the shortest output
that makes the difference.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import lru_cache

from rich.cells import cell_len
from rich.color import ColorSystem
from rich.console import Console
from rich.style import Style
from textual._compositor import ChopsUpdate, CompositorUpdate, LayoutUpdate
from textual.strip import Strip

JOINED = 5
"""The most unchanged cells between changed ones that are rewritten: moving the cursor costs as
much."""

Cell = tuple[str, str]
"""A cell's text and SGR codes; the text of the second half of a wide character is ""."""

UNKNOWN: Cell = ("", "unknown")

_COLOURS = {
    "standard": ColorSystem.STANDARD,
    "256": ColorSystem.EIGHT_BIT,
    "truecolor": ColorSystem.TRUECOLOR,
}

_OFF = {"1": "22", "2": "22", "3": "23", "4": "24", "5": "25", "7": "27", "8": "28", "9": "29"}
"""The SGR codes that reset attributes."""

_LINES_AND_SWAPS = frozenset({"4", "7", "9", "21", "53"})
"""SGR codes that are visible on an empty cell."""


class TextUpdate(CompositorUpdate):
    """An update that is already text."""

    def __init__(self, text: str) -> None:
        self._text = text

    def render_segments(self, console: Console) -> str:
        """Return the text."""
        return self._text


class ScreenDiff:
    """The content of the terminal, cell by cell."""

    def __init__(self) -> None:
        self._rows: dict[int, list[Cell]] = {}

    def forget(self) -> None:
        """Forget the content: other output may have changed it."""
        self._rows.clear()

    def difference(self, update: LayoutUpdate | ChopsUpdate, console: Console) -> str:
        """Return the output that makes the terminal show an update; "" if it does already.

        The output begins and ends with the default colours, and may leave the cursor anywhere.
        """
        colours = _COLOURS.get(console.color_system or "", ColorSystem.TRUECOLOR)
        pen = _Pen()
        for y, x, strip in _placed(update):
            self._put(pen, y, x, _cells_of(strip, colours))
        return pen.text()

    def _put(self, pen: _Pen, y: int, x: int, cells: list[Cell]) -> None:
        """Write the cells of row `y` from column `x` on that differ from the screen."""
        row = self._rows.setdefault(y, [])
        end = x + len(cells)
        if row[x:end] == cells:  # the most frequent case
            return
        if len(row) < end:
            row += [UNKNOWN] * (end - len(row))
        changed = [column for column in range(x, end) if row[column] != cells[column - x]]
        if x and _is_second_half(row[x]) and not _is_second_half(cells[0]):
            row[x - 1] = UNKNOWN  # a wide character loses its second half
        if end < len(row) and _is_second_half(row[end]):
            row[end] = UNKNOWN  # or its first
        row[x:end] = cells
        for first, after in _runs(changed, row):
            while first > x and _is_second_half(row[first]):
                first -= 1  # write a wide character from its first half
            pen.write(y, first, row[first:after])


class _Pen:
    """Writes cells with the fewest cursor movements and changes of colour."""

    def __init__(self) -> None:
        self._parts: list[str] = []
        self._codes = ""
        self._at: tuple[int, int] | None = None

    def write(self, y: int, x: int, cells: Sequence[Cell]) -> None:
        """Write cells in row `y` from column `x` on."""
        for column, (shown, codes) in enumerate(cells, x):
            if not shown:  # the second half of a wide character
                self._at = None
                continue
            if self._at != (y, column):
                self._move(y, column)
            if codes != self._codes and not (shown == " " and _blank(self._codes) == codes):
                self._parts.append(_change(self._codes, codes))
                self._codes = codes
            self._parts.append(shown)
            # Terminals disagree on the width of clusters: position the cursor again afterwards.
            self._at = (y, column + 1) if len(shown) == 1 else None

    def _move(self, y: int, x: int) -> None:
        if self._at is not None and self._at[0] == y and x > self._at[1]:
            self._parts.append(f"\x1b[{x - self._at[1]}C")
        else:
            self._parts.append(f"\x1b[{y + 1};{x + 1}H")

    def text(self) -> str:
        """Return the whole output, with the default colours at its end."""
        return "".join(self._parts) + ("\x1b[m" if self._codes else "")


def _placed(update: LayoutUpdate | ChopsUpdate) -> Iterator[tuple[int, int, Strip]]:
    """Yield row, column and content of each part of an update."""
    if isinstance(update, LayoutUpdate):
        for y, line in enumerate(update.strips, update.region.y):
            x = update.region.x
            for strip in line:
                yield y, x, strip
                x += strip.cell_length
        return
    for y, begin, after in update.spans:
        for end, (x, piece) in zip(update.chop_ends[y], update.chops[y].items(), strict=False):
            if piece is None or x > after or end <= begin:
                continue
            yield y, x, piece if begin <= x and end <= after else piece.crop(0, min(end, after) - x)


def _cells_of(strip: Strip, colours: ColorSystem) -> list[Cell]:
    cells: list[Cell] = []
    for text, style, control in strip:
        if not control:
            cells += _segment_cells(text, "" if style is None else _codes(style, colours))
    return cells


@lru_cache(8192)
def _codes(style: Style, colours: ColorSystem) -> str:
    return Strip.render_ansi(style, colours)


@lru_cache(8192)
def _segment_cells(text: str, codes: str) -> tuple[Cell, ...]:
    width = cell_len(text)
    blank = (" ", _blank(codes))
    if text.isascii() and width == len(text):
        return tuple(blank if character == " " else (character, codes) for character in text)
    cells: list[Cell] = []
    for character in text:
        if character == " ":
            cells.append(blank)
        elif wide := cell_len(character):
            cells += [(character, codes)] + [("", codes)] * (wide - 1)
        elif cells:
            shown = len(cells) - 1
            while not cells[shown][0]:
                shown -= 1
            cells[shown] = (cells[shown][0] + character, codes)
    if len(cells) != width:  # a cluster is written as a whole
        cells = [(text, codes)] + [("", codes)] * (width - 1)
    return tuple(cells[:width])


def _is_second_half(cell: Cell) -> bool:
    return not cell[0] and cell != UNKNOWN


def _runs(changed: Sequence[int], row: Sequence[Cell]) -> Iterator[tuple[int, int]]:
    """Yield the first column and the one after the last of each run to write."""
    first = last = changed[0]
    for column in changed[1:]:
        between = row[last + 1 : column]
        alike = (row[last][1], _blank(row[last][1]))
        if len(between) > JOINED or any(cell[1] not in alike for cell in between):
            yield first, last + 1
            first = column
        last = column
    yield first, last + 1


@lru_cache(8192)
def _blank(codes: str) -> str:
    """Return the SGR codes that are visible on an empty cell: its background."""
    attributes, _, paper = _parsed(codes)
    return codes if attributes & _LINES_AND_SWAPS else paper


@lru_cache(8192)
def _change(before: str, after: str) -> str:
    """Return the shortest sequence from one set of SGR codes to another."""
    if not after:
        return "\x1b[m"
    whole = f"\x1b[0;{after}m" if before else f"\x1b[{after}m"
    (had, ink, paper), (has, new_ink, new_paper) = _parsed(before), _parsed(after)
    codes: list[str] = []
    if gone := had - has:
        if not all(code in _OFF for code in gone):
            return whole
        codes += sorted({_OFF[code] for code in gone})
        if "22" in codes:
            had -= {"1", "2"}
    codes += sorted(has - had)
    if ink != new_ink:
        codes.append(new_ink or "39")
    if paper != new_paper:
        codes.append(new_paper or "49")
    if not codes:  # the same colours, written in another way
        return ""
    change = f"\x1b[{';'.join(codes)}m"
    return change if len(change) < len(whole) else whole


@lru_cache(8192)
def _parsed(codes: str) -> tuple[frozenset[str], str, str]:
    """Return the attributes, the foreground and the background of SGR codes."""
    attributes: set[str] = set()
    ink = paper = ""
    left = codes.split(";") if codes else []
    while left:
        code = left.pop(0)
        colour = code
        if code in ("38", "48"):
            taken = 2 if left[:1] == ["5"] else 4
            colour, left = ";".join([code, *left[:taken]]), left[taken:]
        if code[:-1] in ("4", "10"):
            paper = colour
        elif code[:-1] in ("3", "9"):
            ink = colour
        else:
            attributes.add(code)
    return frozenset(attributes), "" if ink == "39" else ink, "" if paper == "49" else paper
