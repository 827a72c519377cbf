"""Reassembles messages that rosbridge sends in fragments."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

OPEN = 16  # incomplete messages kept; the oldest is dropped first
PIECES = 4_096  # maximum of fragments per message
LARGEST = 16 << 20  # characters of a whole message


class Fragments:
    """Fragments by message, in any order of arrival."""

    def __init__(self) -> None:
        """Start without fragments."""
        self.open_parts: dict[str, dict[int, str]] = {}

    def take(self, fragment: Mapping[str, Any]) -> str | None:
        """Add a fragment; return the whole text once it is complete.

        Raises:
            ValueError, KeyError, TypeError: it is invalid, or its message is too large.
        """
        key, number, total = str(fragment["id"]), fragment["num"], fragment["total"]
        data = fragment["data"]
        if not (isinstance(number, int) and isinstance(total, int) and isinstance(data, str)):
            raise TypeError("a fragment's num and total are whole numbers, its data is a text")
        if not 0 <= number < total <= PIECES:
            raise ValueError(f"fragment {number} of {total}")
        pieces = self.open_parts.setdefault(key, {})
        pieces[number] = data
        if sum(map(len, pieces.values())) > LARGEST:
            del self.open_parts[key]
            raise ValueError("a message in fragments is too large")
        if len(pieces) >= total:
            del self.open_parts[key]
            return "".join(pieces[place] for place in sorted(pieces))
        while len(self.open_parts) > OPEN:
            del self.open_parts[next(iter(self.open_parts))]
        return None
