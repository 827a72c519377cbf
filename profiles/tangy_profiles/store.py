"""The append-only event log of one data folder, and what is counted out of it.

One process writes a folder at a time; any number may read beside it (see `log_file`). Names of
people stand in a table of their own, and how they are pronounced and spoken to in another, so that
they can be forgotten while the counts that beliefs are made of stay.
"""

from __future__ import annotations

import json
import sqlite3
import uuid
from collections import deque
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from datetime import UTC, datetime
from pathlib import Path
from threading import RLock
from typing import Any, NamedTuple, Self

from tangy_profiles.errors import StoreError, TangyError
from tangy_profiles.log_file import FILE, NAMING, LogFile
from tangy_profiles.phones import read_name_phones
from tangy_profiles.reading import plain
from tangy_profiles.voice import VoicePreference

LONGEST_NAME = 40  # characters
WINDOW = 4096  # events fetched at a time, so that a slow reader never holds up a checkpoint

_READ = "SELECT seq, uuid, robot, at, kind, person, strategy, complied, body FROM event"
_ADD = """INSERT INTO event (uuid, robot, at, kind, person, strategy, complied, body)
    VALUES (?, ?, ?, ?, ?, ?, ?, ?)"""
VOID, TAKEN_BACK = "void", "taken back"
"""The kinds of event whose body names another event `of` (by uuid) that no longer holds, and whose
person and strategy are that one's. A void that was taken back does not hold itself."""

# The responses that do not hold are few: they are looked up and subtracted, so that the index
# alone still counts what may be half a million. One query with the counts, as below.
_RESPONSES = """WITH
    back AS (SELECT json_extract(body, '$.of') AS uuid, person, strategy FROM event
        WHERE kind = 'taken back' AND json_extract(body, '$.of') IS NOT NULL),
    gone AS (SELECT * FROM back UNION ALL
        SELECT json_extract(body, '$.of'), person, strategy FROM event
        WHERE kind = 'void' AND uuid NOT IN (SELECT uuid FROM back))
    SELECT person, strategy, sum(yes), sum(no) FROM (
    SELECT person, strategy, sum(complied) AS yes, count(*) - sum(complied) AS no FROM event
        WHERE complied IS NOT NULL GROUP BY person, strategy
    UNION ALL SELECT person, strategy, -complied, complied - 1 FROM event
        WHERE complied IS NOT NULL AND uuid IN (SELECT uuid FROM gone)
        AND (person, strategy) IN (SELECT person, strategy FROM gone)
    ) GROUP BY person, strategy HAVING sum(yes) + sum(no) > 0"""
# One query, so that what a writer appends meanwhile is in all of the counts or in none.
_COUNTS = """SELECT count(*), coalesce(max(seq), 0), count(DISTINCT uuid), count(complied),
    (SELECT count(*) FROM event INDEXED BY event_response WHERE complied IS NOT NULL),
    (SELECT count(*) FROM sqlite_master WHERE type = 'trigger') FROM event"""
_to_json = json.JSONEncoder(allow_nan=False, ensure_ascii=False, separators=(",", ":")).encode


class Event(NamedTuple):
    """One thing that happened, at a UTC time in ISO 8601; `complied` answers `strategy`."""

    seq: int
    uuid: str
    robot: str
    at: str
    kind: str
    person: str | None
    strategy: str | None
    complied: bool | None
    body: dict[str, Any]


