"""The SQL queries of the log."""

from __future__ import annotations

import json
import sqlite3
from collections.abc import Collection
from typing import Any

READ = "SELECT seq, uuid, robot, at, kind, person, strategy, complied, body FROM event"
ADD = """INSERT INTO event (uuid, robot, at, kind, person, strategy, complied, body)
    VALUES (?, ?, ?, ?, ?, ?, ?, ?)"""
# The few responses that were voided are looked up and subtracted, so that the index alone counts up
# to half a million responses (a materialized `answer` would not). It is one query with the counts,
# as below. Invalid answers (neither 0 nor 1, without a person) and invalid JSON are skipped, as in
# `rows`.
OF = "CASE WHEN json_valid(body) THEN json_extract(body, '$.of') END"
_RESPONSES = f"""WITH
    back AS (SELECT {OF} AS uuid, person, strategy FROM event
        WHERE kind = 'taken back' AND {OF} IS NOT NULL),
    gone AS (SELECT * FROM back UNION ALL
        SELECT {OF}, person, strategy FROM event
        WHERE kind = 'void' AND uuid NOT IN (SELECT uuid FROM back)),
    answer AS NOT MATERIALIZED (SELECT uuid, person, strategy, complied FROM event
        WHERE complied IN (0, 1) AND typeof(person) = 'text' AND typeof(strategy) = 'text'
        AND {{among}})
    SELECT person, strategy, sum(yes), sum(no) FROM (
    SELECT person, strategy, sum(complied) AS yes, count(*) - sum(complied) AS no FROM answer
        GROUP BY person, strategy
    UNION ALL SELECT person, strategy, -complied, complied - 1 FROM answer
        WHERE uuid IN (SELECT uuid FROM gone)
        AND (person, strategy) IN (SELECT person, strategy FROM gone)
    ) GROUP BY person, strategy HAVING sum(yes) + sum(no) > 0"""  # noqa: S608
_BELONGS = """CASE WHEN json_valid(body) THEN
    coalesce(json_extract(body, '$.game'), json_extract(body, '$.world'), '') ELSE '' END"""
_LISTED = "(SELECT value FROM json_each(?))"
# One query, so that concurrent appends are in all of the counts or in none.
COUNTS = """SELECT count(*), coalesce(max(seq), 0), count(DISTINCT uuid), count(complied),
    (SELECT count(*) FROM event INDEXED BY event_response WHERE complied IS NOT NULL),
    (SELECT count(*) FROM sqlite_master WHERE type = 'trigger') FROM event"""
NEXT = "SELECT coalesce(min(seq) - 1, ?) FROM event WHERE seq > ?"
LARGEST_SEQ = 2**63 - 1


def responses_among(of: Collection[str] | None, but: Collection[str]) -> tuple[str, ...]:
    """Return the query that counts valid responses, and its values.

    Args:
        of: the games and worlds whose responses count; None: all of them.
        but: the games and worlds whose responses do not count.
    """
    if of is None and not but:
        return (_RESPONSES.format(among="TRUE"),)
    within, listed = ("NOT IN", but) if of is None else ("IN", of)
    among = f"{_BELONGS} {within} {_LISTED}"
    return _RESPONSES.format(among=among), json.dumps(sorted(listed))


def fetch(db: sqlite3.Connection, sql: str, values: tuple[object, ...]) -> list[Any]:
    """Return all rows of a query, even if a text has invalid bytes."""
    try:
        return db.execute(sql, values).fetchall()
    except sqlite3.OperationalError as error:
        if "decode" not in str(error):
            raise
    try:
        db.text_factory = lambda raw: raw.decode(errors="surrogateescape")
        return db.execute(sql, values).fetchall()
    finally:
        db.text_factory = str
