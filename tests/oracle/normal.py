"""Replaces ids by the order of their appearance and times by a word, as they vary by run."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable
from typing import Any

_ID = re.compile(
    r"\b(?:[0-9a-f]{12}|[0-9a-f]{8}-[0-9a-f]{4}-[0-9a-f]{4}-[0-9a-f]{4}-[0-9a-f]{12})\b"
)
_TIME = re.compile(r"\d{4}-\d\d-\d\d[T ]\d\d:\d\d(?::\d\d(?:\.\d+)?)?(?:\+\d\d:\d\d|Z)?")
_CLOCK = re.compile(r"\b\d\d:\d\d(?::\d\d)?\b")
_DAY = re.compile(r"\b\d{4}-\d\d-\d\d\b")
_PATH = re.compile(r"/tmp/[\w./-]+")  # noqa: S108 - what is looked for in texts

MEASURED = {
    *("versions", "code", "elapsed", "wall_seconds", "real_time_factor", "cpu", "took"),
    *("seconds", "median_seconds"),
}
"""Keys whose values the machine's clock measures, or that name libraries or the source."""


class Names:
    """Gives every id the number of its first appearance."""

    def __init__(self) -> None:
        self._known: dict[str, str] = {}

    def text(self, text: str) -> str:
        """Return a text without ids, times and paths of its run."""
        text = _ID.sub(lambda m: self._known.setdefault(m[0], f"<id {len(self._known)}>"), text)
        text = _CLOCK.sub("<clock>", _DAY.sub("<day>", _TIME.sub("<time>", text)))
        return _PATH.sub("<path>", text)

    def value(self, value: Any) -> Any:
        """Return the JSON value with its names normalised."""
        if isinstance(value, dict):
            return {
                self.text(key): "<measured>" if key in MEASURED else self.value(one)
                for key, one in value.items()
            }
        if isinstance(value, list):
            return [self.value(one) for one in value]
        return self.text(value) if isinstance(value, str) else value

    def document(self, text: str) -> str:
        """Return the text of a JSON document (or of its lines, if it is none)."""
        try:
            value = json.loads(text)
        except json.JSONDecodeError:
            return self.text(text)
        return json.dumps(self.value(value), ensure_ascii=False, indent=1)

    def events(self, rows: Iterable[tuple[Any, ...]]) -> str:
        """Return a line for each event of a log: kind, person, strategy, response and body."""
        return "\n".join(
            self.document(json.dumps([*row[:-1], json.loads(row[-1])])).replace("\n", "")
            for row in rows
        )
