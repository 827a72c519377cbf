"""The guarantees of the log: acknowledged events stay, in order and once; only one writer."""

import json
import os
import sqlite3
import stat
import subprocess
import sys
import tempfile
import threading
from collections.abc import Iterator
from contextlib import closing, suppress
from datetime import UTC, datetime, timedelta, timezone
from itertools import islice
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tangy_profiles import log_file
from tangy_profiles import store as store_module
from tangy_profiles.errors import StoreBusy, StoreError, TangyError
from tangy_profiles.people_records import ResponseGiven
from tangy_profiles.store import Event, Store
from tests.support.append_body import append_body
from tests.support.laws import tried

NOON = datetime(2026, 3, 4, 12, 0, 0, 250, tzinfo=UTC)


class Mishap(Exception):
    """An error inside a transaction."""


@pytest.fixture
def store(tmp_path: Path) -> Iterator[Store]:
    with Store.open(tmp_path / "log", now=lambda: NOON) as opened:
        yield opened


def log_of(folder: Path) -> Path:
    return folder / "tangy.db"


def rebuild(folder: Path, sql: str) -> None:
    """Change the log without Tangy's own code."""
    with closing(sqlite3.connect(log_of(folder))) as db:
        db.executescript(sql)


def mode_of(path: Path) -> int:
    return stat.S_IMODE(path.stat().st_mode)


# Laws

texts = st.text(max_size=8)
scalars = st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | texts
values = st.recursive(
    scalars.filter(lambda v: not isinstance(v, float) or abs(v) != float("inf")),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(texts, inner, max_size=3),
    max_leaves=6,
)
people = st.sampled_from(["p1", "p2", "Ω"])
strategies = st.sampled_from(["praise", "logic"])
facts = st.fixed_dictionaries(
    {
        "kind": st.sampled_from(["behaviour", "state", "answer"]),
        "body": st.dictionaries(texts, values, max_size=3),
    },
    optional={"person": people | st.none(), "strategy": strategies | st.none()},
)
answers = st.builds(
    lambda **words: {"kind": "answer", "body": {}, **words},
    person=people,
    strategy=strategies,
    complied=st.booleans(),
)
appends = st.tuples(st.just("append"), facts | answers)
blocks = st.recursive(
    st.tuples(st.just("block"), st.lists(appends, max_size=3), st.booleans()),
    lambda inner: st.tuples(
        st.just("block"), st.lists(appends | inner, max_size=4), st.sampled_from([False, True])
    ),
    max_leaves=4,
)
stories = st.lists(appends | blocks | st.just(("reopen",)), max_size=12)


def perform(store: Store, deed: Any) -> None:
    """Append, or run a block that may fail at its end; an error is caught in its own block."""
    if deed[0] == "append":
        append_body(store, **deed[1])
        return
    with suppress(Mishap, StoreError), store.transaction():
        for part in deed[1]:
            perform(store, part)
        if deed[2]:
            raise Mishap


def appended(deed: Any) -> list[dict[str, Any]]:
    return [deed[1]] if deed[0] == "append" else [one for part in deed[1] for one in appended(part)]


def fails(deed: Any) -> bool:
    return deed[0] == "block" and (deed[2] or any(map(fails, deed[1])))


