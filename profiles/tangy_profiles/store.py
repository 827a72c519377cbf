"""The append-only event log of one data folder, and what is counted out of it.

One process writes a folder at a time; any number may read beside it. Names of people stand in a
table of their own, so that they can be forgotten while the counts that beliefs are made of stay.
"""

from __future__ import annotations

import fcntl
import json
import os
import sqlite3
import uuid
from collections import deque
from collections.abc import Callable, Iterator, Mapping
from contextlib import closing, contextmanager, suppress
from datetime import UTC, datetime
from io import FileIO
from itertools import count
from pathlib import Path
from threading import RLock
from typing import Any, NamedTuple, Self

from tangy_profiles.errors import StoreBusy, StoreError, TangyError
from tangy_profiles.reading import plain

FILE = "tangy.db"
LONGEST_NAME = 40  # characters
ALWAYS_CHECKED = 16_000_000  # bytes: 13 ms of quick_check
WINDOW = 4096  # events fetched at a time, so that a slow reader never holds up a checkpoint

# No index on uuid: it costs a third of the appending speed for what only a merge asks.
MIGRATIONS: tuple[str, ...] = (
    """
    CREATE TABLE meta (key TEXT PRIMARY KEY, value TEXT NOT NULL);
    CREATE TABLE name (person TEXT PRIMARY KEY, name TEXT NOT NULL);
    CREATE TABLE event (
        seq INTEGER PRIMARY KEY, uuid TEXT NOT NULL, robot TEXT NOT NULL, at TEXT NOT NULL,
        kind TEXT NOT NULL, person TEXT, strategy TEXT, complied INTEGER, body TEXT NOT NULL
    );
    CREATE INDEX event_kind ON event (kind);
    CREATE INDEX event_response ON event (person, strategy, complied) WHERE complied IS NOT NULL;
    CREATE TRIGGER unchanged BEFORE UPDATE ON event BEGIN SELECT RAISE(ABORT, 'append only'); END;
    CREATE TRIGGER undeleted BEFORE DELETE ON event BEGIN SELECT RAISE(ABORT, 'append only'); END;
    """,
)
"""MIGRATIONS[n] takes a log from version n to n + 1; version 0 is an empty file."""

_READ = "SELECT seq, uuid, robot, at, kind, person, strategy, complied, body FROM event"
_ADD = """INSERT INTO event (uuid, robot, at, kind, person, strategy, complied, body)
    VALUES (?, ?, ?, ?, ?, ?, ?, ?)"""
_RESPONSES = """SELECT person, strategy, sum(complied), count(*) - sum(complied) FROM event
    WHERE complied IS NOT NULL GROUP BY person, strategy"""
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


def _hold(path: Path) -> tuple[FileIO, str]:
    """Become the folder's one writer; return the lock file and what the last writer left in it.

    The kernel drops the lock with the process. Removing the file would race with the next one.
    """
    file = FileIO(os.open(path, os.O_RDWR | os.O_CREAT, 0o600), "r+")
    left = file.read(200).decode(errors="replace")
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        file.close()
        who = f"process {left}" if left.isdecimal() else "another process"
        where = f"{who} is writing to {plain(str(path.parent))}"
        raise StoreBusy(f"{where}; close it, or choose another folder with --data.") from None
    os.fchmod(file.fileno(), 0o600)
    file.truncate(0)
    os.pwrite(file.fileno(), str(os.getpid()).encode(), 0)
    return file, left


