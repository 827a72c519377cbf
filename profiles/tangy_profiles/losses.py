"""Events missing from a log: detected when it is opened, and reported until accepted.

The count beside the log (`seal`) reveals that the newest are missing, salvage after damage
(`salvage`) the others. A detected loss is logged as an event, and reported whenever the log is
opened until staff accept it.
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
    """Return the seq of the newest event; 0 if there is none."""
    found = rows("SELECT coalesce(max(seq), 0) FROM event")
    return int(found[0][0]) if found else 0


def unnoticed(
    rows: Rows, sealed: tuple[str, int] | None, noted: Sequence[EventsLost]
) -> list[EventsLost]:
    """Return a loss of the newest events, according to the count, that was not logged yet.

    Args:
        rows: queries the log.
        sealed: the robot and newest seq of the count; None if it cannot be read.
        noted: the losses that were logged.
    """
    meta = dict(rows("SELECT key, value FROM meta WHERE key IN ('robot', 'sealed')"))
    last = newest(rows)
    if sealed is None:
        missed = "sealed" in meta and last and not any(loss.unknown for loss in noted)
        return [EventsLost(first=last + 1, last=last)] if missed else []
    if meta.get("robot", sealed[0]) != sealed[0] or last >= sealed[1]:
        return []  # the count of another log, or no loss
    loss = EventsLost(first=last + 1, last=sealed[1])
    return [] if loss in noted else [loss]


def count_mismatches(rows: Rows, losses: Iterable[EventsLost]) -> Iterator[str]:
    """Yield a sentence for each inconsistent count of the log."""
    for events, last, different, answers, indexed, guards in rows(COUNTS):
        if not events == different == last - _missing(rows, losses):
            yield f"tangy.db: {last} events were logged, {events} stand, {different} different."
        if answers != indexed:
            yield f"tangy.db: {indexed} of {answers} responses are in the index."
        if guards < 2:
            yield "tangy.db: the guard against changing events is gone."


def _missing(rows: Rows, losses: Iterable[EventsLost]) -> int:
    """Count the events whose loss was logged and whose numbers were not reused."""
    sql = "SELECT count(*) FROM event WHERE seq BETWEEN ? AND ?"
    until = newest(rows)
    ranges = ((loss.first, min(loss.last, until)) for loss in losses)
    return sum(last - first + 1 - rows(sql, first, last)[0][0] for first, last in ranges
               if first <= last)  # fmt: skip


def loss_words(loss: EventsLost) -> str:
    """Describe in a sentence which events are gone."""
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