@pytest.mark.slow
@tried(80)
@given(stories)
def test_only_committed_events_are_read_back_in_order(story: list[Any]) -> None:
    kept: list[dict[str, Any]] = []
    with tempfile.TemporaryDirectory() as name:
        store = Store.open(Path(name))
        for deed in story:
            if deed == ("reopen",):
                store.close()
                store = Store.open(Path(name))
                continue
            perform(store, deed)
            kept += [] if fails(deed) else appended(deed)
        with store:
            found = list(store.events())
            counts = store.responses()
            by_kind = list(store.events("state", "answer"))
            assert store.check() == []
            with Store.open(Path(name), write=False) as console:
                assert list(console.events()) == found

    fields = ("kind", "body", "person", "strategy", "complied")
    assert [{f: getattr(event, f) for f in fields} for event in found] == [
        {f: one.get(f) for f in fields} for one in kept
    ]
    assert [event.seq for event in found] == list(range(1, len(kept) + 1))
    assert len({event.uuid for event in found}) == len(found)
    assert by_kind == [event for event in found if event.kind in ("state", "answer")]
    folded: dict[tuple[str, str], tuple[int, int]] = {}
    for event in found:
        if event.complied is not None and event.person and event.strategy:
            yes, no = folded.get((event.person, event.strategy), (0, 0))
            folded[event.person, event.strategy] = (yes + event.complied, no + (not event.complied))
    assert counts == folded


# Events


def test_an_event_has_utc_time_person_and_robot(tmp_path: Path) -> None:
    toronto = timezone(timedelta(hours=-5))
    with Store.open(tmp_path, now=lambda: NOON.astimezone(toronto)) as store:
        seq = append_body(
            store, "response", {"é": [1, None]}, person="p1", strategy="praise", complied=False
        )
        event = store.last(ResponseGiven)
    assert event is not None
    robot = event.robot
    noon = "2026-03-04T12:00:00.000250+00:00"
    body = {"é": [1, None]}
    assert event == Event(
        seq, event.uuid, robot, noon, "response", "p1", "praise", False, body, event.record
    )
    with Store.open(tmp_path) as store:
        append_body(store, "later", {})
        assert {event.robot for event in store.events()} == {robot}


def test_each_folder_has_its_own_robot_id(tmp_path: Path) -> None:
    robots = set()
    for name in ("one", "two"):
        with Store.open(tmp_path / name) as store:
            append_body(store, "greeting", {})
            robots |= {event.robot for event in store.events()}
    assert len(robots) == 2


def test_last_returns_the_newest_event_of_a_kind(store: Store) -> None:
    assert store.last("joke") is None
    for kind in ("joke", "joke", "call number"):
        append_body(store, kind, {})
    joke = store.last("joke")
    assert joke is not None and joke.seq == 2


@pytest.mark.slow
def test_reading_works_from_a_number_on_and_while_appending(store: Store) -> None:
    with store.transaction():
        for number in range(store_module.WINDOW * 2 + 5):
            append_body(store, "odd" if number % 2 else "even", {"n": number})
    total = store_module.WINDOW * 2 + 5
    assert [event.seq for event in store.events(after=total - 2)] == [total - 1, total]
    assert [event.seq for event in store.events("odd", after=total - 4)] == [total - 3, total - 1]
    assert list(store.events(after=total)) == list(store.events("unheard of")) == []
    seen = 0
    for _ in store.events():
        seen += 1
        if seen % 1000 == 0:
            append_body(store, "meanwhile", {})
    assert seen == total


def test_an_unfinished_reader_does_not_block_writers(store: Store) -> None:
    for number in range(3):
        append_body(store, "call number", {"n": number})
    with Store.open(store.folder, write=False) as console:
        waiting = islice(console.events(), 1)
        next(waiting)
        assert append_body(store, "call number", {}) == 4


@pytest.mark.parametrize(
    "body", [{"x": float("nan")}, {"x": float("inf")}, {"x": object()}, {"x": "\ud800"}]
)
def test_a_body_that_is_not_json_is_refused(store: Store, body: Any) -> None:
    with pytest.raises((ValueError, TypeError)):
        append_body(store, "state", body)
    assert list(store.events()) == []


def test_an_overly_deep_body_is_refused(store: Store) -> None:
    deep: list[Any] = []
    for _ in range(100_000):
        deep = [deep]
    with pytest.raises(ValueError, match="deep"):
        append_body(store, "state", {"x": deep})


def test_a_response_needs_a_person_and_a_strategy(store: Store) -> None:
    with pytest.raises(ValueError):
        append_body(store, "response", {}, person="p1", complied=True)
    with pytest.raises(ValueError):
        append_body(store, "", {})