class Store:
    """The log of one data folder; threads may share it (see `transaction`).

    Every method raises StoreError, one sentence, where the log cannot be read or written.
    """

    def __init__(self, folder: Path, writable: bool, now: Callable[[], datetime]) -> None:
        """Prepare a store that is not open yet; use `Store.open`."""
        self.folder = folder
        self.writable = writable
        self.notices: list[str] = []
        self._path = folder / FILE
        self._now = now
        self._lock = RLock()
        self._hold: FileIO | None = None
        self._db: sqlite3.Connection | None = None
        self._robot = ""
        self._closed = self._damaged = self._within = self._spoilt = False

    @classmethod
    def open(
        cls, folder: Path, *, write: bool = True, now: Callable[[], datetime] | None = None
    ) -> Store:
        """Open the log of a data folder; a writer makes folder and log where there are none.

        A damaged log is renamed aside and a new one begun, and `notices` says so. With
        `write=False` nothing is made: a folder without a log reads as empty until there is one.

        Raises:
            StoreBusy: another process writes to this folder.
            StoreError: the folder cannot be made, read or written, or a newer Tangy wrote it.
        """
        store = cls(folder.absolute(), write, now or (lambda: datetime.now(UTC)))
        try:
            with store._in_words():
                store._begin() if write else store._reading()
        except BaseException:
            store._damaged = True  # so that closing does not vouch for it
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
                    if self._db is not None:
                        with suppress(sqlite3.Error):
                            self._db.rollback()  # after a commit: nothing

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
        """Count the responses by (person, strategy): (complied, did not).

        One more than each is the posterior's alpha and beta (Eq. 2).
        """
        rows = self._rows(_RESPONSES)
        return {(person, strategy): (yes, no) for person, strategy, yes, no in rows}

    def names(self) -> dict[str, str]:
        """Return the name of every person who has one, by id."""
        return dict(self._rows("SELECT person, name FROM name ORDER BY person"))

    def rename(self, person: str, name: str) -> None:
        """Give a person a name, and log that ("renamed"), but not the name.

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
            self._write("INSERT OR REPLACE INTO name VALUES (?, ?)", (person, name.strip()))
            self.append("renamed", {}, person=person)

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
            db, hold, self._db, self._hold = self._db, self._hold, None, None
            self._closed = True
            if db is not None:
                with suppress(sqlite3.Error):
                    db.rollback()
                    if hold is not None:  # only the writer checkpoints
                        db.execute("PRAGMA wal_checkpoint(TRUNCATE)").fetchall()
                db.close()
            if hold is not None:
                if not self._damaged:
                    with suppress(OSError):
                        hold.truncate(0)
                        os.pwrite(hold.fileno(), self._mark().encode(), 0)
                hold.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _begin(self) -> None:
        """Become the writer of the folder: make it, hold it, check it, bring it up to date."""
        if not self.folder.exists():
            self.folder.mkdir(parents=True)
            self.folder.chmod(0o700)  # whatever the umask
        self._hold, left = _hold(self.folder / "tangy.lock")
        if not self._sound(left):
            self._set_aside()
        self._path.touch(0o600)
        # By path: closing a descriptor of ours would drop SQLite's own locks on the file. SQLite
        # gives -wal and -shm the mode of the log.
        self._path.chmod(0o600)
        db = self._db = self._connect()
        # secure_delete: a name that was replaced or forgotten must not stay on a free page.
        for setting in ("journal_mode=WAL", "synchronous=FULL", "secure_delete=ON"):
            db.execute(f"PRAGMA {setting}").fetchall()
        self._migrate(db)
        db.execute("INSERT OR IGNORE INTO meta VALUES ('robot', ?)", (str(uuid.uuid4()),))
        self._robot = self._rows("SELECT value FROM meta WHERE key = 'robot'")[0][0]

    def _reading(self) -> sqlite3.Connection | None:
        """Return the reader's connection, made as soon as there is a log to read."""
        if self._db is None and self._size():
            with closing(self._connect()) as db:
                ready = self._version(db) > 0  # 0: its writer is just making it
            if ready:
                self._db = self._connect()
                self._db.execute("PRAGMA query_only=ON")
        return self._db

    def _connect(self) -> sqlite3.Connection:
        # mode=rw never creates a file; a URI holds whatever characters a folder may have.
        uri = self._path.as_uri() + "?mode=rw"
        return sqlite3.connect(uri, uri=True, isolation_level=None, check_same_thread=False)

    def _size(self, end: str = "") -> int:
        """Return the bytes of the log, or of its tail ("-wal"); 0 where there is none."""
        with suppress(FileNotFoundError):
            return (self.folder / (FILE + end)).stat().st_size
        return 0

    def _mark(self) -> str:
        """Describe the log as it lies on the disk, to know it again."""
        return f"closed {self._size()} {self._path.stat().st_mtime_ns}"

    def _sound(self, left: str) -> bool:
        """Say whether the log is whole, and refuse that of a newer Tangy before touching it.

        quick_check reads the whole file: 115 ms for 500,000 small events (113 MB), 325 ms where
        their bodies have 600 bytes (421 MB), and that with the file in memory. A large log is
        therefore believed when it is, to the nanosecond, the file that the last clean close
        left; after a crash, a power cut, a copy or a restore it is not, and is read through.
        """
        if not self._size():
            return not self._size("-wal")  # SQLite would delete a tail without a log
        same = not self._size("-wal") and left == self._mark()
        with closing(self._connect()) as db:
            try:
                self._version(db)
                known = same and self._size() > ALWAYS_CHECKED
                return known or db.execute("PRAGMA quick_check(1)").fetchall() == [("ok",)]
            except sqlite3.DatabaseError as error:
                if not _tells_damage(error):
                    raise
                return False

    def _set_aside(self) -> None:
        """Rename a damaged log, its tail first: SQLite would replay a tail into a new log."""
        aside = self._unused("damaged")
        for end in ("-wal", "-shm", ""):
            with suppress(FileNotFoundError):
                (self.folder / (FILE + end)).rename(self.folder / (aside.name + end))
        notice = f"The log was damaged: it is kept as {aside}, and a new one was begun."
        self.notices.append(plain(notice))

    def _migrate(self, db: sqlite3.Connection) -> None:
        """Bring the log to this version, all steps or none, after copying it as it was."""
        old, new = self._version(db), len(MIGRATIONS)
        if old == new:
            return
        copy = self._unused(f"version-{old}")
        steps = "".join(MIGRATIONS[old:])
        try:
            if db.execute("SELECT 1 FROM sqlite_master").fetchone():
                copy.touch(0o600)
                with closing(sqlite3.connect(copy)) as target:
                    db.backup(target)
            db.executescript(f"BEGIN IMMEDIATE; {steps} PRAGMA user_version = {new}; COMMIT;")
        except sqlite3.Error as error:
            db.rollback()
            copy.unlink(missing_ok=True)  # of a log that is still as it was
            problem = f"is unchanged: it cannot be brought from version {old} to {new}"
            raise self._wrong(f"{problem} ({error})") from None

    def _version(self, db: sqlite3.Connection) -> int:
        """Return the version of the log, if it is one that can be used."""
        version: int = db.execute("PRAGMA user_version").fetchone()[0]
        known = len(MIGRATIONS)
        if version > known or (0 < version < known and not self.writable):
            whose = "a newer Tangy; update this one" if version > known else "an older Tangy"
            problem = f"was written (as version {version}; this is {known}) by {whose}"
            raise self._wrong(f"{problem}, or choose another folder with --data")
        return version

    def _unused(self, what: str) -> Path:
        """Name a file beside the log that does not exist yet, after the time."""
        at = self._now().astimezone(UTC).strftime("%Y%m%dT%H%M%SZ")
        paths = (self.folder / f"{FILE}.{what}-{at}{f'.{n}' if n else ''}" for n in count())
        return next(path for path in paths if not path.exists())

    def _rows(self, sql: str, *values: object) -> list[Any]:
        """Return all rows of a query; none where there is no log yet."""
        with self._lock, self._in_words():
            if self._closed:
                raise self._wrong("is closed")
            db = self._db if self.writable else self._reading()
            return [] if db is None else db.execute(sql, values).fetchall()

    def _write(self, sql: str, values: tuple[object, ...] = ()) -> int:
        """Run one statement of the writer and return the seq it made."""
        if self._db is None or not self.writable:
            raise self._wrong("is closed" if self._closed else "is open for reading only")
        if self._spoilt:  # SQLite may have rolled back already, and would commit this one alone
            raise self._wrong("a part of this could not be kept, so none of it was")
        with self._in_words():
            return self._db.execute(sql, values).lastrowid or 0

    def _event(self, row: tuple[Any, ...]) -> Event:
        try:
            complied = None if row[7] is None else bool(row[7])
            return Event._make((*row[:7], complied, json.loads(row[8])))
        except ValueError:
            raise self._wrong(f"event {row[0]} cannot be read") from None

    @contextmanager
    def _in_words(self) -> Iterator[None]:
        """Turn what SQLite or the file system refuse into one sentence."""
        try:
            yield
        except sqlite3.ProgrammingError:
            raise
        except sqlite3.Error as error:
            problem = f"cannot be used ({error}); choose another folder with --data"
            if _tells_damage(error):
                self._damaged = True
                problem = "is damaged; start Tangy again: it is set aside, and a new one begun"
            if "is full" in str(error):
                problem = "could not be added to, for the disk is full; make room and try again"
            raise self._wrong(problem) from None
        except OSError as error:
            reason = f"cannot be the data folder ({error.strerror}); choose another with --data"
            raise StoreError(f"{plain(str(self.folder))}: {reason}.") from None

    def _wrong(self, problem: str) -> StoreError:
        return StoreError(plain(f"{self._path}: {problem}."))


def _tells_damage(error: sqlite3.Error) -> bool:
    name = getattr(error, "sqlite_errorname", "")
    return str(name).startswith(("SQLITE_CORRUPT", "SQLITE_NOTADB"))
