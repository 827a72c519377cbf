"""The logs of processes: one line for each decision, with the id of its command."""

from __future__ import annotations

import contextvars
import logging
import os
import re
import stat
import subprocess
import sys
from pathlib import Path

import pytest

from tangy_profiles.process_log import (
    LEVEL,
    LOGS,
    NO_COMMAND,
    PACKAGES,
    PROGRAM_LOG,
    command_id,
    logging_to,
    serving,
)
from tangy_profiles.worker_log import KEPT, MOST

LOG = logging.getLogger("tangy_tui.test")


def lines(folder: Path) -> list[str]:
    return (folder / PROGRAM_LOG).read_text(encoding="utf-8").splitlines()


def test_a_line_has_its_time_process_module_and_command(tmp_path: Path) -> None:
    with logging_to(tmp_path):
        LOG.info("before")
        with serving() as command:
            LOG.warning("within")
            with serving() as inner:
                assert inner == command == command_id()
    LOG.info("after")
    first, second = lines(tmp_path)
    form = r"\d{4}-\d\d-\d\d [\d:,]+ (\d+) (\w+) +tangy_tui\.test \[(.+)\] (\w+)"
    mine = str(os.getpid())
    assert re.fullmatch(form, first, re.ASCII)
    found = [re.fullmatch(form, line) for line in (first, second)]
    assert [one and one.groups() for one in found] == [
        (mine, "INFO", NO_COMMAND, "before"),
        (mine, "WARNING", command, "within"),
    ]


@pytest.mark.parametrize("told", ["abc123", "0" * 32])
def test_an_id_from_another_process_is_used(told: str) -> None:
    with serving(told) as command:
        assert command == told
    assert command_id() == NO_COMMAND


@pytest.mark.parametrize("told", ["", "x" * 33, "a b", "a\nb", 7, ["a"], "\x1b[2J"])
def test_an_invalid_id_is_ignored(told: object) -> None:
    with serving(told) as command:
        assert command == NO_COMMAND


def test_each_command_has_its_own_id() -> None:
    with serving() as first:
        pass
    with serving() as second:
        pass
    assert first != second


def test_a_concurrent_task_keeps_its_own_id() -> None:
    with serving() as command:
        beside = contextvars.copy_context()
    assert beside.run(command_id) == command and command_id() == NO_COMMAND


def test_the_log_is_private_and_bounded(tmp_path: Path) -> None:
    with logging_to(tmp_path):
        LOG.info("x" * MOST)
        LOG.info("one more")
    path = tmp_path / PROGRAM_LOG
    assert stat.S_IMODE(path.stat().st_mode) == 0o600
    assert path.stat().st_size <= KEPT + 200 and lines(tmp_path)[-1].endswith("one more")


def test_what_was_not_logged_before_is_not_logged_afterwards(tmp_path: Path) -> None:
    before = {name: logging.getLogger(name).level for name in PACKAGES}
    with logging_to(tmp_path):
        assert LOG.isEnabledFor(logging.INFO)
    assert {name: logging.getLogger(name).level for name in PACKAGES} == before


def test_no_log_file_is_created_without_a_message(tmp_path: Path) -> None:
    with logging_to(tmp_path):
        logging.getLogger("others").warning("not ours")
    assert not (tmp_path / PROGRAM_LOG).exists()


@pytest.mark.parametrize(("level", "count"), [("", 1), ("debug", 2), ("ERROR", 0), ("loud", 1)])
def test_the_environment_sets_the_log_level(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, level: str, count: int
) -> None:
    monkeypatch.setenv(LEVEL, level)
    with logging_to(tmp_path):
        LOG.debug("little")
        LOG.info("more")
    assert len(lines(tmp_path) if count else []) == count
    assert (tmp_path / PROGRAM_LOG).exists() is bool(count)


def test_an_unwritable_log_causes_no_error(tmp_path: Path) -> None:
    (tmp_path / PROGRAM_LOG).mkdir()
    with logging_to(tmp_path):
        LOG.error("nowhere to go")


def test_every_log_file_has_a_description() -> None:
    assert PROGRAM_LOG in LOGS and all(LOGS.values())


@pytest.mark.parametrize("package", ["tangy_tui", "tangy_hw", "tangy_sim", "tangy_profiles"])
def test_warnings_without_a_log_do_not_reach_the_terminal(package: str) -> None:
    warns = f"import {package}, logging; logging.getLogger('{package}.room').warning('broken')"
    done = subprocess.run([sys.executable, "-c", warns], capture_output=True, check=True)  # noqa: S603
    assert done.stderr == b""