@pytest.mark.parametrize("change", ["UPDATE event SET body = '{}'", "DELETE FROM event"])
def test_not_even_sqlite_changes_an_event(store: Store, change: str) -> None:
    append_body(store, "greeting", {"to": "all"})
    store.close()
    with pytest.raises(sqlite3.IntegrityError, match="append only"):
        rebuild(store.folder, change)
    with Store.open(store.folder) as again:
        assert [event.body for event in again.events()] == [{"to": "all"}]


def test_threads_append_without_losing_or_mixing(store: Store) -> None:
    def work(name: str) -> None:
        for number in range(25):
            with store.transaction():
                append_body(store, name, {"n": number})
                append_body(store, name, {"n": number})

    threads = [threading.Thread(target=work, args=(name,)) for name in ("a", "b", "c", "d")]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    events = list(store.events())
    assert len(events) == 200
    for first, second in zip(events[::2], events[1::2], strict=True):
        assert (first.kind, first.body) == (second.kind, second.body)


def test_an_open_transaction_is_invisible_to_other_threads(store: Store) -> None:
    seen: list[int] = []
    reader = threading.Thread(target=lambda: seen.append(len(list(store.events()))))
    with suppress(Mishap), store.transaction():
        append_body(store, "greeting", {})
        reader.start()
        raise Mishap
    reader.join()
    assert seen == [0]


# Names


def test_names_are_stored_apart_from_events(store: Store) -> None:
    store.rename("p1", "Zacharias Q")
    store.rename("p1", "  Zoë-Ann Ωmega ")
    assert store.names() == {"p1": "Zoë-Ann Ωmega"}
    assert [event.person for event in store.events()] == ["p1", "p1"]
    assert "Z" not in json.dumps([event.body for event in store.events()])


def test_an_old_name_is_erased_from_the_folder_after_closing(store: Store) -> None:
    for person in ("p1", "p2", "p3"):
        store.rename(person, "Zacharias Quillfeather")
    for person in ("p1", "p2", "p3"):
        store.rename(person, "Ann")
    store.close()
    for path in store.folder.iterdir():
        assert b"uillf" not in path.read_bytes()


@pytest.mark.parametrize("name", ["", "   ", "a\nb", "a\x1b[2J", "a\u202eb", "\udcff", "x" * 41])
def test_an_unprintable_name_is_refused(store: Store, name: str) -> None:
    store.rename("p1", "x" * 40)
    with pytest.raises(TangyError) as caught:
        store.rename("p1", name)
    assert "\n" not in str(caught.value) and "\x1b" not in str(caught.value)
    assert store.names() == {"p1": "x" * 40}
    assert len(list(store.events())) == 1


# The folder


@pytest.mark.parametrize("umask", [0, 0o777])
def test_the_files_are_private_under_any_umask(tmp_path: Path, umask: int) -> None:
    folder = tmp_path / "log"
    before = os.umask(umask)
    try:
        with Store.open(folder) as store:
            append_body(store, "greeting", {})
            assert mode_of(folder) == 0o700
            assert {path.name: mode_of(path) for path in folder.iterdir()} == dict.fromkeys(
                ["tangy.db", "tangy.db-wal", "tangy.db-shm", "tangy.lock", "tangy.seal"], 0o600
            )
    finally:
        os.umask(before)


def test_a_readable_log_is_made_private(tmp_path: Path) -> None:
    fill(tmp_path, 3)
    log_of(tmp_path).chmod(0o644)
    with Store.open(tmp_path) as store:
        append_body(store, "greeting", {})
        assert {mode_of(path) for path in tmp_path.iterdir()} == {0o600}


def test_a_second_writer_is_refused_with_the_process_of_the_first(store: Store) -> None:
    with pytest.raises(StoreBusy) as caught:
        Store.open(store.folder)
    assert f"another Tangy (process {os.getpid()}) " in str(caught.value)
    assert "--data" in str(caught.value)
    assert append_body(store, "still", {}) == 1
    store.close()
    with Store.open(store.folder) as next_one:
        assert append_body(next_one, "mine", {}) == 2


