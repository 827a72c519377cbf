"""Reads rows of the log as events, and detects invalid rows.

Errors that SQLite's own check misses (a changed byte in a text, a row of another program) are found
row by row, so that only that row is lost.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from datetime import datetime
from functools import cache
from typing import Any, Generic, NamedTuple, NoReturn, TypeVar

from tangy_profiles.codec import InvalidValue
from tangy_profiles.events import EventRecord, Unknown, read_record, record_class
from tangy_profiles.reading import plain

LARGEST_BODY = 8_000_000
"""The most characters of a body; the largest of a game or a policy have some thousands."""

R = TypeVar("R", bound=EventRecord, covariant=True)


class Event(NamedTuple, Generic[R]):
    """An event, at a UTC time in ISO 8601; `complied` is the response to `strategy`.

    `record` is the typed content, and `body` the JSON that it was read from.
    """

    seq: int
    uuid: str
    robot: str
    at: str
    kind: str
    person: str | None
    strategy: str | None
    complied: bool | None
    body: dict[str, Any]
    record: R


class BadRow(Exception):
    """An invalid row; the text says why.

    `event` is the event with an empty body if only the body is invalid, else None.
    """

    def __init__(self, why: str, event: Event[EventRecord] | None = None) -> None:
        super().__init__(why)
        self.event = event


def read_row(row: Sequence[Any]) -> Event[EventRecord]:
    """Return the event of a row: seq, uuid, robot, at, kind, person, strategy, complied, body.

    Raises:
        BadRow: it is invalid.
    """
    _, uuid, robot, at, kind, person, strategy, complied, text = row
    words = (uuid, robot, at, kind, text)
    if not all(isinstance(word, str) for word in words):
        raise BadRow("it holds something else than text")
    if not isinstance(person, str | None) or not isinstance(strategy, str | None):
        raise BadRow("its person or strategy is not text")
    if complied is not None and (complied not in (0, 1) or person is None or strategy is None):
        raise BadRow("its answer is neither yes nor no, or nobody's")
    try:
        "".join((*words, person or "", strategy or "")).encode()
        if datetime.fromisoformat(at).tzinfo is None:
            raise BadRow("its time says no zone")
    except UnicodeEncodeError:
        raise BadRow("it holds bytes that are not text") from None
    except ValueError:
        raise BadRow("its time is not a time") from None
    complied = complied and bool(complied)
    event = Event(row[0], uuid, robot, at, kind, person, strategy, complied, {}, _empty(kind))
    body, wrong = _read_body(text)
    if wrong:
        raise BadRow(wrong, event)
    try:
        return event._replace(body=body, record=read_record(kind, person, strategy, body))
    except InvalidValue as why:
        raise BadRow(f"it {why}", event) from None


@cache
def _empty(kind: str) -> EventRecord:
    """Return an empty record for an event whose body is invalid."""
    try:
        return record_class(kind)()
    except TypeError:  # it has required fields
        return Unknown()


def left_out(seq: int, kind: object, why: str, rest: str = "") -> str:
    """Return a sentence that says which row is left out (except the `rest`), and why."""
    return wrong_row(seq, kind, f" is damaged and left out{rest}: {why}")


def wrong_row(seq: int, kind: object, wrong: str) -> str:
    """Return a sentence about an invalid row; `wrong` follows its number and kind."""
    of = f" ({kind[:40]})" if isinstance(kind, str) else ""
    said = f"tangy.db: event {seq}{of}{wrong}."
    return plain(said.encode(errors="replace").decode())


def are_text(*words: object) -> bool:
    """Return whether all of these are printable texts."""
    return all(isinstance(word, str) and word.isprintable() for word in words)


def _read_body(text: str) -> tuple[dict[str, Any], str]:
    if len(text) > LARGEST_BODY:  # before parsing, which takes much more memory
        return {}, "its body is too long"
    try:
        body = _from_json(text)
        if "\\u" in text:  # it may be a lone surrogate
            json.dumps(body, ensure_ascii=False).encode()
    except (ValueError, RecursionError):
        return {}, "its body is not JSON"
    return (body, "") if isinstance(body, dict) else ({}, "its body is not a table")


def _refuse(constant: str) -> NoReturn:
    raise ValueError(constant)


_from_json = json.JSONDecoder(parse_constant=_refuse).decode
