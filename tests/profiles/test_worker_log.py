"""A worker's log keeps its newest lines within a bound."""

from __future__ import annotations

import os
import stat
from pathlib import Path

import pytest

from tangy_profiles.worker_log import KEPT, MOST, open_log

LINE = b"something was said\n"


@pytest.mark.parametrize("size", [0, len(LINE), MOST // len(LINE) * len(LINE)])
def test_a_short_log_is_appended_to(size: int, tmp_path: Path) -> None:
    path = tmp_path / "worker.log"
    path.write_bytes(LINE * (size // len(LINE)))
    with open_log(path) as log:
        log.write(b"more\n")
    assert path.read_bytes() == LINE * (size // len(LINE)) + b"more\n"


def test_a_long_log_keeps_its_last_complete_lines(tmp_path: Path) -> None:
    path = tmp_path / "worker.log"
    path.write_bytes(b"old\n" + LINE * (2 * MOST // len(LINE)))
    with path.open("ab") as other, open_log(path) as log:  # another program has it open
        assert KEPT - len(LINE) <= path.stat().st_size <= KEPT
        log.write(b"more\n")
        log.flush()
        other.write(b"theirs\n")
    kept = path.read_bytes()
    assert kept.endswith(LINE + b"more\ntheirs\n")
    assert set(kept.splitlines(keepends=True)) == {LINE, b"more\n", b"theirs\n"}


def test_an_endless_line_is_cut(tmp_path: Path) -> None:
    path = tmp_path / "worker.log"
    path.write_bytes(b"x" * (3 * MOST))
    with open_log(path):
        assert path.stat().st_size <= KEPT


def test_an_unwritable_log_raises_the_reason(tmp_path: Path) -> None:
    with pytest.raises(OSError, match="No such file"):
        open_log(tmp_path / "none" / "worker.log")


def test_the_log_is_private(tmp_path: Path) -> None:
    old, new = tmp_path / "old.log", tmp_path / "new.log"
    old.touch(0o644)
    old.chmod(0o644)
    before = os.umask(0)
    try:
        for path in (old, new):
            with open_log(path) as log:
                log.write(b"one\n")
            assert stat.S_IMODE(path.stat().st_mode) == 0o600
    finally:
        os.umask(before)


def test_a_pipe_or_device_is_refused_as_a_log(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.log")
    (tmp_path / "null.log").symlink_to("/dev/null")
    for name in ("pipe.log", "null.log"):
        with pytest.raises(OSError):
            open_log(tmp_path / name)