def test_a_garbage_collected_store_releases_its_lock(tmp_path: Path) -> None:
    append_body(Store.open(tmp_path), "greeting", {})
    with Store.open(tmp_path) as store:
        assert append_body(store, "greeting", {}) == 2
        assert store.notices == []


def test_a_console_reads_beside_the_writer_and_writes_nothing(store: Store) -> None:
    append_body(store, "greeting", {})
    with Store.open(store.folder, write=False) as console:
        assert not console.writable and store.writable
        append_body(store, "joke", {})
        assert [event.kind for event in console.events()] == ["greeting", "joke"]
        for deed in (lambda: append_body(console, "x", {}), lambda: console.rename("p1", "Ann")):
            with pytest.raises(StoreError, match="reading only"):
                deed()
    assert append_body(store, "celebrate", {}) == 3


def test_a_console_without_a_log_is_empty_and_creates_nothing(tmp_path: Path) -> None:
    folder = tmp_path / "absent"
    with Store.open(folder, write=False) as console:
        assert list(console.events()) == []
        assert console.last("joke") is None
        assert (console.responses(), console.names(), console.check()) == ({}, {}, [])
        assert not folder.exists()
        with Store.open(folder) as store:
            append_body(store, "greeting", {})
            assert [event.kind for event in console.events()] == ["greeting"]


def test_a_closed_store_raises_an_error(store: Store) -> None:
    store.close()
    store.close()
    for deed in (lambda: append_body(store, "x", {}), store.names, lambda: list(store.events())):
        with pytest.raises(StoreError, match="is closed"):
            deed()


def test_an_invalid_folder_is_refused_in_one_sentence(tmp_path: Path) -> None:
    file = tmp_path / "notes.txt"
    file.write_text("dear diary")
    (tmp_path / "taken").mkdir()
    log_of(tmp_path / "taken").mkdir()
    for folder in (file, file / "below", tmp_path / "taken"):
        for write in (True, False):
            with pytest.raises(StoreError) as caught:
                Store.open(folder, write=write)
            assert str(folder) in str(caught.value)
            assert str(caught.value).endswith(".") and "\n" not in str(caught.value)
    assert file.read_text() == "dear diary"


@pytest.mark.skipif(not Path("/proc/self").is_dir(), reason="needs a folder nobody can write to")
@pytest.mark.parametrize("folder", ["/proc", "/proc/tangy"])
def test_a_read_only_folder_is_refused_in_one_sentence(folder: str) -> None:
    with pytest.raises(StoreError, match=f"{folder}.*--data") as caught:
        Store.open(Path(folder))
    assert caught.value.__suppress_context__


def test_a_full_disk_loses_no_acknowledged_event(tmp_path: Path) -> None:
    script = """
import resource, sys
from pathlib import Path
from tangy_profiles.errors import StoreError
from tangy_profiles.events import Unknown
from tangy_profiles.store import Store
with Store.open(Path(sys.argv[1])) as store:
    resource.setrlimit(resource.RLIMIT_FSIZE, (200_000, 200_000))
    kept = 0
    try:
        while True:
            with store.transaction():
                for part in range(3):
                    try:
                        kept = store.append(Unknown("state", {"x": "x" * 3000}))
                    except StoreError:
                        pass
            print(kept, flush=True)
    except StoreError as error:
        print(error)
"""
    ran = subprocess.run(  # noqa: S603
        [sys.executable, "-c", script, str(tmp_path)], capture_output=True, text=True, timeout=60
    )
    *kept, sentence = ran.stdout.splitlines()
    assert ran.returncode == 0 and str(tmp_path) in sentence, ran
    with Store.open(tmp_path) as store:
        assert store.notices == store.check() == []
        assert len(list(store.events())) == int(kept[-1]) > 3


