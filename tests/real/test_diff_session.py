"""A long session: each screen, drawn by differential updates, equals a full redraw."""

from __future__ import annotations

import os
import signal
from pathlib import Path

import pytest

from tests.support.terminal import TANGY, Terminal

QUIET = 0.5  # s without output after which a screen counts as drawn
ENTER, ESCAPE, TAB, BACK, UP, DOWN = "\r", "\x1b", "\t", "\x7f", "\x1b[A", "\x1b[B"
F2, F3, F4, F6, F8, F10 = "\x1bOQ", "\x1bOR", "\x1bOS", "\x1b[17~", "\x1b[19~", "\x1b[21~"
DRAW, PALETTE, SHOWN = "\x0c", "\x10", "\x0f"
SUSPEND = "suspend"

SESSION: tuple[str | tuple[int, int], ...] = (
    *("greet everyone", ENTER, "y", "call numb", TAB, ENTER, "y"),
    (100, 30),
    *("call number", ENTER, "n", BACK, ENTER, "y", F2, F3, SUSPEND),
    *("tell a jok", ENTER, ESCAPE, "\x15", "?", DOWN, DOWN, ESCAPE),
    (120, 40),
    *("call number", ENTER, "y", F4, ESCAPE, PALETTE, "help", ESCAPE, ESCAPE),
    (80, 24),
    *(TAB, TAB, ENTER, "n", "\x15", SHOWN, ESCAPE, F10, SUSPEND),
    *("what can I say", ENTER, "\x15", UP, DOWN),
    (160, 45),
    *("call number", ENTER, "y", "call number", ENTER, "y", F6, DOWN, ESCAPE),
    (80, 24),
    *(SUSPEND, F2, F2, "undo", ENTER, "\x15", F8, ESCAPE, ESCAPE),
)
"""Keys, sizes of the window, and times at which the program is suspended."""


@pytest.mark.slow
def test_every_screen_of_a_session_equals_a_full_redraw(tmp_path: Path) -> None:
    command = [TANGY, "--data", str(tmp_path), "teach", "--teacher", "ann", "--seed", "3"]
    terminal = Terminal(command)
    try:
        terminal.until("type a command")
        terminal.settle(QUIET)
        for number, act in enumerate(SESSION):
            if isinstance(act, tuple):
                terminal.resize(*act)
            elif act == SUSPEND:
                os.kill(terminal.process.pid, signal.SIGTSTP)
                terminal.settle(QUIET)
                os.kill(terminal.process.pid, signal.SIGCONT)
            else:
                terminal.type(act)
            terminal.settle(QUIET)
            told, cells = terminal.text, terminal.cells
            terminal.wipe()
            terminal.type(DRAW)
            terminal.settle(QUIET)
            where = f"after act {number}, {act!r}"
            assert terminal.text == told, where
            assert terminal.cells == cells, where
        assert terminal.process.poll() is None
    finally:
        terminal.end()
