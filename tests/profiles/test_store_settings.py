"""The SQLite settings that the log needs are set, verified, and required."""

import sqlite3
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest

from tangy_profiles import log_file
from tangy_profiles.errors import StoreError
from tangy_profiles.store import Store
from tests.support.append_body import append_body

connect = sqlite3.connect


def otherwise_built(monkeypatch: pytest.MonkeyPatch, deaf: str = "") -> None:
    """Build SQLite with its most careless defaults, and let one setting never take effect."""

    class Careless(sqlite3.Connection):
        def execute(self, sql: str, *values: Any) -> sqlite3.Cursor:
            if deaf and sql.startswith(f"PRAGMA {deaf}="):
                return super().execute("SELECT 1")
            return super().execute(sql, *values)

    def made(*where: Any, **how: Any) -> sqlite3.Connection:
        db: sqlite3.Connection = connect(*where, **how, factory=Careless)
        for setting in ("synchronous=OFF", "secure_delete=OFF"):
            sqlite3.Connection.execute(db, f"PRAGMA {setting}").fetchall()
        return db

    monkeypatch.setattr(sqlite3, "connect", made)


def asked(store: Store, setting: str) -> Any:
    """Ask the store's own connection for a setting."""
    db = store.file.db
    assert db is not None
    return db.execute(f"PRAGMA {setting}").fetchone()[0]


def test_each_commit_is_synced_with_any_build_of_sqlite(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    otherwise_built(monkeypatch)
    with Store.open(tmp_path) as store:
        assert asked(store, "synchronous") == 2, "FULL: one sync of the tail with each commit"
        assert asked(store, "journal_mode") == "wal"
        assert asked(store, "secure_delete") == 1


@pytest.mark.parametrize("setting", ["synchronous", "secure_delete", "journal_mode"])
def test_a_log_without_the_required_sqlite_settings_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, setting: str
) -> None:
    otherwise_built(monkeypatch, deaf=setting)
    with pytest.raises(StoreError) as refused:
        Store.open(tmp_path)
    said = str(refused.value)
    assert str(tmp_path) in said and setting in said and "--data" in said
    monkeypatch.undo()
    with Store.open(tmp_path) as store:
        assert (append_body(store, "greeting", {}), store.notices) == (1, []), (
            "nothing was left behind"
        )


def test_a_disk_without_support_for_wal_is_refused_in_one_sentence(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def on_a_simple_disk(file: str, **how: Any) -> sqlite3.Connection:
        made: sqlite3.Connection = connect(f"{file}&vfs=unix-dotfile", **how)  # no shared memory
        return made

    monkeypatch.setattr(sqlite3, "connect", on_a_simple_disk)
    with pytest.raises(StoreError, match="journal_mode at delete, not WAL; choose a folder"):
        Store.open(tmp_path)


def test_the_connection_of_a_console_is_read_only(tmp_path: Path) -> None:
    with Store.open(tmp_path) as store:
        store.rename("user1", "Rosa")
        with Store.open(tmp_path, write=False) as console:
            assert console.names() == {"user1": "Rosa"}
            db = console.file.db
            assert db is not None
            for change in ("DELETE FROM name", "INSERT INTO meta VALUES ('a', 'b')"):
                with pytest.raises(sqlite3.OperationalError, match="readonly"):
                    db.execute(change)
        assert store.names() == {"user1": "Rosa"}


def test_a_writable_console_connection_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    Store.open(tmp_path).close()
    otherwise_built(monkeypatch, deaf="query_only")
    with pytest.raises(StoreError, match="query_only at 0, not ON"):
        Store.open(tmp_path, write=False)


def test_a_log_migrated_by_a_reader_is_marked_as_checked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Otherwise the next writer would check a large log again although it has not changed."""
    with monkeypatch.context() as older:
        older.setattr(log_file, "MIGRATIONS", log_file.MIGRATIONS[:1])
        with Store.open(tmp_path) as store:
            append_body(store, "greeting", {})
    Store.open(tmp_path, write=False).close()
    read: list[str] = []

    def watched(*where: Any, **how: Any) -> sqlite3.Connection:
        db: sqlite3.Connection = connect(*where, **how)
        db.set_trace_callback(read.append)
        return db

    monkeypatch.setattr(log_file, "ALWAYS_CHECKED", 1000)
    monkeypatch.setattr(sqlite3, "connect", watched)
    with Store.open(tmp_path) as store:
        assert append_body(store, "joke", {}) == 2
    assert read and not any("quick_check" in sql for sql in read)
    with closing(connect(tmp_path / "tangy.db")) as db:
        assert db.execute("PRAGMA user_version").fetchone() == (len(log_file.MIGRATIONS),)
