"""A hanging test fails by its name, and the other tests pass."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

TESTS = Path(__file__).parents[1]

HANGING = """
import asyncio
import threading

import pytest


@pytest.fixture
def clean_up_hangs():
    yield
    threading.Event().wait()


def test_waits_for_a_thread():
    threading.Event().wait()


async def test_waits_for_a_task():
    await asyncio.Event().wait()


async def test_runs_round_in_the_loop():
    while True:
        await asyncio.sleep(0)


async def test_waits_while_another_task_runs_round():
    async def round_and_round():
        while True:
            await asyncio.sleep(0)

    others = [asyncio.create_task(round_and_round()) for _ in range(9)]
    while True:
        await asyncio.sleep(0.01)


def test_never_cleans_up(clean_up_hangs):
    threading.Event().wait()


def test_passes():
    pass
"""


def test_each_hanging_test_fails_by_name(tmp_path: Path) -> None:
    (tmp_path / "test_hanging.py").write_text(HANGING, encoding="utf-8")
    (tmp_path / "conftest.py").write_text('pytest_plugins = ["tests.support.hangs"]', "utf-8")
    (tmp_path / "pytest.ini").write_text("[pytest]\nasyncio_mode = auto\n", encoding="utf-8")
    done = subprocess.run(  # noqa: S603 - our own interpreter
        [sys.executable, "-m", "pytest", "-n", "2", "--timeout", "1", "-ra", str(tmp_path)],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(TESTS.parent), "TANGY_TEST_GRACE": "1"},
        capture_output=True,
        text=True,
        check=False,
    )
    failed = set(re.findall(r"^FAILED \S+::test_(\w+)", done.stdout, flags=re.MULTILINE))
    assert failed == {
        "waits_for_a_thread",
        "waits_for_a_task",
        "runs_round_in_the_loop",
        "waits_while_another_task_runs_round",
        "never_cleans_up",
    }, done.stdout + done.stderr
    assert "1 passed" in done.stdout
    assert "clean_up_hangs" in done.stderr, "where it hung is written when its process is ended"
