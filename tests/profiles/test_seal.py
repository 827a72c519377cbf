"""The count beside the log: only missing newest events are reported."""

from __future__ import annotations

import shutil
import threading
from collections.abc import Iterator
from contextlib import suppress
from datetime import UTC, datetime, timedelta
from pathlib import Path
from random import Random

import pytest

from tangy_profiles.people_records import EventsLost
from tangy_profiles.seal import Seal
from tangy_profiles.store import Store
from tests.support.append_body import append_body

NOON = datetime(2026, 3, 4, 12, tzinfo=UTC)


class Mishap(Exception):
    """An error inside a transaction."""


@pytest.fixture
def store(tmp_path: Path) -> Iterator[Store]:
    with Store.open(tmp_path / "log") as opened:
        yield opened


def killed(store: Store, folder: Path, *, but: str = "") -> Path:
    """Copy the files as they are if the program is killed now, all `but` one."""
    folder.mkdir(exist_ok=True)
    for name in ("tangy.db", "tangy.db-wal", "tangy.lock", "tangy.seal"):
        if name != but:
            shutil.copy(store.folder / name, folder / name)
    return folder


def said(folder: Path) -> list[str]:
    """Return the notices of a console about a log, which `check` gives as well."""
    with Store.open(folder, write=False) as console:
        assert [s for s in console.check() if "gone" in s] == console.notices
        return console.notices


def test_a_killed_program_loses_no_event(store: Store, tmp_path: Path) -> None:
    for number in range(1, 8):
        append_body(store, "joke", {"n": number})
        folder = killed(store, tmp_path / f"after-{number}")
        assert said(folder) == []
        with Store.open(folder) as again:
            assert (again.notices, append_body(again, "joke", {})) == ([], number + 1)


@pytest.mark.slow
def test_every_lost_tail_is_reported(store: Store, tmp_path: Path) -> None:
    """Damage that leaves all events is not reported; every loss of events is, with the number."""
    for number in range(40):
        append_body(store, "joke", {"n": number, "text": "x" * 300})
    random, lost = Random(5), 0
    for number in range(80):
        folder = killed(store, tmp_path / "damaged")
        tail = folder / "tangy.db-wal"
        content = bytearray(tail.read_bytes())
        at = random.randrange(len(content))
        if number % 2:
            content[at] ^= 1 << random.randrange(8)
        else:
            del content[at:]
        tail.write_bytes(content)
        with Store.open(folder, write=False) as console:
            there = len(list(console.events()))
            words = console.notices
        if there < 40:
            lost += 1
            which = f"events {there + 1} to 40" if there < 39 else "event 40"
            assert len(words) == 1 and which in words[0], (there, words)
        else:
            assert words == []
        shutil.rmtree(folder)
    assert lost > 40, "most of the damage takes something"


def test_a_deleted_tail_is_reported_until_staff_accept_it(store: Store, tmp_path: Path) -> None:
    Store.open(tmp_path / "first").close()
    append_body(store, "joke", {})
    store.file.reading()
    assert store.file.db is not None
    store.file.db.execute("PRAGMA wal_checkpoint").fetchall()
    for _ in range(3):
        append_body(store, "joke", {})
    folder = killed(store, tmp_path / "killed", but="tangy.db-wal")
    for _ in range(2):
        assert "events 2 to 4 had been kept and are gone" in said(folder)[0]
    with Store.open(folder) as again:
        assert "events 2 to 4" in again.notices[0]
        (noted,) = again.events(EventsLost)
        assert noted.body == {"first": 2, "last": 4}
        append_body(again, "joke", {})
    assert "events 2 to 4" in said(folder)[0]
    with Store.open(folder) as again:
        assert "events 2 to 4" in again.notices[0] and again.check() == again.notices
        assert [loss.last for loss in again.accept_losses()] == [4]
        assert again.accept_losses() == []
    with Store.open(folder) as again:
        assert (again.notices, again.check()) == ([], [])


def test_a_copy_of_a_busy_folder_reports_missing_events(store: Store, tmp_path: Path) -> None:
    append_body(store, "joke", {})
    folder = killed(store, tmp_path / "copy")
    append_body(store, "joke", {})
    shutil.copy(store.folder / "tangy.seal", folder / "tangy.seal")  # the seal is copied last
    assert "event 2 had been kept and is gone" in said(folder)[0]
    assert "a copy that was made while Tangy was writing" in said(folder)[0]


