"""The frame in a real pty: keys typed ahead, silence while idle, and every exit."""

from __future__ import annotations

import fcntl
import os
import pty
import select
import signal
import struct
import subprocess
import sys
import termios
from collections.abc import Iterator
from pathlib import Path
from time import monotonic

import pyte
import pytest

PATIENCE = 20.0  # s
SILENCE = 0.5  # s without output that count as idle, and longer than the guard time of a question


class Window:
    """The gallery in its own terminal, read by a terminal in memory."""

    def __init__(self, columns: int, lines: int, *options: str) -> None:
        self.terminal, child = pty.openpty()
        self.before = termios.tcgetattr(child)
        self.screen = pyte.Screen(columns, lines)
        self.stream = pyte.ByteStream(self.screen)
        self.resize(columns, lines)
        kept = {k: v for k, v in os.environ.items() if k != "NO_COLOR"}
        self.process = subprocess.Popen(  # noqa: S603 - our own program
            [sys.executable, "-m", "tests.support.gallery", *options],
            cwd=Path(__file__).parents[2],
            stdin=child,
            stdout=child,
            stderr=child,
            # an exported size, as pytest-xdist has it, must not hide that of this window
            env={
                **kept,
                "COLUMNS": "100",
                "LINES": "30",
                "TERM": "xterm-256color",
                "LC_ALL": "C.UTF-8",
            },
            start_new_session=True,
        )
        self.child = child

    def text(self) -> str:
        """Return the window's text."""
        return "\n".join(self.screen.display)

    def read(self, seconds: float) -> bytes:
        """Read at most one piece of output within some seconds."""
        if not select.select([self.terminal], [], [], seconds)[0]:
            return b""
        try:
            piece = os.read(self.terminal, 1 << 16)
        except OSError:
            return b""
        # pyte takes the kitty protocol's private sequences for text
        self.stream.feed(piece.replace(b"\x1b[>25u", b"").replace(b"\x1b[<u", b""))
        return piece

    def until(self, word: str) -> None:
        """Wait until a word is in the window."""
        begun = monotonic()
        while word not in self.text():
            assert monotonic() - begun < PATIENCE, f"no {word!r} in:\n{self.text()}"
            self.read(0.2)

    def settle(self) -> None:
        """Wait until output stops."""
        begun = monotonic()
        while self.read(SILENCE):
            assert monotonic() - begun < PATIENCE, "it never falls silent"

    def type(self, keys: str) -> None:
        """Type keys in a single write."""
        os.write(self.terminal, keys.encode())

    def resize(self, columns: int, lines: int) -> None:
        """Resize the window."""
        fcntl.ioctl(self.terminal, termios.TIOCSWINSZ, struct.pack("HHHH", lines, columns, 0, 0))
        self.screen.resize(lines, columns)

    def status(self) -> int:
        """Wait for the end of the program; return its exit status."""
        begun = monotonic()
        while self.process.poll() is None:
            assert monotonic() - begun < PATIENCE, "it does not end"
            self.read(0.05)
        return self.process.returncode

    def close(self) -> None:
        """End the process, if it still runs."""
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
        for end in (self.terminal, self.child):
            if end >= 0:
                os.close(end)


@pytest.fixture
def window() -> Iterator[Window]:
    """A window of 80 x 24 with the gallery in it."""
    opened = Window(80, 24)
    opened.until("type a command")
    opened.settle()
    yield opened
    opened.close()


@pytest.mark.slow
def test_only_a_y_in_a_later_write_answers(window: Window) -> None:
    window.type("call number\ry")
    window.until("Did you say: call number?")
    window.settle()
    assert "Did you say" in window.text()
    assert "15 facilitate" not in window.text()
    window.type("y")
    window.until("15 facilitate")
    assert "> y" not in window.text()


@pytest.mark.slow
def test_an_idle_program_writes_nothing(window: Window) -> None:
    assert window.read(1.5) == b""
    window.type("c")
    window.settle()
    assert window.read(1.5) == b""  # the cursor in the command bar does not blink
    window.type("\r")
    window.until("Did you say")
    window.settle()
    assert window.read(1.5) == b""


@pytest.mark.slow
def test_ctrl_c_restores_the_terminal(window: Window) -> None:
    window.type("\x03")
    assert window.status() == 0
    assert termios.tcgetattr(window.child) == window.before


@pytest.mark.slow
@pytest.mark.parametrize(
    ("number", "code"), [(signal.SIGTERM, 143), (signal.SIGHUP, 129)], ids=["TERM", "HUP"]
)
def test_signals_restore_the_terminal(window: Window, number: int, code: int) -> None:
    os.kill(window.process.pid, number)
    assert window.status() == code
    assert termios.tcgetattr(window.child) == window.before


@pytest.mark.slow
def test_the_mouse_can_be_switched_off_and_on(window: Window) -> None:
    for keys, expected in (("\x1b", b""), ("m", b"\x1b[?1000l"), ("m", b"\x1b[?1000h")):
        window.type(keys)
        written = b""
        while piece := window.read(SILENCE):
            written += piece
        assert expected in written


@pytest.mark.slow
def test_a_closed_terminal_ends_the_program(window: Window) -> None:
    os.close(window.child)
    os.close(window.terminal)
    window.child = window.terminal = -1
    os.kill(window.process.pid, signal.SIGHUP)  # as the kernel does for a controlling terminal
    assert window.process.wait(PATIENCE) == 129


@pytest.mark.slow
def test_a_small_window_shows_a_message_and_loses_nothing(window: Window) -> None:
    window.type("call num")
    window.settle()
    window.resize(40, 10)
    os.kill(window.process.pid, signal.SIGWINCH)
    window.until("Make it larger")
    window.resize(80, 24)
    os.kill(window.process.pid, signal.SIGWINCH)
    window.until("> call num")


@pytest.mark.slow
def test_ascii_writes_only_ascii() -> None:
    window = Window(100, 30, "--ascii")
    try:
        written = b""
        while "type a command" not in window.text():
            piece = window.read(PATIENCE)
            assert piece
            written += piece
        window.type("\x1bg")
        while piece := window.read(SILENCE):
            written += piece
            if len(written) > 200_000:
                break
        assert written.isascii()
    finally:
        window.close()
