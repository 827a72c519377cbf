"""Events missing from a log: detected when it is opened, and reported until accepted.

The newest are missed by the count beside the log (`seal`), others after damage (`salvage`). What is
noticed becomes an event, so that it is reported at each opening until staff accept it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any

from tangy_profiles.people_records import EventsLost
from tangy_profiles.queries import COUNTS

Rows = Callable[..., list[Any]]
"""Runs a query with its values, and returns the rows."""

SEALED = "INSERT OR IGNORE INTO meta VALUES ('sealed', '1')"
"""Records that this log has a count beside it, so that its absence is noticed."""


def newest(rows: Rows) -> int:
    """Return the number of the newest event; 0 if there is none."""
    found = rows("SELECT coalesce(max(seq), 0) FROM event")
    return int(found[0][0]) if found else 0


def unnoticed(
    rows: Rows, sealed: tuple[str, int] | None, noted: Sequence[EventsLost]
) -> list[EventsLost]:
    """Return which newest events are missed by the count, if that is not noted yet.

    Args:
        rows: queries the log.
        sealed: whose log the count is of, and its newest event; None if it cannot be read.
        noted: the losses that are.
    """
    meta = dict(rows("SELECT key, value FROM meta WHERE key IN ('robot', 'sealed')"))
    last = newest(rows)
    if sealed is None:
        missed = "sealed" in meta and last and not any(loss.unknown for loss in noted)
        return [EventsLost(first=last + 1, last=last)] if missed else []
    if meta.get("robot", sealed[0]) != sealed[0] or last >= sealed[1]:
        return []  # it is the count of another log, or nothing is gone
    loss = EventsLost(first=last + 1, last=sealed[1])
    return [] if loss in noted else [loss]


def count_mismatches(rows: Rows, losses: Iterable[EventsLost]) -> Iterator[str]:
    """Yield a sentence for each count of the log that does not fit the others."""
    for events, last, different, answers, indexed, guards in rows(COUNTS):
        if not events == different == last - _missing(rows, losses):
            yield f"tangy.db: {last} events were logged, {events} stand, {different} different."
        if answers != indexed:
            yield f"tangy.db: {indexed} of {answers} responses are in the index."
        if guards < 2:
            yield "tangy.db: the guard against changing events is gone."


def _missing(rows: Rows, losses: Iterable[EventsLost]) -> int:
    """Count the events whose loss was noticed, and whose numbers no others have."""
    sql = "SELECT count(*) FROM event WHERE seq BETWEEN ? AND ?"
    until = newest(rows)
    ranges = ((loss.first, min(loss.last, until)) for loss in losses)
    return sum(last - first + 1 - rows(sql, first, last)[0][0] for first, last in ranges
               if first <= last)  # fmt: skip


def loss_words(loss: EventsLost) -> str:
    """Say in a sentence which events are gone."""
    first, last = loss.first, loss.last
    if loss.unknown and loss.damaged:
        return "tangy.db: the log was damaged: nobody can tell how many events are gone."
    if loss.unknown:
        return f"tangy.db: the count beside it is gone: nobody can tell what came after {last}."
    which = f"event {first}" if first == last else f"events {first} to {last}"
    why = (
        "the log was damaged."
        if loss.damaged
        else "the end of the log was lost, or this is a copy that was made while Tangy was writing."
    )
    return f"tangy.db: {which} had been kept and {'is' if first == last else 'are'} gone: {why}"
