"""Real terminals for tests and recordings: a pty read by a terminal in memory, and tmux."""

from __future__ import annotations

import fcntl
import os
import pty
import re
import select
import shutil
import signal
import struct
import subprocess
import sys
import termios
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
from time import monotonic

import pyte

PATIENCE = 60.0
"""Seconds after which an expected text counts as missing."""

IDLE = 0.15
"""The share of the processor below which a program counts as idle."""

KEY_PROTOCOL = re.compile(rb"\x1b\[[<>=][0-9;]*u")
"""Turns the kitty keyboard protocol on and off; pyte would write its last letter."""

TANGY = str(Path(sys.executable).parent / "tangy")


class Terminal:
    """A program in a pty, and the text of its screen."""

    def __init__(
        self,
        command: Sequence[str],
        *,
        columns: int = 80,
        lines: int = 24,
        environment: dict[str, str] | None = None,
    ) -> None:
        self._screen = pyte.Screen(columns, lines)
        self._stream = pyte.ByteStream(self._screen)
        self.raw = b""
        """All output to the terminal."""
        self._parent, child = pty.openpty()
        self.resize(columns, lines)
        self.process = subprocess.Popen(  # noqa: S603 - our own program
            command,
            stdin=child,
            stdout=child,
            stderr=child,
            env={**os.environ, "TERM": "xterm-256color", "LANG": "C.UTF-8", **(environment or {})},
            start_new_session=True,
            preexec_fn=lambda: fcntl.ioctl(child, termios.TIOCSCTTY, 0),
        )
        os.close(child)

    def resize(self, columns: int, lines: int) -> None:
        """Resize the window."""
        size = struct.pack("HHHH", lines, columns, 0, 0)
        fcntl.ioctl(self._parent, termios.TIOCSWINSZ, size)
        self._screen.resize(lines, columns)

    def wipe(self) -> None:
        """Wipe the screen, as if another program had written on it."""
        self._screen.reset()

    @property
    def parent(self) -> int:
        """The file descriptor of the terminal's own side."""
        return self._parent

    @property
    def text(self) -> str:
        """The readable text of the screen."""
        return "\n".join(line.rstrip() for line in self._screen.display)

    @property
    def cells(self) -> list[list[tuple[object, ...]]]:
        """The visible part of each cell: its character, colours and attributes."""
        rows, buffer = range(self._screen.lines), self._screen.buffer
        return [[_seen(buffer[y][x]) for x in range(self._screen.columns)] for y in rows]

    def read(self, seconds: float) -> bytes:
        """Read output for this long; stops at the first chunk."""
        if not select.select([self._parent], [], [], seconds)[0]:
            return b""
        try:
            chunk = os.read(self._parent, 65536)
        except OSError:  # the program has closed its side
            return b""
        self.raw += chunk
        self._stream.feed(KEY_PROTOCOL.sub(b"", chunk))
        return chunk

    def until(self, seen: str | Callable[[str], bool]) -> str:
        """Read until a text is on the screen, or a condition is true; return all text."""
        found = (lambda text: seen in text) if isinstance(seen, str) else seen
        deadline = monotonic() + PATIENCE
        while not found(self.text):
            if monotonic() > deadline or (not self.read(0.2) and self.process.poll() is not None):
                self.read(0.0)
                if found(self.text):
                    break
                raise AssertionError(f"never saw {seen!r}; the screen shows:\n{self.text}")
        return self.text

    def settle(self, seconds: float = 0.5) -> int:
        """Read until output stops for a while, and work with it; return the number of bytes.

        On a busy machine a program is silent before it has drawn what a key asks for.
        """
        count, worked, deadline = 0, self._work(), monotonic() + PATIENCE
        while True:
            while chunk := self.read(seconds):
                count += len(chunk)
            before, worked = worked, self._work()
            if worked - before <= IDLE * seconds or monotonic() > deadline:
                return count

    def _work(self) -> float:
        """Return the CPU seconds of the program, without its children; 0 where none tells."""
        try:
            told = Path(f"/proc/{self.process.pid}/stat").read_text(encoding="utf-8")
        except OSError:
            return 0.0
        user, system = told.rpartition(")")[2].split()[11:13]
        return (int(user) + int(system)) / os.sysconf("SC_CLK_TCK")

    def type(self, keys: str) -> None:
        """Type keys."""
        os.write(self._parent, keys.encode())

    def wait(self) -> int:
        """Read to the end of the program; return its exit status."""
        deadline = monotonic() + PATIENCE
        while self.process.poll() is None and monotonic() < deadline:
            self.read(0.1)
        while self.read(0.0):
            pass
        return self.process.wait(timeout=1)

    def close(self) -> None:
        """Close the window, as a person would."""
        if self._parent >= 0:
            os.close(self._parent)
            self._parent = -1

    def end(self) -> None:
        """Clean up, whatever state the program is in."""
        with suppress(ProcessLookupError):
            os.killpg(self.process.pid, signal.SIGKILL)
        self.process.wait()
        self.close()


