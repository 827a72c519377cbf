"""Teaching in a real terminal: typed, verified, stored, and resumed."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from tangy_tui.console.typed_yes import REACTION_SECONDS

if TYPE_CHECKING:
    from tests.real.conftest import OpenTerminal
    from tests.support.terminal import Tmux


@pytest.mark.parametrize(
    ("columns", "lines"), [(80, 24), pytest.param(160, 45, marks=pytest.mark.slow)]
)
def test_a_typed_step_is_verified_stored_and_shown_after_a_restart(
    open_tmux: Callable[[int, int], Tmux], tangy: str, tmp_path: Path, columns: int, lines: int
) -> None:
    tmux = open_tmux(columns, lines)
    command = (tangy, "teach", "--teacher", "Ada", "--seed", "1", "--data", str(tmp_path / "data"))
    tmux.run(*command)
    tmux.until("type a command")
    tmux("send-keys", "-l", "greet everyone")
    tmux("send-keys", "Enter")
    asked = tmux.until(partial(_shows, ("Did you say: greet everyone?", "Y yes")))
    assert "greeting" not in asked.replace("greet everyone", "")
    tmux("send-keys", "Enter")
    tmux("send-keys", "Space")
    assert "Did you say" in tmux.text
    tmux.confirm("-> greet everyone")
    tmux("send-keys", "C-c")
    tmux.until(lambda text: text.rstrip().endswith(("#", "$")))  # the shell's prompt is back
    tmux.run("clear;", *command)
    tmux.until(partial(_shows, ("-> greet everyone", "step 1", "type a command")))


def _shows(parts: tuple[str, ...], text: str) -> bool:
    """Return whether all of it is there: a terminal draws a screen piece by piece."""
    return all(part in text for part in parts)


@pytest.mark.slow
def test_a_y_typed_ahead_does_not_answer(open_terminal: OpenTerminal) -> None:
    terminal = open_terminal("teach", "--seed", "1")
    terminal.until("type a command")
    terminal.type("greet everyone\ry")
    terminal.until("Did you say: greet everyone?")
    terminal.settle()
    assert "Did you say" in terminal.text
    assert "-> greet everyone" not in terminal.text
    terminal.type("y")
    terminal.until("-> greet everyone")


@pytest.mark.slow
def test_a_no_returns_the_words_to_the_line(open_terminal: OpenTerminal) -> None:
    terminal = open_terminal("teach", "--seed", "1")
    terminal.until("type a command")
    terminal.type("call number\r")
    terminal.until("Did you say: call number?")
    terminal.settle(0.4)
    terminal.type("n")
    text = terminal.until(lambda shown: "Did you say" not in shown)
    terminal.until("> call number")
    assert "No steps yet" in text


@pytest.mark.slow
@pytest.mark.parametrize(
    ("number", "status"), [(signal.SIGTERM, 143), (signal.SIGHUP, 129)], ids=["term", "hup"]
)
def test_a_signal_ends_the_program_cleanly(
    open_terminal: OpenTerminal, number: signal.Signals, status: int
) -> None:
    terminal = open_terminal("teach", "--seed", "1")
    terminal.until("type a command")
    os.kill(terminal.process.pid, number)
    assert terminal.wait() == status
    assert b"\x1b[?1049l" in terminal.raw  # the shell's own screen is back


@pytest.mark.slow
def test_a_closed_window_ends_the_program_and_loses_nothing(
    open_terminal: OpenTerminal,
) -> None:
    terminal = open_terminal("teach", "--seed", "1")
    terminal.until("type a command")
    terminal.type("greet everyone\r")
    terminal.until("Did you say")
    terminal.settle(0.4)
    terminal.type("y")
    terminal.until("-> greet everyone")
    terminal.close()
    terminal.process.wait(timeout=20)
    again = open_terminal("teach")
    again.until("-> greet everyone")


@pytest.mark.slow
def test_a_second_program_on_the_same_folder_names_the_first(
    open_terminal: OpenTerminal,
) -> None:
    first = open_terminal("teach", "--seed", "1")
    first.until("type a command")
    second = open_terminal("teach")
    assert second.wait() == 2
    words = " ".join(second.text.split())
    assert str(first.process.pid) in words
    assert "--data" in "".join(words.split())  # the line may break anywhere
    first.type("greet everyone\r")
    first.until("Did you say")


@pytest.mark.slow
def test_a_small_window_shows_a_message_and_loses_nothing(
    open_terminal: OpenTerminal,
) -> None:
    terminal = open_terminal("teach", "--seed", "1", columns=40, lines=10)
    terminal.until(lambda text: "60 x 18" in " ".join(text.split()))
    terminal.resize(80, 24)
    terminal.until("type a command")
    terminal.type("greet every")
    terminal.until("greet every")
    terminal.resize(40, 10)
    terminal.until(lambda text: "60 x 18" in " ".join(text.split()))
    terminal.resize(100, 30)
    terminal.until("> greet every")


@pytest.mark.slow
def test_a_dumb_terminal_gets_lines(open_terminal: OpenTerminal) -> None:
    terminal = open_terminal("teach", "--seed", "1", environment={"TERM": "dumb"})
    terminal.until("Type what Tangy should do")
    terminal.type("greet everyone\n")
    terminal.until("Type Y to do it")
    terminal.settle(2 * REACTION_SECONDS)
    terminal.type("y\n")
    terminal.until("-> greet everyone")
    terminal.type("quit\n")
    assert terminal.wait() == 0
    assert b"\x1b" not in terminal.raw


@pytest.mark.slow
def test_a_terminal_without_utf8_gets_ascii(open_terminal: OpenTerminal) -> None:
    terminal = open_terminal(
        "teach", "--seed", "1", environment={"LANG": "C", "LC_ALL": "C", "PYTHONUTF8": "0"}
    )
    terminal.until("type a command")
    assert terminal.raw.isascii()


@pytest.mark.slow
def test_an_idle_program_writes_nothing(open_terminal: OpenTerminal) -> None:
    terminal = open_terminal("teach", "--seed", "1", columns=120, lines=40)
    terminal.until("type a command")
    terminal.settle(1.0)
    assert terminal.read(2.0) == b""
