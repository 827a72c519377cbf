"""Redrawing a wiped terminal: by a key, after a suspension, and in another size."""

from __future__ import annotations

import os
import signal
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.support.terminal import TANGY, Terminal

QUIET = 0.4  # s


@pytest.fixture
def teaching(tmp_path: Path) -> Iterator[Terminal]:
    """The teaching screen on a terminal."""
    command = [TANGY, "--data", str(tmp_path), "teach", "--teacher", "ann", "--seed", "3"]
    terminal = Terminal(command)
    terminal.until("type a command")
    terminal.settle(QUIET)
    yield terminal
    terminal.end()


@pytest.mark.slow
def test_a_wiped_screen_is_redrawn(teaching: Terminal) -> None:
    shown = teaching.text
    teaching.wipe()
    teaching.type("\x0c")
    teaching.until(lambda text: text == shown)

    teaching.wipe()
    os.kill(teaching.process.pid, signal.SIGTSTP)
    teaching.settle(QUIET)
    os.kill(teaching.process.pid, signal.SIGCONT)
    teaching.until(lambda text: text == shown)

    teaching.resize(90, 30)
    teaching.settle(QUIET)
    teaching.resize(80, 24)
    teaching.wipe()
    teaching.until(lambda text: text == shown)


@pytest.mark.slow
def test_a_letter_and_a_question_write_few_bytes(teaching: Terminal) -> None:
    teaching.type("call numbe")
    teaching.until("call numbe")
    teaching.settle(QUIET)
    teaching.type("r")
    assert teaching.settle(QUIET) < 200
    teaching.type("\r")
    assert teaching.settle(QUIET) < 6_000
