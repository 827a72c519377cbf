"""The append-only event log of one data folder, and the counts derived from it.

One process writes a folder at a time; any number may read it (see `log_file`). People's names are
in a table of their own, and their pronunciations and voices in another, so that they can be
forgotten while the counts behind beliefs stay. A name in typed or spoken text is then erased from
there (`erased_log`), the only change ever made to events.
"""

from __future__ import annotations

import json
import sqlite3
import uuid
from collections import deque
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from contextlib import contextmanager, nullcontext, suppress
from datetime import UTC, datetime
from pathlib import Path
from threading import RLock
from typing import TYPE_CHECKING, Any, Self, TypeVar, overload

from tangy_profiles.codec import InvalidValue
from tangy_profiles.erased_log import count_left, erase_from_log
from tangy_profiles.errors import ProfileError, StoreError
from tangy_profiles.events import EventRecord, read_record
from tangy_profiles.log_file import FILE, NAMING, LogFile
from tangy_profiles.losses import SEALED, count_mismatches, loss_words, newest, unnoticed
from tangy_profiles.people_records import EventsLost, LossAccepted, PersonForgotten, Renamed
from tangy_profiles.people_records import SpeechNoted as SpeechNoted
from tangy_profiles.person import read_name
from tangy_profiles.phones import read_name_phones
from tangy_profiles.queries import ADD, LARGEST_SEQ, NEXT, READ, fetch, responses_among
from tangy_profiles.records import name_of
from tangy_profiles.rows import LARGEST_BODY, BadRow, are_text, left_out, read_row
from tangy_profiles.rows import Event as Event
from tangy_profiles.seal import Seal
from tangy_profiles.voice import VoicePreference

if TYPE_CHECKING:
    from tangy_profiles.erasure import NameEraser

R = TypeVar("R", bound=EventRecord)

WINDOW = 4096  # events fetched at a time, so that a slow reader never holds up a checkpoint

_to_json = json.JSONEncoder(allow_nan=False, ensure_ascii=False, separators=(",", ":")).encode


