"""The text of an activity's file: locations of keys and values, and the mistakes found."""

from __future__ import annotations

import re
from typing import Any

from tangy_profiles.declared.table_text import ReadAs
from tangy_profiles.errors import ProfileError
from tangy_profiles.plain_text import plain

MOST_MISTAKES = 50
"""The most mistakes to report at once."""
LONGEST = 60
"""The most characters of the file that a mistake quotes."""
Path = tuple[str | int, ...]


class MistakesError(ProfileError):
    """An activity's file has mistakes; `lines` has each, with its line and column."""

    def __init__(self, lines: list[str]) -> None:
        """Create the error for one or more mistakes; its message is the first of them."""
        more = f" (and {len(lines) - 1} more)" if len(lines) > 1 else ""
        super().__init__(lines[0] + more)
        self.lines = tuple(lines)


class SourceText:
    """A file's text and its mistakes."""

    def __init__(self, file: str, text: str) -> None:
        """Use a file's name and its text."""
        self.file = file
        self.tables: list[ReadAs] = []
        """How the tables beside the file were read."""
        self._text = text
        self._found: list[tuple[int, int, str]] = []
        self._causes: set[str] = set()

    def wrong(self, path: Path, problem: str, quoted: str = "", *, cause: bool = False) -> None:
        """Record a mistake.

        Args:
            path: the keys that lead to it; a number is an index of a list, from 0.
            problem: the problem, without a full stop.
            quoted: the wrong text, if it is only part of the value.
            cause: other mistakes may follow from it, as from a misspelt key.
        """
        offset = self._offset(path, quoted)
        line = self.line(path, quoted)
        column = offset - (self._text.rfind("\n", 0, offset) + 1) + 1
        problem = problem if problem.endswith(("?", ".")) else f"{problem}."
        told = f"{self.file}:{line}:{column}: {dotted(path)}: {problem}"
        if (line, column, told) not in self._found:
            self._found.append((line, column, told))
            self._causes |= {told} if cause else set()

    def close(self) -> None:
        """Raise an error if the file has mistakes.

        Raises:
            MistakesError: lists all of them: those that may cause others, then in the file's order.
        """
        if self._found:
            by_place = sorted(self._found, key=lambda one: (one[2] not in self._causes, *one))
            raise MistakesError([plain(told) for *_, told in by_place[:MOST_MISTAKES]])

    def _offset(self, path: Path, quoted: str) -> int:
        """Return the offset of a key, or the nearest one before it."""
        text, rest = self._text, list(path)
        begin, end = 0, len(text)
        for length in range(len(path), 0, -1):
            keys = [key for key in path[:length] if isinstance(key, str)]
            if len(keys) < length:
                continue
            header = r"\s*\.\s*".join(f"[\"']?{re.escape(key)}[\"']?" for key in keys)
            found = re.search(rf"^\s*\[\s*({header})\s*\]", text, re.MULTILINE)
            if found is not None:
                begin, rest = found.start(1), list(path[length:])
                following = re.compile(r"^\s*\[", re.MULTILINE).search(text, found.end())
                end = following.start() if following is not None else end
                break
        for key in rest:
            found = self._key(key, begin, end)
            if found is None:
                break
            begin = found.start(1)
        if quoted:
            place = text.find(quoted, begin, end)
            begin = place if place >= 0 else begin
        return begin

    def line(self, path: Path, quoted: str = "") -> int:
        """Return the line (from 1) of a key or a text in its value, or of the key before it."""
        return self._text.count("\n", 0, self._offset(path, quoted)) + 1

    def _key(self, key: str | int, begin: int, end: int) -> re.Match[str] | None:
        if isinstance(key, str):
            word = rf"([\"']?{re.escape(key)}[\"']?)"
            found = re.compile(rf"(?<![\w-]){word}\s*=").search(self._text, begin, end)
            if found is None and not begin:  # a table of tables only, without a header of its own
                found = re.compile(rf"^\s*\[\s*{word}\s*\.", re.MULTILINE).search(self._text)
            return found
        found = None
        places = re.compile(r"([{\"'])(?:[^{}\"'\n]*(?:\"[^\"\n]*\"|'[^'\n]*')?)*?[}\"']")
        for count, found in enumerate(re.finditer(r"(\{)", self._text[begin:end])):
            if count == key:
                return re.compile(r"(\{)").search(self._text, begin + found.start())
        return places.search(self._text, begin, end) if found is None else None


def dotted(path: Path) -> str:
    """Format a path of keys for people."""
    words = ""
    for key in path:
        if isinstance(key, int):
            words += f"[{key + 1}]"
        else:
            short = key if len(key) <= LONGEST else f"{key[:LONGEST]}\N{HORIZONTAL ELLIPSIS}"
            words += f".{short}" if words else short
    return words


def short(value: Any) -> str:
    """Return a value of a file, shortened for a mistake."""
    text = repr(value)
    return text if len(text) <= LONGEST else f"{text[:LONGEST]}\N{HORIZONTAL ELLIPSIS}"
