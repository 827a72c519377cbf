"""Answers by lines: an answer typed before its question does not count."""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from queue import SimpleQueue

import pytest

from tangy_tui.app.terminal_session import TerminalSession
from tangy_tui.console.typed_yes import REACTION_SECONDS, TypedYes
from tangy_tui.learning.verification import Reply
from tangy_tui.text.questions import TOO_EARLY
from tests.support.terminal import TANGY, Terminal

HERE, ELSEWHERE = TerminalSession(), TerminalSession(remote=True)
FROM_HERE = {"SSH_CONNECTION": "", "SSH_TTY": "", "SSH_CLIENT": "", "TMUX": "", "STY": ""}
SSH = {"SSH_CONNECTION": "192.0.2.1 50000 192.0.2.2 22"}


def test_a_script_answers_with_y_anywhere() -> None:
    yes = TypedYes(terminal=False, session=lambda: ELSEWHERE)
    assert yes.ask() == "Y"
    assert yes.answer("y") == Reply(yes=True)


def test_the_yes_of_a_local_terminal_is_y_and_drops_input_typed_ahead() -> None:
    dropped: list[bool] = []
    yes = TypedYes(
        terminal=True,
        session=lambda: HERE,
        flush=lambda: dropped.append(True),
        clock=iter((0.0, 5.0, 6.0)).__next__,
    )
    assert yes.ask() == "Y"
    assert dropped == [True]
    assert yes.answer("yes") == Reply(yes=True)


def test_a_yes_typed_faster_than_anybody_reacts_is_asked_for_again() -> None:
    now = 0.0
    yes = TypedYes(terminal=True, session=lambda: HERE, flush=lambda: None, clock=lambda: now)
    yes.ask()
    now = REACTION_SECONDS / 2
    assert yes.answer("y") == TOO_EARLY
    assert yes.answer("2") == TOO_EARLY
    assert yes.answer("n") == Reply(yes=False)
    assert yes.answer("call number") is None
    now = REACTION_SECONDS
    assert yes.answer("y") == Reply(yes=True)


def test_a_script_may_answer_at_once() -> None:
    yes = TypedYes(terminal=False, clock=lambda: 0.0)
    yes.ask()
    assert yes.answer("y") == Reply(yes=True)


def test_the_yes_of_a_remote_terminal_is_a_changing_digit() -> None:
    now = 0.0
    yes = TypedYes(terminal=True, session=lambda: ELSEWHERE, flush=lambda: None, clock=lambda: now)
    keys = [yes.ask() for _ in range(20)]
    assert set(keys) <= set("456789")
    assert all(first != second for first, second in pairwise(keys))
    now = 1.0
    assert yes.answer(keys[-1]) == Reply(yes=True)
    assert yes.answer("y") == f"The yes of this question is {keys[-1]}."
    assert yes.answer("n") == Reply(yes=False)
    assert yes.answer("2") == Reply(yes=False, alternative=2)
    assert yes.answer("call number") is None


@pytest.mark.parametrize(("setting", "digit"), [("y", False), ("digit", True)])
def test_the_setting_overrides_the_session(setting: str, digit: bool) -> None:
    session = HERE if digit else ELSEWHERE
    yes = TypedYes(
        terminal=True,
        setting=setting,  # type: ignore[arg-type]
        session=lambda: session,
        flush=lambda: None,
    )
    assert (yes.ask() != "Y") == digit


def test_only_answers_among_lines_read_ahead_are_dropped() -> None:
    typed: SimpleQueue[str | None] = SimpleQueue()
    for line in ("y\n", "stop\n", "2\n", "call number\n", "no\n", None):
        typed.put(line)
    TypedYes(terminal=True, session=lambda: HERE).ask(typed)
    assert [typed.get_nowait() for _ in range(typed.qsize())] == ["stop\n", "call number\n", None]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A data folder."""
    return tmp_path


def teaching(folder: Path, **environment: str) -> Terminal:
    command = [TANGY, "--data", str(folder), "teach", "--plain", "--teacher", "ann", "--seed", "3"]
    terminal = Terminal(command, environment={**FROM_HERE, **environment}, lines=60)
    terminal.until("Now:")
    return terminal


@pytest.fixture
def here(folder: Path) -> Iterator[Terminal]:
    """Teaching by lines on this machine."""
    terminal = teaching(folder)
    yield terminal
    terminal.end()


@pytest.fixture
def elsewhere(folder: Path) -> Iterator[Terminal]:
    """Teaching by lines from another machine."""
    terminal = teaching(folder, **SSH)
    yield terminal
    terminal.end()


@pytest.mark.slow
def test_a_y_typed_ahead_executes_nothing(here: Terminal) -> None:
    here.type("greet everyone\ny\n")
    here.until("Type Y to do it")
    here.type("n\n")
    here.until("Not done: greet everyone.")
    here.type("greet everyone\n")
    here.until(lambda text: text.count("Type Y to do it") == 2)
    here.settle(2 * REACTION_SECONDS)
    here.type("y\n")
    here.until("Tangy says:")


@pytest.mark.slow
def test_a_question_on_a_remote_terminal_names_its_digit(elsewhere: Terminal) -> None:
    elsewhere.type("greet everyone\n")
    shown = elsewhere.until("to do it, or N")
    found = re.search(r"Type (\d) to do it", shown)
    assert found is not None
    elsewhere.settle(2 * REACTION_SECONDS)
    elsewhere.type("y\n")
    elsewhere.until(f"The yes of this question is {found[1]}.")
    elsewhere.settle(2 * REACTION_SECONDS)
    elsewhere.type(f"{found[1]}\n")
    elsewhere.until("Tangy says:")
