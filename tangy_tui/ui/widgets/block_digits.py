"""Large letters and digits in block characters, readable from metres away: 5 or 10 rows high."""

from __future__ import annotations

ROWS, COLUMNS = 5, 3
_FONT = """
0 7 5 5 5 7|1 2 6 2 2 7|2 7 1 7 4 7|3 7 1 7 1 7|4 5 5 7 1 1|5 7 4 7 1 7|6 7 4 7 5 7|7 7 1 1 1 1|
8 7 5 7 5 7|9 7 5 7 1 7|A 2 5 7 5 5|B 6 5 6 5 6|C 3 4 4 4 3|D 6 5 5 5 6|E 7 4 6 4 7|F 7 4 6 4 4|
G 3 4 5 5 3|H 5 5 7 5 5|I 7 2 2 2 7|J 1 1 1 5 2|K 5 5 6 5 5|L 4 4 4 4 7|M 5 7 7 5 5|N 6 5 5 5 5|
O 2 5 5 5 2|P 6 5 6 4 4|Q 2 5 5 3 1|R 6 5 6 5 5|S 3 4 2 1 6|T 7 2 2 2 2|U 5 5 5 5 7|V 5 5 5 5 2|
W 5 5 7 7 5|X 5 5 2 5 5|Y 5 5 2 2 2|Z 7 1 2 4 7
"""
"""Each character with its rows from the top, three bits each."""

GLYPHS = {
    sign: tuple(map(int, rows))
    for sign, *rows in (entry.split() for entry in _FONT.replace("\n", "").split("|"))
}


def block_rows(label: str, large: bool, *, dark: str = "█") -> list[str]:
    """Draw the letters and digits of a label; `large` doubles width and height."""
    across = 4 if large else 2
    drawn = [""] * ROWS
    for sign in label.upper():
        glyph = GLYPHS.get(sign)
        for row in range(ROWS):
            if glyph is None:
                drawn[row] += " " * across
                continue
            bits = (glyph[row] >> (COLUMNS - 1 - column) & 1 for column in range(COLUMNS))
            drawn[row] += "".join((dark if bit else " ") * across for bit in bits) + " " * across
    return [row.rstrip().ljust(len(drawn[0])) for row in drawn for _ in range(2 if large else 1)]
