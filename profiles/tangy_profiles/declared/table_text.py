"""The text of a table as spreadsheet programs save it: its encoding and its separator."""

from __future__ import annotations

import codecs
import csv
import io
from dataclasses import dataclass

SEPARATORS = (",", ";", "\t")
"""What may stand between two cells; of two that occur equally often the first one counts."""
SAVE_AS = "save it as CSV UTF-8 in your spreadsheet program"


@dataclass(frozen=True, slots=True)
class ReadAs:
    """How a table was read that is not plain CSV: what had to be guessed.

    `windows`: as Windows-1252, because it is no UTF-8. `separator`: what stands between its cells.
    """

    file: str
    windows: bool
    separator: str


def table_rows(content: bytes, file: str) -> tuple[list[list[str]], ReadAs]:
    """Divide a table into rows of cells, and tell how it was read.

    Its text is UTF-8, UTF-16 with a byte order mark, or else Windows-1252. Its separator is the one
    that is most frequent in the header; a line `sep=;` before it is skipped. A line break within a
    cell becomes a space. Empty columns at the end are left out.

    Raises:
        ValueError: a sentence that says what is wrong, without a full stop.
    """
    text, windows = _decoded(content)
    lines = io.StringIO(text, newline=None).readlines()
    skipped = 1 if lines and lines[0].casefold().startswith("sep=") else 0
    header = next((line for line in lines[skipped:] if line.strip()), "")
    separator = max(SEPARATORS, key=header.count)
    reader = csv.reader(lines[skipped:], delimiter=separator, strict=True)
    try:
        rows = [[cell.replace("\n", " ").strip() for cell in row] for row in reader if row]
    except csv.Error:
        raise ValueError(
            f"line {skipped + reader.line_num}: its quotation marks do not match. Put quotation"
            " marks around the whole cell, and write those inside it twice, as a spreadsheet"
            " program does"
        ) from None
    while rows and rows[0][1:] and all(len(r) == len(rows[0]) and not r[-1] for r in rows):
        rows = [row[:-1] for row in rows]
    return rows, ReadAs(file, windows, separator)


def _decoded(content: bytes) -> tuple[str, bool]:
    """Return a table as text, and whether it was read as Windows-1252.

    Raises:
        ValueError: it is no text.
    """
    try:
        if content.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
            return content.decode("utf-16"), False
        if b"\0" in content:
            raise ValueError(f"it is no text: {SAVE_AS}")
        return content.decode("utf-8-sig"), False
    except UnicodeDecodeError:
        try:
            return content.decode("cp1252"), True
        except UnicodeDecodeError:
            raise ValueError(f"its letters cannot be read: {SAVE_AS}") from None
