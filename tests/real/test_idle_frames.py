"""Every written frame changes at least one cell."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.support.frames import FramedTerminal, frames_of
from tests.support.terminal import TANGY

QUIET = 0.3  # s


@pytest.mark.slow
@pytest.mark.parametrize("size", [(80, 24), (120, 40)])
def test_teaching_writes_no_frame_without_a_change(tmp_path: Path, size: tuple[int, int]) -> None:
    columns, lines = size
    command = [TANGY, "--data", str(tmp_path), "teach", "--teacher", "ann", "--seed", "3"]
    terminal = FramedTerminal(command, columns=columns, lines=lines)
    try:
        terminal.until("type a command")
        terminal.settle(QUIET)
        for phrase in ("greet everyone", "call number"):
            terminal.type(phrase)
            terminal.settle(QUIET)
            terminal.type("\r")
            terminal.until("Did you say")
            terminal.settle(QUIET)
            terminal.type("y")
            terminal.until(lambda text: "Did you say" not in text)
            terminal.settle(QUIET)
        for keys in ("\x1a", "\x19", "\x1bOP", "\x1b", "\x10", "\x1b", "\t", "\x15"):
            terminal.type(keys)
            terminal.settle(QUIET)
    finally:
        terminal.end()
    found = frames_of(terminal.raw, columns, lines)
    assert found.all > 20
    assert found.idle == ()
