"""The kinds of event in the log: a closed set, each with a record.

A body is validated when it is written and when it is read. It may have keys that its record does
not define.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from importlib import import_module
from typing import Any

from tangy_profiles import codec
from tangy_profiles.codec import InvalidValue
from tangy_profiles.records import KINDS, VERSION_KEY
from tangy_profiles.records import EventRecord as EventRecord
from tangy_profiles.records import Unknown as Unknown

MODULES = ("people_records", "teaching_records", "game_records", "staff_records")
"""Where the records are. They are imported when needed: a new log needs few of them."""


@cache
def kinds() -> Mapping[str, type[EventRecord]]:
    """Return the record class of each kind, by its name."""
    for module in MODULES:
        import_module(f"tangy_profiles.{module}")
    return KINDS


def record_class(name: str) -> type[EventRecord]:
    """Return the record class of a kind, `Unknown` if there is none."""
    return KINDS.get(name) or kinds().get(name, Unknown)


def read_record(
    name: str, person: str | None, strategy: str | None, body: Mapping[str, Any]
) -> EventRecord:
    """Return the record of an event.

    Raises:
        InvalidValue: the event is invalid; the text is the tail of a sentence.
    """
    known = record_class(name)
    if known is Unknown:
        return Unknown(name, body)
    if known.ABOUT != "nobody" and person is None:
        raise InvalidValue("says of nobody whom it is about")
    if known.ABOUT == "strategy" and strategy is None:
        raise InvalidValue("has no strategy")
    version = body.get(VERSION_KEY, 1) if isinstance(body, dict) else 1
    if version != known.VERSION:
        if type(version) is not int or not 1 <= version < known.VERSION:
            raise InvalidValue(
                f"is of version {str(version)[:20]!r}, and this Tangy knows none such"
            )
        body = known.OLDER(version, dict(body))
    return codec.decode(known, body)
