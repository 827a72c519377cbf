"""Values of an activity's file, read key by key; mistakes are recorded and reading continues."""

from __future__ import annotations

import itertools
from collections.abc import Collection, Iterator
from typing import Any

from tangy_profiles.declared.source import Path, SourceText, short
from tangy_profiles.plain_text import plain
from tangy_profiles.reading import nearest


class Section:
    """A table of the file. Mistakes are recorded, and a harmless default is returned instead."""

    def __init__(self, source: SourceText, values: Any, path: Path = ()) -> None:
        """Wrap a value that should be a table, with the keys that led to it."""
        self.source, self.path = source, path
        self._values: dict[str, Any] = {}
        if isinstance(values, dict):
            self._values = values
        else:
            source.wrong(path, "must be a table")

    def __contains__(self, key: str) -> bool:
        return key in self._values

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def wrong(self, key: str | int, problem: str, quoted: str = "") -> None:
        """Record a mistake at a key."""
        self.source.wrong((*self.path, key), problem, quoted)

    def only(self, *known: str) -> None:
        """Record the keys that are not known here as mistakes."""
        for key in self._values:
            if key not in known:
                problem = f"is not a key here; {nearest(key, known, self._values)}"
                self.source.wrong((*self.path, key), problem, cause=True)

    def text(self, key: str, default: str | None = None) -> str:
        """Read a text; without a default it is required."""
        value = self._values.get(key, default)
        if value is None:
            self.source.wrong((*self.path, key), "is missing; it must be a text")
            return ""
        if not isinstance(value, str) or (not value.strip() and value != default):
            self.wrong(key, f"must be a text that is not empty, not {short(value)}")
            return default or ""
        if plain(value) != value:
            self.wrong(key, "holds a character that cannot be shown")
            return default or ""
        return value

    def word(self, key: str, known: Collection[str], default: str | None = None) -> str:
        """Read one of the known words."""
        value = self.text(key, default)
        if value not in known and value != default:
            if value:
                self.wrong(key, f"{short(value)} is not known; {nearest(value, known)}", value)
            return default if default is not None else next(iter(known), "")
        return value

    def texts(self, key: str, *, single: bool = False) -> tuple[str, ...]:
        """Read a list of texts (default: empty); `single`: one text stands for a list of one."""
        value = self._values.get(key, [])
        if single and isinstance(value, str):
            value = [value]
        good = isinstance(value, list) and all(
            isinstance(one, str) and one.strip() and plain(one) == one for one in value
        )
        if not good:
            self.wrong(key, "must be a list of texts, none of them empty")
            return ()
        return tuple(value)

    def number(self, key: str, low: float, high: float, default: float) -> float:
        """Read a number within [low, high]."""
        value = self._values.get(key, default)
        right = isinstance(value, int | float) and not isinstance(value, bool)
        if not right or not low <= value <= high:
            self.wrong(key, f"must be a number from {low:g} to {high:g}, not {short(value)}")
            return default
        return float(value)

    def whole(self, key: str, low: int, high: int, default: int) -> int:
        """Read a whole number within [low, high]."""
        value = self._values.get(key, default)
        if not isinstance(value, int) or isinstance(value, bool) or not low <= value <= high:
            self.wrong(key, f"must be a whole number from {low} to {high}, not {short(value)}")
            return default
        return value

    def wholes(self, key: str, low: int, high: int) -> tuple[int, ...]:
        """Read a list of rising whole numbers within [low, high] (default: empty)."""
        value = self._values.get(key, [])
        good = isinstance(value, list) and all(
            isinstance(one, int) and not isinstance(one, bool) and low <= one <= high
            for one in value
        )
        if not good or any(a >= b for a, b in itertools.pairwise(value)):
            self.wrong(key, f"must be rising whole numbers from {low} to {high}")
            return ()
        return tuple(value)

    def table(self, key: str) -> Section:
        """Read a table (default: empty)."""
        return Section(self.source, self._values.get(key, {}), (*self.path, key))

    def tables(self, key: str) -> list[Section]:
        """Read a list of tables (default: empty)."""
        value = self._values.get(key, [])
        if not isinstance(value, list):
            self.wrong(key, "must be a list of tables")
            return []
        return [Section(self.source, one, (*self.path, key, n)) for n, one in enumerate(value)]

    def raw(self, key: str) -> Any:
        """Read any value (default: None)."""
        return self._values.get(key)
