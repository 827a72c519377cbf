"""What a value of a JSON document must look like: small checks that are put together.

Each says what is wrong as the tail of a sentence ("is not text", "has no 'seed'").
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from tangy_profiles.reading import nearest

Check = Callable[[Any], str]
"""Says what is wrong with a value, as the tail of a sentence ("is not text"); "": nothing."""

LARGEST = 1e12
"""No measure in a log is larger: s, counts, probabilities, what devices say."""


def text(value: Any) -> str:
    """A text."""
    return "" if isinstance(value, str) else "is not text"


def number(value: Any) -> str:
    """A number within all measure."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return "is not a number"
    return "" if abs(value) <= LARGEST else "is beyond all measure"  # not a number neither


def whole(value: Any) -> str:
    """A whole number, however large."""
    return "" if isinstance(value, int) and not isinstance(value, bool) else "is not a whole number"


def count(value: Any) -> str:
    """A whole number from 0 on."""
    return whole(value) or ("" if 0 <= value <= LARGEST else "is not a count")


def yes_or_no(value: Any) -> str:
    """True or false."""
    return "" if isinstance(value, bool) else "is neither yes nor no"


def fact(value: Any) -> str:
    """A measurement of a device: any number, yes or no, or a word."""
    if isinstance(value, str | bool):
        return ""
    finite = isinstance(value, int | float) and abs(value) <= sys.float_info.max
    return "" if finite else "is not a measurement"


def maybe(check: Check) -> Check:
    """What `check` takes, or nothing (null)."""
    return lambda value: "" if value is None else check(value)


def one_of(*words: str) -> Check:
    """One of these words."""

    def check(value: Any) -> str:
        if value in words:
            return ""
        return text(value) or f"is {value[:40]!r} ({nearest(value, words).rstrip('.')})"

    return check


def list_of(each: Check, least: int = 0) -> Check:
    """A list of at least `least`, each of which `each` takes."""

    def check(value: Any) -> str:
        if not isinstance(value, list):
            return "is not a list"
        if len(value) < least:
            return "is too short"
        return next((f"holds one that {wrong}" for one in value if (wrong := each(one))), "")

    return check


def row_of(*each: Check) -> Check:
    """A list of exactly these."""

    def check(value: Any) -> str:
        if not isinstance(value, list) or len(value) != len(each):
            return f"is not a list of {len(each)}"
        pairs = zip(each, value, strict=True)
        return next((f"holds one that {wrong}" for test, one in pairs if (wrong := test(one))), "")

    return check


def table_of(each: Check) -> Check:
    """A table whose values `each` takes."""

    def check(value: Any) -> str:
        if not isinstance(value, dict):
            return "is not a table"
        return next(
            (f"holds one that {wrong}" for one in value.values() if (wrong := each(one))), ""
        )

    return check


@dataclass(frozen=True, slots=True)
class Fields:
    """A table with keys that must be there, and keys that may; `only`: and no others."""

    needs: Mapping[str, Check] = field(default_factory=dict)
    may: Mapping[str, Check] = field(default_factory=dict)
    only: bool = False
    whole: Check = field(default=lambda _: "")
    """What must hold of the keys together."""

    def __call__(self, value: Any) -> str:
        """Say what is wrong with a value."""
        if not isinstance(value, dict):
            return "is not a table"
        for key, check in self.needs.items():
            if key not in value:
                return f"has no {key!r}"
            if wrong := check(value[key]):
                return f"has {key!r} that {wrong}"
        for key, check in self.may.items():
            if key in value and (wrong := check(value[key])):
                return f"has {key!r} that {wrong}"
        if self.only and (others := value.keys() - self.needs.keys() - self.may.keys()):
            return f"has {min(others)[:40]!r}, which is not known"
        return self.whole(value)

    def joined(self, other: Fields) -> Fields:
        """Return a table that has the keys of both."""
        needs, may = {**self.needs, **other.needs}, {**self.may, **other.may}

        def both(value: Any) -> str:
            return self.whole(value) or other.whole(value)

        return Fields(needs, may, self.only or other.only, both)
