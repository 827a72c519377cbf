"""Salvage of a damaged log: copies the readable rows into a new one.

SQLite aborts a query at a page that is detectably damaged; otherwise a wrong number among the rows
can make it skip rows after it. Events are stored in order of their numbers, so a range can be read
if no page in it is damaged. Ranges that fail or are incomplete are bisected down to single events.
"""

from __future__ import annotations

import shutil
import sqlite3
from collections.abc import Iterator
from contextlib import closing, suppress
from itertools import pairwise
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

SALVAGE = "salvage-"
"""Prefix of the temporary folder for the copy of a damaged log."""
WINDOW = 4096  # events tried at once
MOST_HALVED = 50_000  # takes some seconds; then the rest is read only up to the first error
LEAST_BYTES = 60  # of an event
MOST_RANGES = 50  # that are reported; more are merged into one

Range = tuple[int, int]
"""The first and the last of some events."""

_EVENTS = """SELECT seq, uuid, robot, at, kind, person, strategy, complied, body FROM event
    WHERE seq > ? AND seq <= ?"""
_TEXT = "CAST(? AS TEXT)"
# As text, whatever the bytes: a reader detects invalid text.
_ADD = f"""INSERT INTO event (seq, uuid, robot, at, kind, person, strategy, complied, body)
    VALUES (?, {", ".join([_TEXT] * 6)}, ?, {_TEXT})"""  # noqa: S608
_NEWEST = (
    "SELECT max(seq) FROM event",
    "SELECT max(rowid) FROM event INDEXED BY event_kind WHERE kind > ''",
)
_SMALL = {"meta": 2, "name": 2, "speech": 4}
"""The other tables, and their numbers of columns."""


def salvage(damaged: Path, db: sqlite3.Connection, sealed: int) -> tuple[int, list[Range]]:
    """Copy the readable rows of a damaged log, which stays unchanged.

    Args:
        damaged: the log, with its -wal beside it.
        db: the new log, with empty tables.
        sealed: the number of the newest event, as far as known.

    Returns:
        The number of copied events, and the lost ranges; one range whose last is before its first
        if the loss is unknown.
    """
    with TemporaryDirectory(prefix=SALVAGE, dir=damaged.parent) as folder:
        copy = Path(folder) / "log"
        for end in ("", "-wal"):
            with suppress(FileNotFoundError):
                shutil.copyfile(f"{damaged}{end}", f"{copy}{end}")
        with closing(sqlite3.connect(copy, isolation_level=None)) as old:
            old.text_factory = bytes
            newest = max(sealed, min(_newest(old), copy.stat().st_size // LEAST_BYTES))
            db.execute("BEGIN IMMEDIATE")
            try:
                for table, columns in _SMALL.items():
                    _take_table(old, db, table, columns)
                kept = 0
                for row in _events(old, newest):
                    with suppress(sqlite3.Error):  # duplicates, or invalid rows
                        kept += db.execute(_ADD, row).rowcount
                lost = _gaps(db, newest) if newest else [(1, 0)]
            except BaseException:
                db.rollback()
                raise
            db.execute("COMMIT")
    return kept, lost if len(lost) <= MOST_RANGES else [(lost[0][0], lost[-1][1])]


def _newest(old: sqlite3.Connection) -> int:
    """Return the greatest event number in the table or its index."""
    found = [0]
    for sql in _NEWEST:
        with suppress(sqlite3.Error):
            found.append(old.execute(sql).fetchone()[0] or 0)
    return max(found)


def _take_table(old: sqlite3.Connection, db: sqlite3.Connection, table: str, columns: int) -> None:
    """Copy the readable rows of one of the small tables."""
    values = ", ".join([_TEXT] * columns)
    with suppress(sqlite3.Error):
        for row in old.execute(f"SELECT * FROM {table}"):  # noqa: S608
            with suppress(sqlite3.Error):
                db.execute(f"INSERT OR IGNORE INTO {table} VALUES ({values})", row)  # noqa: S608


def _events(old: sqlite3.Connection, newest: int) -> Iterator[tuple[Any, ...]]:
    """Yield the rows of all readable events."""
    halved = 0
    waiting = [(low, min(low + WINDOW, newest)) for low in range(0, newest, WINDOW)][::-1]
    while waiting:
        low, high = waiting.pop()
        rows = _rows_in_order(old, low, high)
        if len(rows) < high - low > 1 and halved < MOST_HALVED:
            halved += 1
            middle = (low + high) // 2
            waiting += [(middle, high), (low, middle)]
        else:
            yield from rows


def _rows_in_order(old: sqlite3.Connection, low: int, high: int) -> list[tuple[Any, ...]]:
    """Return the rows of a range up to the first out of order; none if the query fails."""
    try:
        rows = old.execute(_EVENTS, (low, high)).fetchall()
    except sqlite3.Error:
        return []
    out = (n for n, (before, row) in enumerate(pairwise(rows), 1) if row[0] <= before[0])
    return rows[: next(out, len(rows))]


def _gaps(db: sqlite3.Connection, newest: int) -> list[Range]:
    """Return the ranges of missing events, up to the newest."""
    ends = db.execute(
        "SELECT seq, before FROM (SELECT seq, lag(seq, 1, 0) OVER (ORDER BY seq) AS before"
        " FROM event) WHERE seq > before + 1"
    ).fetchall()
    gaps = [(before + 1, seq - 1) for seq, before in ends]
    (last,) = db.execute("SELECT max(seq) FROM event").fetchone()
    after = (last or 0) + 1
    return gaps + ([(after, newest)] if after <= newest else [])
