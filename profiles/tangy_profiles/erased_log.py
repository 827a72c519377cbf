"""Erasure of a name from the events of a log: the only change ever made to events.

Only free texts in their bodies change. The number of events, their times, subjects and answers
stay, so beliefs, policies and the count beside the log are unchanged.
"""

from __future__ import annotations

import json
import sqlite3
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from tangy_profiles.queries import fetch

if TYPE_CHECKING:
    from tangy_profiles.erasure import NameEraser

WINDOW = 4096  # events at a time
GUARD = "unchanged"
"""The trigger that protects events from changes."""

_to_json = json.JSONEncoder(allow_nan=False, ensure_ascii=False, separators=(",", ":")).encode


def erase_from_log(db: sqlite3.Connection, eraser: NameEraser) -> int:
    """Erase a name from the bodies of all events, within the current transaction.

    Returns:
        The number of changed events.
    """
    changed = [
        (after.encode(errors="surrogateescape"), seq)
        for seq, kind, body in _bodies(db, eraser)
        if (after := _without(kind, body, eraser)) != body
    ]
    if not changed:
        return 0
    guard = db.execute(
        "SELECT sql FROM sqlite_master WHERE type = 'trigger' AND name = ?", (GUARD,)
    )
    found = guard.fetchone()
    if found:
        db.execute(f"DROP TRIGGER {GUARD}")
    db.executemany("UPDATE event SET body = CAST(? AS TEXT) WHERE seq = ?", changed)
    if found:
        db.execute(found[0])
    return len(changed)


def count_left(db: sqlite3.Connection, eraser: NameEraser) -> int:
    """Count the events that still have the name, as a teacher's or that of staff."""
    return sum(eraser.is_left(body) for _, _, text in _bodies(db, eraser) if (body := _table(text)))


def _bodies(db: sqlite3.Connection, eraser: NameEraser) -> Iterator[tuple[int, str, str]]:
    """Yield seq, kind and body of the events whose body may contain the name."""
    low: int | None = None
    while True:
        after = "TRUE" if low is None else f"seq > {low}"
        rows = fetch(
            db,
            f"SELECT seq, kind, body FROM event WHERE {after} ORDER BY seq LIMIT {WINDOW}",  # noqa: S608
            (),
        )
        for seq, kind, body in rows:
            if isinstance(body, str) and eraser.may_change(body):
                yield seq, str(kind), body
        if not rows:
            return
        low = rows[-1][0]


def _without(kind: str, text: str, eraser: NameEraser) -> str:
    """Return a body without the name; text that is not JSON is treated as typed text."""
    body = _table(text)
    if body is None:
        return eraser.typed(text)
    erased = eraser.body(kind, body)
    return text if erased == body else _to_json(erased)


def _table(text: str) -> dict[str, Any] | None:
    """Parse a body; return None if it is not a JSON object."""
    try:
        body = json.loads(text)
    except (ValueError, RecursionError):
        return None
    return body if isinstance(body, dict) else None