def test_a_copy_of_a_closed_folder_is_complete(store: Store, tmp_path: Path) -> None:
    append_body(store, "joke", {})
    store.close()
    shutil.copytree(store.folder, tmp_path / "copy")
    assert said(tmp_path / "copy") == []


@pytest.mark.parametrize("kept", ["", "none", "torn", "bits", "folder"])
def test_a_missing_count_is_reported_until_staff_accept_it(store: Store, kept: str) -> None:
    seal = store.folder / "tangy.seal"
    append_body(store, "joke", {})
    append_body(store, "joke", {})
    store.close()
    late = seal.read_bytes()
    seal.unlink()
    if kept == "folder":
        seal.mkdir()
    elif kept != "none":
        contents = {"torn": late[:30], "bits": late.replace(b"02 ", b"92 ")}
        seal.write_bytes(contents.get(kept, b""))
        assert kept != "bits" or seal.read_bytes() != late
    for write in (False, True, True, False):
        with Store.open(store.folder, write=write) as again:
            (notice,) = again.notices
            assert "nobody can tell what came after 2" in notice
    with Store.open(store.folder) as again:
        assert append_body(again, "joke", {}) == 4
        again.accept_losses()
    if kept != "folder":
        assert said(store.folder) == []


def test_a_lagging_count_raises_no_alarm(store: Store) -> None:
    seal = store.folder / "tangy.seal"
    append_body(store, "joke", {})
    early = seal.read_bytes()
    append_body(store, "joke", {})
    store.close()
    seal.write_bytes(early)
    assert said(store.folder) == []
    with Store.open(store.folder) as again:
        assert (again.notices, append_body(again, "joke", {})) == ([], 3)
    assert said(store.folder) == []


def test_a_log_without_a_count_is_accepted(store: Store) -> None:
    append_body(store, "joke", {})
    assert store.file.db is not None
    store.file.db.execute("DELETE FROM meta WHERE key = 'sealed'")
    store.close()
    (store.folder / "tangy.seal").unlink()
    assert said(store.folder) == []
    with Store.open(store.folder) as again:
        assert again.notices == []


def test_the_count_of_another_log_is_ignored(store: Store, tmp_path: Path) -> None:
    for _ in range(5):
        append_body(store, "joke", {})
    other = tmp_path / "other"
    Store.open(other).close()
    shutil.copy(store.folder / "tangy.seal", other / "tangy.seal")
    assert said(other) == []


def test_setting_a_damaged_log_aside_is_reported_once(store: Store) -> None:
    for number in range(50):
        append_body(store, "joke", {"n": number, "text": "x" * 500})
    store.close()
    log = store.folder / "tangy.db"
    log.write_bytes(log.read_bytes()[:8192] + b"\xff" * 4096)
    with Store.open(store.folder) as again:
        assert "was damaged: it is kept as" in again.notices[0]
        lost = again.notices[1:]
        assert len(lost) == 1 and "events 1 to 50 had been kept and are gone" in lost[0]
    assert said(store.folder) == lost


def test_rolled_back_events_are_not_counted(store: Store, tmp_path: Path) -> None:
    append_body(store, "joke", {})
    with suppress(Mishap), store.transaction():
        append_body(store, "joke", {})
        raise Mishap
    assert said(killed(store, tmp_path / "killed")) == []


def test_a_console_beside_a_busy_writer_raises_no_alarm(store: Store) -> None:
    done = threading.Event()

    def write() -> None:
        while not done.is_set():
            append_body(store, "joke", {})

    writer = threading.Thread(target=write)
    writer.start()
    try:
        for _ in range(100):
            with Store.open(store.folder, write=False) as console:
                assert console.notices == []
    finally:
        done.set()
        writer.join()


def test_a_clock_that_jumps_raises_no_alarm(tmp_path: Path) -> None:
    for days in (0, -400, 400):
        with Store.open(tmp_path, now=lambda days=days: NOON + timedelta(days)) as store:  # type: ignore[misc]
            append_body(store, "joke", {})
            assert store.notices == []


def test_the_count_never_exceeds_the_log(tmp_path: Path) -> None:
    """The count is written after the commit, so a program killed in between leaves it behind."""
    with Store.open(tmp_path) as store:
        seal = Seal(tmp_path)
        with store.transaction():
            append_body(store, "joke", {})
            assert seal.read() == (store.robot, 0)
        assert seal.read() == (store.robot, 1)
