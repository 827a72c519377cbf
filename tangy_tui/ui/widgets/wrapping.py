"""Wrapping of text by its width in terminal cells."""

from __future__ import annotations

from rich.cells import cell_len, chop_cells


def wrap(text: str, width: int) -> list[str]:
    """Wrap text into lines of at most `width` cells, at spaces if possible."""
    width = max(1, width)
    lines: list[str] = []
    line = ""
    for word in text.split():
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
