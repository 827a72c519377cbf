"""The forked worker: the same answers as in the process, and no process left behind."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator

import pytest

from tangy_tui.speech import forked_worker as room
from tangy_tui.speech.forked_worker import ForkedWorker


def _who(asked: int) -> tuple[int, int]:
    return asked * 2, os.getpid()


@pytest.fixture(autouse=True)
def two_processors(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.setattr(room, "processors", lambda: range(2))
    yield


def test_the_forked_worker_answers_one_question_after_the_other() -> None:
    beside = ForkedWorker(_who)
    answered = []
    for number in range(3):
        beside.ask(number)
        answered.append(beside.answer())
    assert [double for double, _ in answered] == [0, 2, 4]
    pids = {pid for _, pid in answered}
    assert len(pids) == 1 and os.getpid() not in pids


def test_the_answer_is_computed_locally_on_one_processor(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(room, "processors", lambda: range(1))
    beside = ForkedWorker(_who)
    beside.ask(4)
    assert beside.answer() == (8, os.getpid())


@pytest.mark.parametrize("asked_before", [True, False])
def test_the_answer_is_computed_locally_if_the_worker_dies(asked_before: bool) -> None:
    beside = ForkedWorker(_who)
    beside.ask(1)
    _, pid = beside.answer()
    if asked_before:
        os.kill(pid, signal.SIGSTOP)  # so that it dies without having answered
        beside.ask(21)
        os.kill(pid, signal.SIGKILL)
    else:
        os.kill(pid, signal.SIGKILL)
        beside.ask(21)
    assert beside.answer() == (42, os.getpid())
    beside.ask(5)
    assert beside.answer() == (10, os.getpid())


def test_an_unread_answer_is_dropped() -> None:
    beside = ForkedWorker(_who)
    for number in (1, 2, 3):
        beside.ask(number)
    assert beside.answer()[0] == 6
    beside.ask(4)
    assert beside.answer()[0] == 8


def test_closing_ends_the_worker() -> None:
    beside = ForkedWorker(_who)
    beside.ask(1)
    _, pid = beside.answer()
    beside.close()
    with pytest.raises(ProcessLookupError):
        os.kill(pid, 0)
    beside.ask(2)
    assert beside.answer() == (4, os.getpid())


ENDS = """
import os, signal, sys
from tangy_tui.speech import forked_worker
forked_worker.processors = lambda: range(2)
one = forked_worker.ForkedWorker(lambda asked: os.getpid())
one.ask(0)
print(one.answer(), flush=True)
os.kill(os.getpid(), signal.SIGKILL)
"""


def test_the_worker_ends_with_its_parent_process() -> None:
    # Both hold the pipe that the test reads: it closes when the last of them has ended.
    ended = subprocess.run(  # noqa: S603 - this interpreter and our own text
        [sys.executable, "-c", ENDS], stdout=subprocess.PIPE, timeout=60, check=False
    )
    assert ended.returncode == -signal.SIGKILL
    assert int(ended.stdout) > 0
