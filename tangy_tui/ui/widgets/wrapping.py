"""Wrapping of text by its width in terminal cells."""

from __future__ import annotations

import re

from rich.cells import cell_len, chop_cells

WORD = re.compile(r"[^ \t\n\r\f\v]+")
"""A word between spaces that a line may end at."""


def wrap(text: str, width: int) -> list[str]:
    """Wrap text into lines of at most `width` cells, at spaces if possible, but no hard ones."""
    width = max(1, width)
    lines: list[str] = []
    line = ""
    for word in WORD.findall(text):
        if not line:
            line = word
        elif cell_len(line) + 1 + cell_len(word) <= width:
            line = f"{line} {word}"
        else:
            lines.append(line)
            line = word
        while cell_len(line) > width:
            head, *rest = chop_cells(line, width)
            if not rest:  # one character that is wider than that
                break
            lines.append(head)
            line = "".join(rest)
    return [*lines, line] if line or not lines else lines