class Store:
    """The log of one data folder; threads may share it (see `transaction`).

    Every method raises StoreError, one sentence, where the log cannot be read or written.
    """

    def __init__(self, folder: Path, writable: bool, now: Callable[[], datetime]) -> None:
        """Prepare a store that is not open yet; use `Store.open`."""
        self.folder = folder
        self.writable = writable
        self._now = now
        self._lock = RLock()
        self._file = LogFile(folder, writable, now)
        self.notices = self._file.notices
        self._robot = ""
        self._closed = self._within = self._spoilt = False

    @classmethod
    def open(
        cls, folder: Path, *, write: bool = True, now: Callable[[], datetime] | None = None
    ) -> Store:
        """Open the log of a data folder; a writer makes folder and log where there are none.

        A damaged log is renamed aside and a new one begun, and `notices` says so. With
        `write=False` nothing is made: a folder without a log reads as empty until there is one.
        An older log is brought up to date, by a reader only where it can be.

        Raises:
            StoreBusy: another process writes to this folder.
            StoreError: the folder cannot be made, read or written, or a newer Tangy wrote it.
        """
        store = cls(folder.absolute(), write, now or (lambda: datetime.now(UTC)))
        try:
            with store._file.in_words():
                store._begin() if write else store._file.reading()
        except BaseException:
            store._file.damaged = True  # so that closing does not vouch for it
            store.close()
            raise
        return store

    def append(
        self,
        kind: str,
        body: Mapping[str, Any],
        *,
        person: str | None = None,
        strategy: str | None = None,
        complied: bool | None = None,
    ) -> int:
        """Log one event and return its seq; outside a `transaction` it is then on the disk.

        `body` is JSON with text keys; `complied` says whether `person` followed `strategy`.

        Raises:
            ValueError, TypeError: the caller's mistake: a body that is not JSON (NaN, too deep),
                no kind, or `complied` without person and strategy.
            StoreError: it could not be kept, and nothing of it was.
        """
        if not kind or (complied is not None and (person is None or strategy is None)):
            raise ValueError("An event has a kind, and a response has a person and a strategy.")
        try:
            text = _to_json(dict(body))
        except RecursionError:
            raise ValueError("The body of an event is nested too deeply.") from None
        at = self._now().astimezone(UTC).isoformat(timespec="microseconds")
        answer = None if complied is None else int(complied)
        with self.transaction():
            row = (str(uuid.uuid4()), self._robot, at, kind, person, strategy, answer, text)
            return self._write(_ADD, row)

    @contextmanager
    def transaction(self) -> Iterator[None]:
        """Keep all that is appended inside or, after an exception, nothing of it.

        A nested transaction joins the outer one, which is kept or lost as a whole: an inner
        failure loses it even where it was caught, and the outer end then raises StoreError.
        Other threads wait meanwhile, so do not `await` inside: another task of the same thread
        would append into it.
        """
        with self._lock:
            outermost = not self._within
            if outermost:
                self._write("BEGIN IMMEDIATE")
                self._within = True
            try:
                yield
                if outermost:
                    self._write("COMMIT")
            except BaseException:
                self._spoilt = True
                raise
            finally:
                if outermost:
                    self._within = self._spoilt = False
                    if self._file.db is not None:
                        with suppress(sqlite3.Error):
                            self._file.db.rollback()  # after a commit: nothing

    def events(self, *kinds: str, after: int = 0) -> Iterator[Event]:
        """Yield the events of these kinds (of all, if none is named) with seq > `after`, by seq.

        They are those logged when the iteration begins; appending meanwhile is allowed.
        """
        newest = self._rows("SELECT coalesce(max(seq), 0) FROM event")
        until = newest[0][0] if newest else 0
        chosen = f"AND kind IN ({', '.join('?' * len(kinds))})" if kinds else ""
        sql = f"{_READ} WHERE seq > ? AND seq <= ? {chosen} ORDER BY seq"
        for low in range(max(after, 0), until, WINDOW):
            yield from map(self._event, self._rows(sql, low, min(low + WINDOW, until), *kinds))

    def last(self, kind: str) -> Event | None:
        """Return the newest event of a kind."""
        rows = self._rows(f"{_READ} WHERE kind = ? ORDER BY seq DESC LIMIT 1", kind)
        return self._event(rows[0]) if rows else None

    def responses(self) -> dict[tuple[str, str], tuple[int, int]]:
        """Count the responses that hold by (person, strategy): (complied, did not).

        One more than each is the posterior's alpha and beta (Eq. 2).
        """
        rows = self._rows(_RESPONSES)
        return {(person, strategy): (yes, no) for person, strategy, yes, no in rows}

    def answers(self, person: str) -> Iterator[Event]:
        """Yield every response of one person, also those that do not hold, by seq."""
        sql = f"{_READ} WHERE complied IS NOT NULL AND person = ? ORDER BY seq"
        return map(self._event, self._rows(sql, person))

    def now(self) -> datetime:
        """Return the time by the clock that events are stamped with."""
        return self._now().astimezone(UTC)

    def names(self) -> dict[str, str]:
        """Return the name of every person who has one, by id."""
        return dict(self._rows("SELECT person, name FROM name ORDER BY person"))

    def rename(self, person: str, name: str) -> None:
        """Give a person a name, and log that ("renamed"), but not the name.

        How another name was pronounced is forgotten.

        Raises:
            TangyError: the name is empty, longer than 40 characters, or not all printable.
        """
        if not name.strip():
            raise TangyError("A name must not be empty.")
        if not name.isprintable():
            raise TangyError(f"The name {plain(name)!r} holds a character that cannot be shown.")
        if len(name.strip()) > LONGEST_NAME:
            raise TangyError(f"A name must have at most {LONGEST_NAME} characters.")
        with self.transaction():
            if self.names().get(person) != name.strip():
                self._write("UPDATE speech SET pronunciation = NULL WHERE person = ?", (person,))
            self._write("INSERT OR REPLACE INTO name VALUES (?, ?)", (person, name.strip()))
            self.append("renamed", {}, person=person)

    def pronunciations(self) -> dict[str, str]:
        """Return how the names of people are pronounced, by id, of those who have that noted."""
        rows = self._rows("SELECT person, pronunciation FROM speech ORDER BY person")
        return {person: phones for person, phones in rows if phones is not None}

    def pronounce(self, person: str, phones: str | None) -> None:
        """Note how a person's name is pronounced (None: no more), and log that, but not how.

        Raises:
            ProfileError: one of the phones is none.
        """
        self._note(person, "pronunciation", None if phones is None else read_name_phones(phones))

    def voices(self) -> dict[str, VoicePreference]:
        """Return how people like to be spoken to, by id, of those who have that noted."""
        rows = self._rows("SELECT person, rate, voice FROM speech ORDER BY person")
        return {person: VoicePreference(rate, voice) for person, rate, voice in rows}

    def prefer_voice(self, person: str, preference: VoicePreference) -> None:
        """Note how a person likes to be spoken to, and log that, but not how."""
        with self.transaction():
            self._note(person, "rate", preference.rate)
            self._note(person, "voice", preference.voice)

    def _note(self, person: str, what: str, value: str | int | None) -> None:
        """Keep one thing about how to speak of or to a person, where it can be forgotten."""
        with self.transaction():
            self._write("INSERT OR IGNORE INTO speech (person) VALUES (?)", (person,))
            self._write(f"UPDATE speech SET {what} = ? WHERE person = ?", (value, person))  # noqa: S608
            self.append("speech noted", {"what": what}, person=person)

    def forget(self, person: str) -> bool:
        """Delete a person's name, how it is said, and how they like to be spoken to.

        What they did stays in the log, under their id. Logged as "forgotten".

        Returns:
            Whether there was anything to forget.
        """
        with self.transaction():
            there = any(
                self._rows(f"SELECT 1 FROM {table} WHERE person = ?", person)  # noqa: S608
                for table in NAMING
            )
            if there:
                for table in NAMING:
                    self._write(f"DELETE FROM {table} WHERE person = ?", (person,))  # noqa: S608
                self.append("forgotten", {}, person=person)
        return there

    def check(self) -> list[str]:
        """Read the whole log and return what is wrong with it, a sentence each ([]: nothing)."""
        wrong = []
        try:
            found = [" ".join(row.split()) for (row,) in self._rows("PRAGMA quick_check")]
            wrong += [f"{FILE}: {words}." for words in found if words != "ok"]
            for events, newest, different, answers, indexed, guards in self._rows(_COUNTS):
                if not events == different == newest:
                    sums = f"{newest} events were logged, {events} stand, {different} different"
                    wrong.append(f"{FILE}: {sums}.")
                if answers != indexed:
                    wrong.append(f"{FILE}: {indexed} of {answers} responses are in the index.")
                if guards < 2:
                    wrong.append(f"{FILE}: the guard against changing events is gone.")
            deque(self.events(), maxlen=0)
        except StoreError as error:
            wrong.append(str(error))
        return wrong

    def close(self) -> None:
        """Close the log and let another writer in; may be repeated."""
        with self._lock:
            self._closed = True
            self._file.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _begin(self) -> None:
        """Become the writer, and learn which robot's folder this is."""
        db = self._file.begin()
        db.execute("INSERT OR IGNORE INTO meta VALUES ('robot', ?)", (str(uuid.uuid4()),))
        self._robot = self._rows("SELECT value FROM meta WHERE key = 'robot'")[0][0]

    def _rows(self, sql: str, *values: object) -> list[Any]:
        """Return all rows of a query; none where there is no log yet."""
        with self._lock, self._file.in_words():
            if self._closed:
                raise self._file.wrong("is closed")
            db = self._file.db if self.writable else self._file.reading()
            return [] if db is None else db.execute(sql, values).fetchall()

    def _write(self, sql: str, values: tuple[object, ...] = ()) -> int:
        """Run one statement of the writer and return the seq it made."""
        db = self._file.db
        if db is None or not self.writable:
            raise self._file.wrong("is closed" if self._closed else "is open for reading only")
        if self._spoilt:  # SQLite may have rolled back already, and would commit this one alone
            raise self._file.wrong("a part of this could not be kept, so none of it was")
        with self._file.in_words():
            return db.execute(sql, values).lastrowid or 0

    def _event(self, row: tuple[Any, ...]) -> Event:
        try:
            complied = None if row[7] is None else bool(row[7])
            return Event._make((*row[:7], complied, json.loads(row[8])))
        except ValueError:
            raise self._file.wrong(f"event {row[0]} cannot be read") from None