def test_a_folder_may_have_any_name(tmp_path: Path) -> None:
    folder = tmp_path / "Ägypten ?mode=memory#%41 100%"
    with Store.open(folder) as store:
        append_body(store, "greeting", {})
    assert log_of(folder).stat().st_size > 0


# Damage


def fill(folder: Path, events: int = 500) -> None:
    with Store.open(folder) as store, store.transaction():
        for number in range(events):
            append_body(store, "state", {"n": number, "text": "words " * 20})


def scribble(path: Path) -> bytes:
    """Overwrite the middle of a file, and return its new content."""
    old = path.read_bytes()
    new = old[: len(old) // 2] + b"\xa5" * 20_000 + old[len(old) // 2 + 20_000 :]
    path.write_bytes(new)
    return new


@pytest.mark.parametrize("large", [False, True])
def test_a_damaged_log_is_set_aside_and_a_new_one_begun(
    tmp_path: Path, large: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    if large:
        monkeypatch.setattr(log_file, "ALWAYS_CHECKED", 1000)
    for round_ in (1, 2):  # in the same second: the second must not overwrite the first one
        fill(tmp_path)
        damaged = scribble(log_of(tmp_path))
        with Store.open(tmp_path, now=lambda: NOON) as store:
            notice, lost = store.notices
            kept = [event.seq for event in store.events("state")]
            gone = sorted(set(range(1, 501)) - set(kept))
            assert 300 < len(kept) < 500 and f"with the {len(kept)} events" in notice
            assert f"events {gone[0]} to {gone[-1]}" in lost and store.check() == [lost]
            assert append_body(store, "greeting", {}) == 502  # after the report of the loss
        aside = sorted(tmp_path.glob("tangy.db.damaged-20260304T120000Z*"))
        assert len(aside) == round_
        assert str(aside[-1]) in notice and notice.endswith(".")
        assert not list(tmp_path.glob("salvage-*"))
        assert aside[-1].read_bytes() == damaged
        log_of(tmp_path).unlink()
        (tmp_path / "tangy.seal").unlink()  # else the missing log would be reported, too
    with Store.open(tmp_path) as store:
        assert store.notices == []


@pytest.mark.parametrize("content", [b"no log at all, " * 1000, b"SQLite format 3\0"])
def test_a_file_that_is_no_log_is_set_aside(tmp_path: Path, content: bytes) -> None:
    log_of(tmp_path).write_bytes(content)
    with Store.open(tmp_path, now=lambda: NOON) as store:
        assert len(store.notices) == 2 and "nobody can tell how many" in store.notices[1]
    aside = tmp_path / "tangy.db.damaged-20260304T120000Z"
    assert aside.read_bytes() == content


def test_a_tail_without_its_log_is_set_aside(tmp_path: Path) -> None:
    tail = tmp_path / "tangy.db-wal"
    with Store.open(tmp_path) as store:
        append_body(store, "greeting", {})
        content = tail.read_bytes()
    log_of(tmp_path).write_bytes(b"")
    tail.write_bytes(content)
    with Store.open(tmp_path, now=lambda: NOON) as store:
        assert len(store.notices) == 2 and list(store.kinds()) == ["events lost"]
    assert (tmp_path / "tangy.db.damaged-20260304T120000Z-wal").read_bytes() == content


def test_damage_found_while_reading_is_mended_at_the_next_start(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(log_file, "ALWAYS_CHECKED", 1000)
    fill(tmp_path)
    times = log_of(tmp_path).stat()
    scribble(log_of(tmp_path))
    os.utime(log_of(tmp_path), ns=(times.st_atime_ns, times.st_mtime_ns))  # decay leaves no time
    with Store.open(tmp_path) as store:
        assert store.notices == []
        assert store.check() != []
        with pytest.raises(StoreError, match="damaged"):
            list(store.events())
    with Store.open(tmp_path) as store:
        assert len(store.notices) == 2 and len(list(store.events("state"))) > 300


def test_a_console_leaves_a_damaged_log_in_place(tmp_path: Path) -> None:
    log_of(tmp_path).write_bytes(b"no log at all, " * 1000)
    with pytest.raises(StoreError, match="damaged"):
        Store.open(tmp_path, write=False)
    assert [path.name for path in tmp_path.iterdir()] == ["tangy.db"]


@pytest.mark.parametrize(
    ("tampering", "word"),
    [
        ("DROP TRIGGER undeleted; DELETE FROM event WHERE seq = 2;", "stand"),
        ("DROP TRIGGER unchanged; UPDATE event SET uuid = 'same';", "different"),
        ("DROP TRIGGER unchanged; UPDATE event SET body = '{' WHERE seq = 2;", "event 2"),
        ("DROP TRIGGER unchanged;", "guard"),
    ],
)
def test_check_reports_tampering(tmp_path: Path, tampering: str, word: str) -> None:
    fill(tmp_path, 3)
    rebuild(tmp_path, tampering)
    with Store.open(tmp_path) as store:
        found = store.check()
    assert any(word in sentence for sentence in found), found
    assert all(sentence.endswith(".") and "\n" not in sentence for sentence in found)


# Versions


def fill_first_version(folder: Path) -> None:
    """Make a log of Tangy's first version, with a person's name."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(log_file, "MIGRATIONS", log_file.MIGRATIONS[:1])
        with Store.open(folder) as store:
            append_body(store, "greeting", {})
            assert store.file.db is not None
            store.file.db.execute("INSERT INTO name VALUES ('user1', 'Rosalind')")


def test_a_migrated_copy_of_an_older_log_contains_no_names(tmp_path: Path) -> None:
    fill_first_version(tmp_path)
    (tmp_path / "tangy.db.copying").write_text("Rosalind: a copy that was cut off")
    with Store.open(tmp_path, write=False) as console:
        assert console.names() == {"user1": "Rosalind"}
    (copy,) = tmp_path.glob("tangy.db.*")
    assert copy.name.startswith("tangy.db.version-1-")
    assert b"Rosalind" not in copy.read_bytes()
    with closing(sqlite3.connect(copy)) as db:
        assert db.execute("SELECT kind FROM event").fetchall() == [("greeting",)]
        assert db.execute("PRAGMA integrity_check").fetchone() == ("ok",)
    assert b"Rosalind" in log_of(tmp_path).read_bytes()


def test_an_older_log_of_a_running_writer_is_read_unchanged(tmp_path: Path) -> None:
    fill_first_version(tmp_path)
    held, _ = log_file.hold(tmp_path / "tangy.lock")
    before = log_of(tmp_path).read_bytes()
    with Store.open(tmp_path, write=False) as console:
        assert console.names() == {"user1": "Rosalind"}
        assert (console.pronunciations(), console.voices(), console.check()) == ({}, {}, [])
        assert log_of(tmp_path).read_bytes() == before
        held.close()
        with Store.open(tmp_path) as store:
            store.pronounce("user1", "R OW Z")
            assert console.pronunciations() == {"user1": "R OW Z"}


def test_an_unwritable_older_log_is_read_unchanged(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    fill_first_version(tmp_path)

    def refused(path: Path) -> None:
        raise OSError(30, "Read-only file system")

    monkeypatch.setattr(log_file, "hold", refused)
    monkeypatch.setattr(log_file, "is_read_only", lambda folder: True)
    there = set(tmp_path.iterdir())
    with Store.open(tmp_path, write=False) as console:
        assert console.names() == {"user1": "Rosalind"}
        assert console.voices() == {}
        assert set(tmp_path.iterdir()) == there, "SQLite makes nothing beside it"


def test_a_damaged_older_log_is_left_to_its_writer(tmp_path: Path) -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(log_file, "MIGRATIONS", log_file.MIGRATIONS[:1])
        fill(tmp_path)
    damaged = scribble(log_of(tmp_path))
    with Store.open(tmp_path, write=False) as console:
        assert console.check() != []
    assert log_of(tmp_path).read_bytes() == damaged
    with Store.open(tmp_path) as store:
        assert len(store.notices) == 2


@pytest.mark.parametrize("write", [True, False])
def test_an_older_log_is_copied_and_migrated(
    tmp_path: Path, write: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    fill(tmp_path, 3)
    later = (*log_file.MIGRATIONS, "CREATE TABLE shelf (x); INSERT INTO shelf VALUES (7);")
    monkeypatch.setattr(log_file, "MIGRATIONS", later)
    with Store.open(tmp_path, write=write, now=lambda: NOON) as store:
        assert len(list(store.events())) == 3
        assert store.notices == []
    with Store.open(tmp_path, now=lambda: NOON) as store:
        assert append_body(store, "state", {}) == 4
    now = len(later) - 1
    copy = tmp_path / f"tangy.db.version-{now}-20260304T120000Z"
    assert mode_of(copy) == 0o600
    with closing(sqlite3.connect(copy)) as db:
        assert db.execute("PRAGMA user_version").fetchone() == (now,)
        assert db.execute("SELECT count(*) FROM event").fetchone() == (3,)
    with closing(sqlite3.connect(log_of(tmp_path))) as db:
        assert db.execute("PRAGMA user_version").fetchone() == (now + 1,)
        assert db.execute("SELECT x FROM shelf").fetchall() == [(7,)]


def test_a_log_of_version_0_keeps_its_content(tmp_path: Path) -> None:
    rebuild(tmp_path, "CREATE TABLE note (x); INSERT INTO note VALUES ('kept');")
    with Store.open(tmp_path) as store:
        assert append_body(store, "greeting", {}) == 1
    for path in (log_of(tmp_path), *tmp_path.glob("tangy.db.version-0-*")):
        with closing(sqlite3.connect(path)) as db:
            assert db.execute("SELECT x FROM note").fetchall() == [("kept",)]
    assert len(list(tmp_path.glob("tangy.db.version-0-*"))) == 1


def test_a_failed_migration_leaves_the_log_unchanged(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    fill(tmp_path, 3)
    with monkeypatch.context() as patch:
        broken = (*log_file.MIGRATIONS, "CREATE TABLE shelf (x); CREATE TABLE event (x);")
        patch.setattr(log_file, "MIGRATIONS", broken)
        with pytest.raises(StoreError, match=f"version {len(broken) - 1} to {len(broken)}"):
            Store.open(tmp_path)
    with Store.open(tmp_path) as store:
        assert len(list(store.events())) == 3
    with closing(sqlite3.connect(log_of(tmp_path))) as db:
        assert db.execute("SELECT 1 FROM sqlite_master WHERE name = 'shelf'").fetchall() == []
    assert list(tmp_path.glob("tangy.db.version-*")) == []  # each start would leave one more


@pytest.mark.parametrize("write", [True, False])
def test_a_newer_log_is_refused_and_untouched(tmp_path: Path, write: bool) -> None:
    fill(tmp_path, 3)
    rebuild(tmp_path, "PRAGMA user_version = 99;")
    before = log_of(tmp_path).read_bytes()
    with pytest.raises(StoreError, match="newer Tangy") as caught:
        Store.open(tmp_path, write=write)
    assert str(caught.value).endswith(".")
    assert log_of(tmp_path).read_bytes() == before
    rebuild(tmp_path, f"PRAGMA user_version = {len(log_file.MIGRATIONS)};")
    with Store.open(tmp_path) as store:  # the lock is free again
        assert len(list(store.events())) == 3


def test_a_new_log_has_no_copy_beside_it(tmp_path: Path) -> None:
    Store.open(tmp_path).close()
    assert {path.name for path in tmp_path.iterdir()} == {"tangy.db", "tangy.lock", "tangy.seal"}
