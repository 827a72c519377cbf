"""The filter in front of the terminal: no text can contain control sequences.

Names, transcripts and files hold data, which may contain escape sequences. `clean` makes them
visible at layout; `CleanOutput` filters the output of all widgets, and replaces other characters
if the terminal only has ASCII.
"""

from __future__ import annotations

import re
import unicodedata
from functools import lru_cache

from rich.cells import cell_len, set_cell_size
from rich.segment import Segment
from textual.color import Color
from textual.filter import LineFilter

REPLACEMENT = "\N{REPLACEMENT CHARACTER}"

OBEYED = re.compile(
    "["
    "\x00-\x1f\x7f-\x9f"  # C0, DEL, C1
    "\u00ad\u034f\u061c\u115f\u1160\u17b4\u17b5\u180e\u3164\uffa0"  # drawn as nothing
    "\u200b-\u200f\u2028-\u202e\u2060-\u206f\ufeff\ufff9-\ufffb"  # zero width, bidi
    "\U000e0000-\U000e0fff"  # tags
    "]"
)
"""Characters that a terminal interprets, or draws as nothing."""

_SELECTORS = re.compile("[\ufe00-\ufe0f\U000e0100-\U000e01ef]")
_SPACES = re.compile("[\t\n\r\v\f\x85\u2028\u2029]+")

ASCII_FOR: dict[str, str] = {
    **dict.fromkeys("─╌┄╴╶━╍┅═▔\u2010\u2011\u2012\u2013\u2014\u2212", "-"),
    **dict.fromkeys("│╎┆┃╏┇║▏▎▍▌▐▕▊▋▉", "|"),
    **dict.fromkeys("┌┐└┘├┤┬┴┼╭╮╰╯┏┓┗┛┣┫┳┻╋╔╗╚╝╠╣╦╩╬╞╡╪╘╛", "+"),
    **dict(zip("▁▂▃▄▅▆▇█", "_.:-=+*#", strict=True)),
    **dict.fromkeys("■▓▒░▀▖▗▘▝▙▟▛▜▦", "#"),
    **dict.fromkeys("▶▸►→»⇒\u203a\u276f", ">"),
    **dict.fromkeys("◀◂◄←«⇐\u2039\u276e", "<"),
    **dict.fromkeys("▲▴↑⇑", "^"),
    **dict.fromkeys("▼▾↓⇓", "v"),
    **dict.fromkeys("●○◉◎◌•∘", "o"),
    **dict.fromkeys("★☆✱", "*"),
    **dict.fromkeys("✓✔", "v"),
    **dict.fromkeys("✗✘✕\u00d7", "x"),
    **dict.fromkeys("·‧∙", "."),
    **dict.fromkeys("\u2018\u2019\u201a\u2032", "'"),
    **dict.fromkeys("\u201c\u201d\u201e\u2033", '"'),
    "…": "~",
    "\N{NO-BREAK SPACE}": " ",
    "ß": "s",
    "æ": "a",
    "Æ": "A",
    "ø": "o",
    "Ø": "O",
    "ł": "l",
    "Ł": "L",
}
"""ASCII replacements of characters one cell wide."""


def clean(text: str) -> str:
    """Return data as one line that is safe to lay out.

    Line breaks and tabs become a space, control characters a visible mark. Accents are composed, so
    that one character is one glyph.
    """
    text = _SELECTORS.sub("", _SPACES.sub(" ", text))
    return OBEYED.sub(REPLACEMENT, unicodedata.normalize("NFC", text))


@lru_cache(4096)
def to_ascii(text: str) -> str:
    """Return text in ASCII, with the same width in cells."""
    drawn: list[str] = []
    for character in text:
        if character.isascii():
            drawn.append(character)
            continue
        cells = cell_len(character)
        plain = ASCII_FOR.get(character)
        if plain is None:
            letters = unicodedata.normalize("NFKD", character)
            plain = "".join(c for c in letters if c.isascii() and c.isprintable())
        drawn.append(plain if len(plain) == cells else "?" * cells)
    return "".join(drawn)


@lru_cache(1024)
def harmless(text: str, ascii: bool) -> str:
    """Return text without control characters, with its measured width in cells.

    Characters of width 0 are removed, since a mark in their place would shift the line.
    """
    cells = cell_len(text)
    drawn = OBEYED.sub(lambda found: REPLACEMENT if cell_len(found[0]) else "", text)
    if ascii:
        drawn = to_ascii(drawn)
    return drawn if cell_len(drawn) == cells else set_cell_size(drawn, cells)


class CleanOutput(LineFilter):
    """Replaces control characters in every drawn line, of any widget."""

    def __init__(self, *, ascii: bool = False) -> None:
        super().__init__()
        self.ascii = ascii

    def apply(self, segments: list[Segment], background: Color) -> list[Segment]:
        """Return the segments with safe text, and without hyperlinks."""
        drawn: list[Segment] = []
        for text, style, _ in segments:
            if (self.ascii and not text.isascii()) or OBEYED.search(text):
                text = harmless(text, self.ascii)
            if style is not None and style.link:
                style = style.update_link(None)
            drawn.append(Segment(text, style))
        return drawn
