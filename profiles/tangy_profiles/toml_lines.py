"""Line numbers of keys in TOML text, for error messages."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping
from typing import Any, TypeAlias

MOST_READ = 1_000_000
"""The most characters to parse; a file is not searched beyond that."""

KeyPath: TypeAlias = tuple[str | int, ...]
"""The keys from the root down; an index (from 0) follows the key of a list of tables."""


def line_of(text: str, path: KeyPath) -> int | None:
    """Return the line (from 1) of a key, or else of its table; None if neither is found.

    Args:
        text: valid TOML.
        path: the path of the key.
    """
    lines = _lines(text)
    there = (lines.get(path[:length]) for length in range(len(path), 0, -1))
    return next((line for line in there if line is not None), None)


def _lines(text: str) -> dict[KeyPath, int]:
    found: dict[KeyPath, int] = {}
    entries: dict[KeyPath, int] = {}  # index of the last entry of each list of tables
    here: KeyPath = ()
    for line, is_header, parsed in _statements(text):
        path: KeyPath = () if is_header else here
        value: Any = parsed
        while isinstance(value, Mapping) and len(value) == 1:
            ((key, value),) = value.items()
            path = (*path, key)
            if is_header and isinstance(value, list):
                entries[path] = entries.get(path, -1) + 1
            if path in entries:
                path = (*path, entries[path])
            found.setdefault(path, line)
        if is_header:
            here = path
    return found


def _statements(text: str) -> Iterator[tuple[int, bool, dict[str, Any]]]:
    """Yield (line, is header, content) of each header and each key."""
    first, statement, read = 1, "", 0
    for number, line in enumerate(text.split("\n"), start=1):
        first = first if statement else number
        statement += f"{line}\n"
        read += len(statement)
        if read > MOST_READ:
            return
        try:
            parsed = tomllib.loads(statement)
        except tomllib.TOMLDecodeError:
            continue  # it continues in the next line
        if parsed:
            yield first, statement.lstrip().startswith("["), parsed
        statement = ""