class Store:
    """The log of one data folder; threads may share it (see `transaction`).

    Every method raises StoreError, one sentence, if the log cannot be read or written.
    """

    def __init__(self, folder: Path, writable: bool, now: Callable[[], datetime]) -> None:
        """Create a store that is not open yet; use `Store.open`."""
        self.folder = folder
        self.writable = writable
        self._now = now
        self._lock = RLock()
        self.file = LogFile(folder, writable, now)
        """The file of the log, for readers of the file itself."""
        self.notices = self.file.notices
        self.aside: dict[int, str] = {}
        """Events left out of the log: a sentence for each, by seq."""
        self.robot = ""  # the id of the robot of the log; "" in a reader
        self._seal = Seal(folder)
        self._newest = 0  # the newest event of the current transaction
        self._closed = self._within = self._spoilt = False

    @classmethod
    def open(
        cls, folder: Path, *, write: bool = True, now: Callable[[], datetime] | None = None
    ) -> Store:
        """Open the log of a data folder; a writer creates missing folders and logs.

        A damaged log is renamed and a new one begun, as `notices` says. With `write=False` nothing
        is created: a folder without a log reads as empty until there is one. An older log is
        migrated, by a reader only if possible.

        Raises:
            StoreBusy: another process writes to this folder.
            StoreError: the folder cannot be created, read or written, or a newer version wrote it.
        """
        store = cls(folder.absolute(), write, now or (lambda: datetime.now(UTC)))
        try:
            with store.file.in_words():
                store._begin() if write else store.file.reading()
            with nullcontext() if write else suppress(StoreError):  # queries report it
                store.notices.extend(map(loss_words, store._unaccepted()))
        except BaseException:
            store.file.damaged = True  # so that closing leaves no mark
            store.close()
            raise
        return store

    def append(
        self,
        record: EventRecord,
        *,
        person: str | None = None,
        strategy: str | None = None,
        complied: bool | None = None,
    ) -> int:
        """Log one event and return its seq; outside a `transaction` it is on the disk then.

        Raises:
            ValueError, TypeError: a bug of the caller: a body that is not JSON (NaN, too deep), too
                long, or invalid for its kind; no kind; or `complied` without person and strategy.
            StoreError: it could not be stored, and nothing was.
        """
        kind, of_nobody = record.KIND, person is None or strategy is None
        if not kind or (complied is not None and of_nobody):
            raise ValueError("An event has a kind, and a response has a person and a strategy.")
        try:
            text = _to_json(record.body)
            read_record(kind, person, strategy, json.loads(text))
        except RecursionError:
            raise ValueError("The body of an event is nested too deeply.") from None
        except InvalidValue as why:
            raise ValueError(f"An event of the kind {kind!r} {why}.") from None
        if len(text) > LARGEST_BODY:
            raise ValueError("The body of an event is too long.")
        at = self._now().astimezone(UTC).isoformat(timespec="microseconds")
        answer = None if complied is None else int(complied)  # whether `person` followed `strategy`
        with self.transaction():
            row = (str(uuid.uuid4()), self.robot, at, kind, person, strategy, answer, text)
            self._newest = self._write(ADD, row)
            return self._newest

    @contextmanager
    def transaction(self) -> Iterator[None]:
        """Commit all events appended inside, or, after an exception, none of them.

        A nested transaction joins the outer one, which is committed or rolled back as a whole: an
        inner failure rolls it back even if it was caught, and the end of the outer one then raises
        StoreError. Other threads wait meanwhile, so do not `await` inside: another task of the same
        thread would append to it.
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
                    if self._newest:
                        self._seal.write(self.robot, self._newest)
            except BaseException:
                self._spoilt = True
                raise
            finally:
                if outermost:
                    self._within = self._spoilt = False
                    self._newest = 0
                    if self.file.db is not None:
                        with suppress(sqlite3.Error):
                            self.file.db.rollback()  # no-op after a commit

    @overload
    def events(self, *kinds: str, after: int = 0) -> Iterator[Event[EventRecord]]: ...
    @overload
    def events(self, *kinds: type[R], after: int = 0) -> Iterator[Event[R]]: ...
    def events(self, *kinds: type[EventRecord] | str, after: int = 0) -> Iterator[Event[Any]]:
        """Yield the events of these kinds (default: all) with seq > `after`, by seq.

        A kind is named by its record. The events are those logged when the iteration begins;
        appending meanwhile is allowed. Invalid ones are left out and reported in `aside`.
        """
        newest = self._rows("SELECT coalesce(max(seq), 0) FROM event")
        until = newest[0][0] if newest else 0
        chosen = f"AND kind IN ({', '.join('?' * len(kinds))})" if kinds else ""
        sql = f"{READ} WHERE seq > ? AND seq <= ? {chosen} ORDER BY seq"
        low = max(after, 0)
        while low < until:
            high = min(low + WINDOW, until)
            rows = self._rows(sql, low, high, *map(name_of, kinds))
            yield from self._events(rows)
            # a damaged seq may be far beyond all others
            low = high if rows else self._rows(NEXT, high, high)[0][0]

    @overload
    def last(self, kind: str) -> Event[EventRecord] | None: ...
    @overload
    def last(self, kind: type[R]) -> Event[R] | None: ...
    def last(self, kind: type[EventRecord] | str) -> Event[Any] | None:
        """Return the newest readable event of a kind."""
        sql = f"{READ} WHERE kind = ? AND seq < ? ORDER BY seq DESC LIMIT 1"
        rows = self._rows(sql, name_of(kind), LARGEST_SEQ)
        while rows:
            if found := list(self._events(rows)):
                return found[0]
            rows = self._rows(sql, name_of(kind), rows[0][0])
        return None

    def kinds(self) -> dict[str, int]:
        """Return the number of events of each kind; an invalid kind is shown as its repr."""
        rows = self._rows("SELECT kind, count(*) FROM event GROUP BY kind ORDER BY kind")
        return {kind if isinstance(kind, str) else repr(kind): count for kind, count in rows}

    def set_aside(self, event: Event[EventRecord], why: str) -> None:
        """Leave out an event that is inconsistent with earlier ones; `why` is the reason."""
        self.aside.setdefault(event.seq, left_out(event.seq, event.kind, why))

    def responses(
        self, of: Collection[str] | None = None, *, but: Collection[str] = ()
    ) -> dict[tuple[str, str], tuple[int, int]]:
        """Count the valid responses by (person, strategy): (complied, did not).

        One more than each is the posterior's alpha and beta (Eq. 2).

        Args:
            of: the ids of the games whose responses count, and the worlds, for responses that
                belong to no game; None: all of them.
            but: the games and worlds whose responses do not count.
        """
        rows = self._rows(*responses_among(of, but))
        return {(person, strategy): (yes, no) for person, strategy, yes, no in rows}

    def answers(self, person: str) -> Iterator[Event[EventRecord]]:
        """Yield every response of one person, also invalid ones, by seq."""
        sql = f"{READ} WHERE complied IS NOT NULL AND person = ? ORDER BY seq"
        return self._events(self._rows(sql, person))

    def now(self) -> datetime:
        """Return the time by the clock of the log."""
        return self._now().astimezone(UTC)

    def names(self) -> dict[str, str]:
        """Return the names of people, by id."""
        rows = self._rows("SELECT person, name FROM name ORDER BY person")
        return {person: name for person, name in rows if are_text(person, name)}

    def rename(self, person: str, name: str) -> None:
        """Give a person a name, and log that ("renamed"), but not the name.

        The pronunciation of an earlier name is deleted.

        Raises:
            TangyError: the name is empty, longer than 40 characters, or not all printable.
        """
        name = read_name(name)
        with self.transaction():
            if self.names().get(person) != name:
                self._write("UPDATE speech SET pronunciation = NULL WHERE person = ?", (person,))
            self._write("INSERT OR REPLACE INTO name VALUES (?, ?)", (person, name))
            self.append(Renamed(), person=person)

    def pronunciations(self) -> dict[str, str]:
        """Return the stored pronunciations of people's names, by id."""
        rows = self._rows("SELECT person, pronunciation FROM speech ORDER BY person")
        return {person: phones for person, phones in rows if are_text(person, phones)}

    def pronounce(self, person: str, phones: str | None) -> None:
        """Store the pronunciation of a person's name (None: delete); log only that.

        Raises:
            ProfileError: a phone is invalid.
        """
        self._note(person, "pronunciation", None if phones is None else read_name_phones(phones))

    def voices(self) -> dict[str, VoicePreference]:
        """Return the stored voice preferences of people, by id."""
        rows = self._rows("SELECT person, rate, voice FROM speech ORDER BY person")
        found = {}
        for person, rate, voice in rows:
            with suppress(ProfileError):  # skip invalid preferences
                found[person] = VoicePreference(rate, voice)
        return found

    def prefer_voice(self, person: str, preference: VoicePreference) -> None:
        """Store how a person likes to be spoken to, and log that, but not the value."""
        with self.transaction():
            self._note(person, "rate", preference.rate)
            self._note(person, "voice", preference.voice)

    def _note(self, person: str, what: str, value: str | int | None) -> None:
        """Store one speech setting of a person, in a table that can be forgotten."""
        with self.transaction():
            self._write("INSERT OR IGNORE INTO speech (person) VALUES (?)", (person,))
            self._write(f"UPDATE speech SET {what} = ? WHERE person = ?", (value, person))  # noqa: S608
            self.append(SpeechNoted(what=what), person=person)

    def forget(self, person: str, eraser: NameEraser | None = None) -> tuple[bool, int]:
        """Delete a person's name, pronunciation and voice preference.

        Their events stay, under their id. An `eraser` erases the name from texts in the log.

        Returns:
            Whether there was anything to delete, and the number of changed events.
        """
        with self.transaction():
            there = any(
                self._rows(f"SELECT 1 FROM {table} WHERE person = ?", person)  # noqa: S608
                for table in NAMING
            )
            for table in NAMING:
                self._write(f"DELETE FROM {table} WHERE person = ?", (person,))  # noqa: S608
            changed = 0
            if eraser and (db := self.file.db):
                with self.file.in_words():
                    changed = erase_from_log(db, eraser)
            if there or changed:
                self.append(PersonForgotten(texts=changed), person=person)
        if eraser:
            with self._lock, self.file.in_words():
                self.file.compact()
        return there, changed

    def count_left(self, eraser: NameEraser) -> int:
        """Count the events that still have a name after its erasure."""
        with self._lock, self.file.in_words():
            return count_left(self.file.db, eraser) if self.file.db else 0

    def check(self) -> list[str]:
        """Read the whole log and return its problems, a sentence each."""
        wrong = []
        try:
            found = [" ".join(row.split()) for (row,) in self._rows("PRAGMA quick_check")]
            wrong += [f"{FILE}: {words}." for words in found if words != "ok"]
            wrong += count_mismatches(self._rows, (e.record for e in self.events(EventsLost)))
            wrong += map(loss_words, self._unaccepted())
            deque(self.events(), maxlen=0)
        except StoreError as error:
            wrong.append(str(error))
        return wrong + [self.aside[seq] for seq in sorted(self.aside)]

    def close(self) -> None:
        """Close the log and release its lock; idempotent."""
        with self._lock:
            self._closed = True
            self._seal.close()
            self.file.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def accept_losses(self) -> list[EventsLost]:
        """Accept the losses, so that they are not reported again; return them."""
        if losses := self._unaccepted():
            self.append(LossAccepted())
        return losses

    def _unaccepted(self) -> list[EventsLost]:
        """Return the losses of this log that were not accepted yet."""
        sealed = self._seal.read()  # before the events, so that it is never ahead
        noted = self._noted()
        return [*noted, *unnoticed(self._rows, sealed, noted)]

    def _noted(self) -> list[EventsLost]:
        accepted = self.last(LossAccepted)
        return [e.record for e in self.events(EventsLost, after=accepted.seq if accepted else 0)]

    def _begin(self) -> None:
        """Become the writer, read the robot's id, and log the losses."""
        db = self.file.begin()
        sealed = self._seal.read()  # of a log that lost even its first events
        robot = sealed[0] if sealed else str(uuid.uuid4())
        db.execute("INSERT OR IGNORE INTO meta VALUES ('robot', ?)", (robot,))
        self.robot = self._rows("SELECT value FROM meta WHERE key = 'robot'")[0][0]
        for loss in (*self.file.lost, *unnoticed(self._rows, sealed, self._noted())):
            self.append(loss)
        db.execute(SEALED)
        self._seal.write(self.robot, newest(self._rows))

    def _rows(self, sql: str, *values: object) -> list[Any]:
        """Return all rows of a query; none if there is no log yet."""
        with self._lock, self.file.in_words():
            if self._closed:
                raise self.file.wrong("is closed")
            db = self.file.db if self.writable else self.file.reading()
            return [] if db is None else fetch(db, sql, values)

    def _write(self, sql: str, values: tuple[object, ...] = ()) -> int:
        """Run one writing statement and return the seq of the new row."""
        db = self.file.db
        if db is None or not self.writable:
            raise self.file.wrong("is closed" if self._closed else "is open for reading only")
        if self._spoilt:  # SQLite may have rolled back, and would commit this alone
            raise self.file.wrong("a part of this could not be kept, so none of it was")
        with self.file.in_words():
            return db.execute(sql, values).lastrowid or 0

    def _events(self, rows: Iterable[Sequence[Any]]) -> Iterator[Event[EventRecord]]:
        """Yield the events of rows; if the body of a response is invalid, the response counts."""
        for row in rows:
            try:
                yield read_row(row)
            except BadRow as bad:
                stays = bad.event if bad.event and bad.event.complied is not None else None
                rest = ", but for the answer" if stays else ""
                self.aside.setdefault(row[0], left_out(row[0], row[4], str(bad), rest))
                if stays:
                    yield stays
