"""A minimal terminal emulator: the screen's text from the output of a program.

It handles what full-screen programs send: text, cursor movement, clearing. Colours, modes and
terminal queries are ignored.
"""

from __future__ import annotations

import re
from codecs import getincrementaldecoder
from unicodedata import combining, east_asian_width

_SEQUENCE = re.compile(
    "\x1b(?:"
    r"\[(?P<values>[0-9;:<=>?]*)[ -/]*(?P<final>[@-~])"
    "|\\][^\x07\x1b]*(?:\x07|\x1b\\\\)"  # a title or a colour, until its terminator
    "|[PX^_][^\x1b]*\x1b\\\\"
    r"|(?![\[\]PX^_])[ -/]*[0-~]"
    ")"
)


class Screen:
    """A grid of characters: `feed` it the output of a program, and read its `text`."""

    def __init__(self, columns: int, lines: int) -> None:
        self._columns = columns
        self._cells = [[" "] * columns for _ in range(lines)]
        self._line = self._column = 0
        self._decode = getincrementaldecoder("utf-8")("replace").decode
        self._left = ""

    @property
    def lines(self) -> list[str]:
        """The lines, without trailing spaces."""
        return ["".join(cells).rstrip() for cells in self._cells]

    @property
    def text(self) -> str:
        """The lines as one text."""
        return "\n".join(self.lines)

    def feed(self, written: bytes) -> None:
        """Process output; a sequence may be split between two calls."""
        text = self._left + self._decode(written)
        at = 0
        while at < len(text):
            if text[at] != "\x1b":
                self._put(text[at])
                at += 1
                continue
            found = _SEQUENCE.match(text, at)
            if found is None:
                if len(text) - at < 1000:  # incomplete: wait for the rest
                    break
                at += 1
                continue
            if found["final"]:
                self._obey(found["values"], found["final"])
            at = found.end()
        self._left = text[at:]

    def _put(self, character: str) -> None:
        match character:
            case "\r":
                self._column = 0
            case "\n":
                self._line = min(self._line + 1, len(self._cells) - 1)
            case "\b":
                self._column = max(self._column - 1, 0)
            case _ if character >= " " and not combining(character):
                if self._column < self._columns:
                    self._cells[self._line][self._column] = character
                self._column += 1
                if east_asian_width(character) in "WF":
                    if self._column < self._columns:
                        self._cells[self._line][self._column] = ""
                    self._column += 1

    def _obey(self, values: str, final: str) -> None:
        if values[:1] in ("?", ">", "<", "="):
            return
        numbers = [int(value) if value.isdigit() else 0 for value in values.split(";")]
        count = max(numbers[0], 1)
        match final:
            case "H" | "f":
                self._move(count - 1, max(numbers[1], 1) - 1 if len(numbers) > 1 else 0)
            case "A":
                self._move(self._line - count, self._column)
            case "B":
                self._move(self._line + count, self._column)
            case "C":
                self._move(self._line, self._column + count)
            case "D":
                self._move(self._line, self._column - count)
            case "J" if numbers[0] >= 2:
                self._cells = [[" "] * self._columns for _ in self._cells]
            case "J":
                self._clear(self._line, self._column)
                for line in range(self._line + 1, len(self._cells)):
                    self._clear(line, 0)
            case "K":
                self._clear(self._line, 0 if numbers[0] == 2 else self._column)

    def _move(self, line: int, column: int) -> None:
        self._line = min(max(line, 0), len(self._cells) - 1)
        self._column = min(max(column, 0), self._columns - 1)

    def _clear(self, line: int, column: int) -> None:
        self._cells[line][column:] = [" "] * (self._columns - column)
