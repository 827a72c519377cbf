"""Salvaging a damaged log: every readable event is kept."""

from __future__ import annotations

from pathlib import Path
from random import Random
from typing import Any

import pytest

from tangy_profiles.store import Event, Store
from tests.support.append_body import append_body

PAGE = 4096
EVENTS = 400


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Return the folder of a log with a person's name."""
    with Store.open(tmp_path / "log") as store:
        store.rename("user1", "Rosa")
        with store.transaction():
            for number in range(EVENTS - 1):
                append_body(store, "state", {"n": number, "text": "words " * 20})
    return tmp_path / "log"


def overwrite(folder: Path, page: int, content: bytes) -> None:
    path = folder / "tangy.db"
    before = path.read_bytes()
    path.write_bytes(before[: page * PAGE] + content + before[(page + 1) * PAGE :])


@pytest.mark.parametrize("content", [bytes(PAGE), b"\xa5" * PAGE, Random(1).randbytes(PAGE)])
def test_an_overwritten_page_loses_only_its_events(folder: Path, content: bytes) -> None:
    pages = (folder / "tangy.db").stat().st_size // PAGE
    whole = {event.seq: event for event in _events(folder)}
    overwrite(folder, pages // 2, content)
    with Store.open(folder) as store:
        left = {event.seq: event for event in store.events("state", "renamed")}
        assert EVENTS - 40 < len(left) < EVENTS
        assert left == {seq: whole[seq] for seq in left}
        assert store.names() == {"user1": "Rosa"}
        gone = sorted(set(whole) - set(left))
        assert store.accept_losses()[0].body == {
            "first": gone[0], "last": gone[-1], "damaged": True,
        }  # fmt: skip
        assert store.check() == []
    with Store.open(folder) as store:
        assert store.notices == []


@pytest.mark.slow
def test_an_overwritten_page_adds_no_event(folder: Path, tmp_path: Path) -> None:
    whole = {event.seq: event for event in _events(folder)}
    bytes_of_it = (folder / "tangy.db").read_bytes()
    kept = []
    for page in range(1, len(bytes_of_it) // PAGE):
        (folder / "tangy.seal").unlink(missing_ok=True)
        (folder / "tangy.db").write_bytes(bytes_of_it)
        overwrite(folder, page, Random(page).randbytes(PAGE))
        with Store.open(folder) as store:
            left = list(store.events("state", "renamed"))
            assert all(whole[event.seq] == event for event in left)
            kept.append(len(left))
    assert sorted(kept)[1] > EVENTS - 40, "only the root of the events costs all of them"


@pytest.mark.parametrize("page", [0, 2])
def test_an_unreadable_log_is_reported_until_accepted(folder: Path, page: int) -> None:
    overwrite(folder, 0, Random(page).randbytes(PAGE))
    if page:
        (folder / "tangy.seal").unlink()  # then the number of events is unknown
    for _ in range(2):
        with Store.open(folder) as store:
            assert any("gone" in notice for notice in store.notices)
            assert any("gone" in told for told in store.check())
    with Store.open(folder) as store:
        assert len(store.accept_losses()) == 1
        assert store.check() == []
    with Store.open(folder) as store:
        assert store.notices == []


@pytest.mark.parametrize("seed", range(6))
def test_a_half_overwritten_page_loses_no_event_of_another(folder: Path, seed: int) -> None:
    whole = {event.seq: event for event in _events(folder)}
    path = folder / "tangy.db"
    pages = path.stat().st_size // PAGE
    start = (pages // 3 + seed) * PAGE
    content = path.read_bytes()
    half = Random(seed).randbytes(PAGE // 2)
    path.write_bytes(content[: start + PAGE // 2] + half + content[start + PAGE :])
    with Store.open(folder) as store:
        left = {event.seq: event for event in store.events("state", "renamed")}
        assert left == {seq: whole[seq] for seq in left}
        gone = sorted(set(whole) - set(left))
        assert len(gone) <= 40
        assert not gone or gone[-1] - gone[0] <= 40


def test_a_salvaged_log_keeps_the_identity_of_the_robot(folder: Path) -> None:
    (before, *_) = _events(folder)
    pages = (folder / "tangy.db").stat().st_size // PAGE
    overwrite(folder, pages // 2, bytes(PAGE))
    with Store.open(folder) as store:
        append_body(store, "joke", {})
        last = store.last("joke")
        assert last is not None and last.robot == before.robot


def _events(folder: Path) -> list[Event[Any]]:
    with Store.open(folder, write=False) as store:
        return list(store.events())
