"""The database file of a data folder's log: its single writer, integrity, and migrations."""

from __future__ import annotations

import fcntl
import os
import sqlite3
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager, suppress
from datetime import UTC, datetime
from io import FileIO
from itertools import count
from pathlib import Path

from tangy_profiles import seal
from tangy_profiles.errors import StoreBusy, StoreError
from tangy_profiles.people_records import EventsLost
from tangy_profiles.reading import plain
from tangy_profiles.salvage import salvage

FILE = "tangy.db"
ALWAYS_CHECKED = 16_000_000  # bytes: 13 ms of quick_check

_SPEECH = "TABLE speech (person TEXT PRIMARY KEY, pronunciation TEXT, rate INTEGER, voice TEXT);"
# No index on uuid: it costs a third of the append speed, and only a merge needs it.
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
    f"CREATE {_SPEECH}",
)
"""MIGRATIONS[n] takes a log from version n to n + 1; version 0 is an empty file."""
INSTEAD = {1: f"CREATE TEMP {_SPEECH}"}
"""Temporary substitutes for migrations that a reader cannot run."""
NAMING = ("name", "speech")
"""The tables with people's names."""


class LogFile:
    """The file of one log and the connection to it: `begin` to write it, `reading` to read it.

    Errors of SQLite and the file system are raised as they are; `in_words` turns them into one
    sentence. It is not thread-safe: its `Store` serialises access.
    """

    def __init__(self, folder: Path, writable: bool, now: Callable[[], datetime]) -> None:
        """Set the paths; nothing is opened yet."""
        self.folder = folder
        self.path = folder / FILE
        self.writable = writable
        self.notices: list[str] = []
        self.db: sqlite3.Connection | None = None
        self.damaged = False  # closing a damaged log leaves no mark
        self.lost: list[EventsLost] = []
        """The events of a damaged log that could not be recovered."""
        self._behind = False  # a reader's log has an older version
        self._held: FileIO | None = None
        self._now = now

    def begin(self) -> sqlite3.Connection:
        """Become the writer of the folder: create, lock, check, and migrate it."""
        if not self.folder.exists():
            self.folder.mkdir(parents=True)
            self.folder.chmod(0o700)  # independent of the umask
        self._held, left = hold(self.folder / "tangy.lock")
        if self._sound(left):
            return self._take_up()
        sealed = seal.Seal(self.folder).read()
        aside = self._set_aside()
        db = self._take_up()
        self._take_over(aside, db, sealed)
        return db

    def _take_up(self) -> sqlite3.Connection:
        """Open the log for its writer, and migrate it."""
        self.path.touch(0o600)
        # By path: closing a descriptor would drop SQLite's own locks on the file. SQLite gives -wal
        # and -shm the mode of the log.
        self.path.chmod(0o600)
        db = self.db = self._connect()
        # secure_delete: a name that was replaced or forgotten must not stay on a free page.
        self._settle(db, "secure_delete", "ON", 1)
        self._settle(db, "synchronous", "FULL", 2)
        self._settle(db, "journal_mode", "WAL", "wal")
        self._migrate(db)
        return db

    def reading(self) -> sqlite3.Connection | None:
        """Return the reader's connection, made as soon as there is a log to read.

        A log of an older version is migrated first, as its writer would do. If another process
        writes to it, or it is read-only, it is read as it is.
        """
        if self.db is not None and self._behind and self._version(self.db) == len(MIGRATIONS):
            self.db.close()  # its writer has migrated it meanwhile
            self.db = None
        if self.db is None and self._size():
            with closing(self._connect()) as db:
                version = self._version(db)
            if 0 < version < len(MIGRATIONS):
                version = self._bring_up_to_date() or version
            if version:  # 0: its writer is just creating it
                db = self._connect()
                self._behind = version < len(MIGRATIONS)
                if self._behind:
                    steps = range(version, len(MIGRATIONS))
                    instead = "".join(INSTEAD.get(step, "") for step in steps)
                    db.executescript(f"PRAGMA temp_store=MEMORY; {instead}")
                try:
                    self._settle(db, "query_only", "ON", 1)
                except BaseException:
                    db.close()
                    raise
                self.db = db
        return self.db

    def _settle(self, db: sqlite3.Connection, setting: str, wanted: str, granted: object) -> None:
        """Set a pragma and verify it, because SQLite ignores unsupported values silently.

        Raises:
            StoreError: it was not set, so the log would not be safe.
        """
        db.execute(f"PRAGMA {setting}={wanted}").fetchall()
        found = db.execute(f"PRAGMA {setting}").fetchone()
        if found != (granted,):
            is_now = found[0] if found else "unknown"
            problem = f"cannot be kept safely here: SQLite leaves {setting} at {is_now}, not"
            raise self.wrong(f"{problem} {wanted}; choose a folder on another disk with --data")

    def _bring_up_to_date(self) -> int:
        """Migrate an intact older log; return its version then, 0 if not done."""
        writer = LogFile(self.folder, True, self._now)
        writer.damaged = True  # until it has been checked
        try:
            writer._held, left = hold(self.folder / "tangy.lock")
            if not writer._sound(left):
                return 0  # the next writer sets it aside
            version = writer._version(writer._take_up())
            writer.damaged = False
            return version
        except (sqlite3.Error, OSError, StoreError):
            return 0
        finally:
            writer.close()

    def close(self) -> None:
        """Close the connection and release the lock; idempotent."""
        db, held, self.db, self._held = self.db, self._held, None, None
        if db is not None:
            with suppress(sqlite3.Error):
                db.rollback()
                if held is not None:  # only the writer checkpoints
                    db.execute("PRAGMA wal_checkpoint(TRUNCATE)").fetchall()
            db.close()
        if held is not None:
            if not self.damaged:
                with suppress(OSError):
                    held.truncate(0)
                    os.pwrite(held.fileno(), self._mark().encode(), 0)
            held.close()

    def compact(self) -> None:
        """Rewrite the log, so that no deleted text is left in its bytes.

        Raises:
            StoreError: another process reads it, so the write-ahead log has to stay for now.
        """
        db = self.db
        if db is None:
            return
        self._fold(db)
        db.execute("VACUUM")
        self._fold(db)

    def _fold(self, db: sqlite3.Connection) -> None:
        """Checkpoint the write-ahead log and truncate it."""
        busy, *_ = db.execute("PRAGMA wal_checkpoint(TRUNCATE)").fetchone()
        if busy:
            raise self.wrong(
                "what was erased is still in its tail, for another program is reading it: close "
                "that, and forget once more"
            )

    @contextmanager
    def in_words(self) -> Iterator[None]:
        """Turn errors of SQLite or the file system into one sentence.

        Raises:
            StoreError: the sentence.
        """
        try:
            yield
        except sqlite3.ProgrammingError:
            raise
        except sqlite3.Error as error:
            problem = f"cannot be used ({error}); choose another folder with --data"
            if _tells_damage(error):
                self.damaged = True
                problem = "is damaged; `tangy teach` takes what can be read into a new one"
            if "is full" in str(error):
                problem = "could not be added to, for the disk is full; make room and try again"
            raise self.wrong(problem) from None
        except OSError as error:
            reason = f"cannot be the data folder ({error.strerror}); choose another with --data"
            raise StoreError(f"{plain(str(self.folder))}: {reason}.") from None

    def wrong(self, problem: str) -> StoreError:
        """Return an error that names this log and its problem, in one sentence."""
        return StoreError(plain(f"{self.path}: {problem}."))

    def _connect(self) -> sqlite3.Connection:
        # mode=rw never creates a file; a URI works for any characters in the path.
        uri = self.path.as_uri() + "?mode=rw"
        if not self.writable and not self._size("-wal") and is_read_only(self.folder):
            uri += "&immutable=1"  # else SQLite creates -shm, even to read
        return sqlite3.connect(uri, uri=True, isolation_level=None, check_same_thread=False)

    def _size(self, end: str = "") -> int:
        """Return the size in bytes of the log, or of its "-wal"; 0 if it does not exist."""
        with suppress(FileNotFoundError):
            return (self.folder / (FILE + end)).stat().st_size
        return 0

    def _mark(self) -> str:
        """Return a fingerprint of the log file, to detect changes after closing."""
        return f"closed {self._size()} {self.path.stat().st_mtime_ns}"

    def _sound(self, left: str) -> bool:
        """Return whether the log is intact; reject a log of a newer version first.

        quick_check reads the whole file: 115 ms for 500,000 small events (113 MB), 325 ms for
        bodies of 600 bytes (421 MB), with the file in memory. So a large log is trusted if its
        fingerprint is the one of the last clean close; after a crash, a power cut, a copy or a
        restore it is not, and is read completely.
        """
        if not self._size():
            return not self._size("-wal")  # SQLite would delete a -wal without a log
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

    def _take_over(
        self, aside: Path, db: sqlite3.Connection, sealed: tuple[str, int] | None
    ) -> None:
        """Recover the readable part of a damaged log, and report the result."""
        kept, lost = salvage(aside, db, sealed[1] if sealed else 0)
        self.lost = [EventsLost(first=first, last=last, damaged=True) for first, last in lost]
        notice = f"The log was damaged: it is kept as {aside}, and a new one was begun."
        if sealed:
            db.execute("INSERT OR IGNORE INTO meta VALUES ('robot', ?)", sealed[:1])
        if kept:
            db.execute("DELETE FROM meta WHERE key = 'sealed'")  # the seal was set aside too
            notice = f"{notice[:-1]} with the {kept} events that could be read."
        self.notices.append(plain(notice))

    def _set_aside(self) -> Path:
        """Rename a damaged log, its -wal first: SQLite would replay that into a new log."""
        aside = self._unused("damaged")
        for end in ("-wal", "-shm", ""):
            with suppress(FileNotFoundError):
                (self.folder / (FILE + end)).rename(self.folder / (aside.name + end))
        with suppress(OSError):  # its count does not apply to the new log
            (self.folder / seal.FILE).rename(self.folder / aside.name.replace(FILE, seal.FILE, 1))
        return aside

    def _migrate(self, db: sqlite3.Connection) -> None:
        """Migrate the log to the current version, in one transaction, after copying it.

        The copy stays, so it has no names: anyone who goes back to it has every event, and names
        the people again.
        """
        old, new = self._version(db), len(MIGRATIONS)
        if old == new:
            return
        copy = self._unused(f"version-{old}")
        steps = "".join(MIGRATIONS[old:])
        try:
            if db.execute("SELECT 1 FROM sqlite_master").fetchone():
                self._copy(db, copy)
            db.executescript(f"BEGIN IMMEDIATE; {steps} PRAGMA user_version = {new}; COMMIT;")
        except sqlite3.Error as error:
            db.rollback()
            copy.unlink(missing_ok=True)  # the log is unchanged, so it is not needed
            problem = f"is unchanged: it cannot be brought from version {old} to {new}"
            raise self.wrong(f"{problem} ({error})") from None

    def _copy(self, db: sqlite3.Connection, copy: Path) -> None:
        """Copy the log without names; the copy gets its final name only when complete."""
        begun = self.folder / f"{FILE}.copying"
        begun.unlink(missing_ok=True)  # of an interrupted copy, perhaps with names
        begun.touch(0o600)
        try:
            with closing(sqlite3.connect(begun, isolation_level=None)) as target:
                db.backup(target)
                for setting in ("journal_mode=MEMORY", "secure_delete=ON"):
                    target.execute(f"PRAGMA {setting}").fetchall()
                there = target.execute("SELECT name FROM sqlite_master WHERE type = 'table'")
                for table in {name for (name,) in there.fetchall()}.intersection(NAMING):
                    target.execute(f"DELETE FROM {table}")  # noqa: S608
            begun.rename(copy)
        finally:
            begun.unlink(missing_ok=True)

    def _version(self, db: sqlite3.Connection) -> int:
        """Return the version of the log, if it is supported."""
        version: int = db.execute("PRAGMA user_version").fetchone()[0]
        known = len(MIGRATIONS)
        if version > known:
            problem = f"was written (as version {version}; this is {known}) by a newer Tangy"
            raise self.wrong(f"{problem}; update this one, or choose another folder with --data")
        return version

    def _unused(self, what: str) -> Path:
        """Return the path of a new file beside the log, with a timestamp."""
        at = self._now().astimezone(UTC).strftime("%Y%m%dT%H%M%SZ")
        paths = (self.folder / f"{FILE}.{what}-{at}{f'.{n}' if n else ''}" for n in count())
        return next(path for path in paths if not path.exists())


def hold(path: Path) -> tuple[FileIO, str]:
    """Lock the folder for writing; return the lock file and the text of the last writer in it.

    The kernel releases the lock when the process ends. Removing the file would race with the next
    writer.

    Raises:
        StoreBusy: another process holds it.
    """
    file = FileIO(os.open(path, os.O_RDWR | os.O_CREAT, 0o600), "r+")
    left = file.read(200).decode(errors="replace")
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        file.close()
        process = f" (process {left})" if left.isdecimal() else ""
        where = f"another Tangy{process} is writing to {plain(str(path.parent))}"
        raise StoreBusy(f"{where}: close it, or choose another folder with --data.") from None
    os.fchmod(file.fileno(), 0o600)
    file.truncate(0)
    os.pwrite(file.fileno(), str(os.getpid()).encode(), 0)
    return file, left


def is_read_only(folder: Path) -> bool:
    """Return whether a folder is on a read-only file system."""
    return bool(os.statvfs(folder).f_flag & os.ST_RDONLY)


def _tells_damage(error: sqlite3.Error) -> bool:
    name = getattr(error, "sqlite_errorname", "")
    return str(name).startswith(("SQLITE_CORRUPT", "SQLITE_NOTADB"))
