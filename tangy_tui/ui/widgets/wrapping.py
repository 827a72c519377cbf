"""Breaking text into lines by the cells it takes."""

from __future__ import annotations

from rich.cells import cell_len, chop_cells


def wrap(text: str, width: int) -> list[str]:
    """Break text into lines of at most so many cells, at spaces where there are any."""
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
