"""Erasing a name from the events of a log: the one change that events ever undergo.

Only the free texts of their bodies change. How many events there are, when they were, about whom,
and what was answered stays, so that beliefs, policies and the count beside the log are as before.
"""

from __future__ import annotations

import json
import sqlite3
from collections.abc import Iterator
from typing import Any

from tangy_profiles.erasure import NameEraser
from tangy_profiles.queries import fetch

WINDOW = 4096  # events at a time
GUARD = "unchanged"
"""The trigger that keeps events from being changed."""

_to_json = json.JSONEncoder(allow_nan=False, ensure_ascii=False, separators=(",", ":")).encode


def erase_from_log(db: sqlite3.Connection, eraser: NameEraser) -> int:
    """Erase a name from the bodies of all events, within the transaction that is open.

    Returns:
        How many events were changed.
    """
    changed = [
        (after.encode(errors="surrogateescape"), seq)
        for seq, kind, body in _bodies(db)
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
    """Count the events in whose bodies the name still stands: as a teacher's, for example."""
    return sum(eraser.typed(body) != body for _, _, body in _bodies(db))


def _bodies(db: sqlite3.Connection) -> Iterator[tuple[int, str, str]]:
    """Yield seq, kind and body of the events whose body is text."""
    low: int | None = None
    while True:
        after = "TRUE" if low is None else f"seq > {low}"
        rows = fetch(
            db,
            f"SELECT seq, kind, body FROM event WHERE {after} ORDER BY seq LIMIT {WINDOW}",  # noqa: S608
            (),
        )
        for seq, kind, body in rows:
            if isinstance(body, str):
                yield seq, str(kind), body
        if not rows:
            return
        low = rows[-1][0]


def _without(kind: str, text: str, eraser: NameEraser) -> str:
    """Return the text of a body without the name; one that is no JSON is as running text."""
    if eraser.typed(text) == text:
        return text  # most of them
    try:
        body: Any = json.loads(text)
    except (ValueError, RecursionError):
        body = None
    if not isinstance(body, dict):
        return eraser.typed(text)
    erased = eraser.body(kind, body)
    return text if erased == body else _to_json(erased)