def _seen(cell: pyte.screens.Char) -> tuple[object, ...]:
    """Return the visible part of a cell: of a blank one, its background and lines."""
    if cell.data == " " and not cell.reverse:
        lined = cell.underscore or cell.strikethrough
        return (" ", cell.fg if lined else "", cell.bg, cell.underscore, cell.strikethrough)
    return tuple(cell)


def ended(pid: int) -> bool:
    """Wait for a process to end."""
    try:
        descriptor = os.pidfd_open(pid)
    except ProcessLookupError:
        return True
    try:
        return bool(select.select([descriptor], [], [], PATIENCE)[0])
    finally:
        os.close(descriptor)


class Tmux:
    """A tmux server of one test, with one window."""

    def __init__(self, folder: Path, columns: int, lines: int) -> None:
        tmux = shutil.which("tmux")
        assert tmux is not None
        self._tmux = [tmux, "-S", str(folder / "tmux")]
        self._pipe = folder / "written"
        os.mkfifo(self._pipe)
        self._size = ["-x", str(columns), "-y", str(lines)]
        self._reader = -1

    def __call__(self, *words: str) -> str:
        """Send tmux a command."""
        done = subprocess.run(  # noqa: S603 - tmux, found on the path
            [*self._tmux, *words], capture_output=True, text=True, check=True
        )
        return done.stdout

    def run(self, *command: str) -> None:
        """Run a program in the window, with a shell behind it that stays."""
        if self._reader < 0:
            self("-f", "/dev/null", "new-session", "-d", *self._size, "sh")
            self._reader = os.open(self._pipe, os.O_RDONLY | os.O_NONBLOCK)
            self("pipe-pane", "-o", f"cat > '{self._pipe}'")
        self("send-keys", "-l", " ".join(command))
        self("send-keys", "Enter")

    @property
    def text(self) -> str:
        """The readable text of the window."""
        return self("capture-pane", "-p")

    def until(self, seen: str | Callable[[str], bool]) -> str:
        """Wait until a text is in the window, and return the window's text."""
        found = (lambda text: seen in text) if isinstance(seen, str) else seen
        deadline = monotonic() + PATIENCE
        while not found(text := self.text):
            if monotonic() > deadline:
                raise AssertionError(f"never saw {seen!r}; the window shows:\n{text}")
            if select.select([self._reader], [], [], 0.2)[0]:
                os.read(self._reader, 65536)
        return text

    def confirm(self, done: str) -> None:
        """Press y until the question accepts it, and the window shows that it was `done`.

        In its guard time a question accepts no key.
        """

        def confirmed(text: str) -> bool:
            if done not in text and "Did you say" in text:
                self("send-keys", "y")
            return done in text

        self.until(confirmed)

    def end(self) -> None:
        """End the server."""
        with suppress(subprocess.CalledProcessError):
            self("kill-server")
        if self._reader >= 0:
            os.close(self._reader)
