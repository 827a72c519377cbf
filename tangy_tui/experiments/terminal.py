"""The program in a pseudo-terminal, for typing into it like a person."""

from __future__ import annotations

import os
import select
import signal
import subprocess
import sys
from collections.abc import Callable, Sequence
from contextlib import suppress
from time import monotonic
from types import TracebackType
from typing import Self

from tangy_profiles.errors import TangyError
from tangy_tui.experiments.screen import Screen

PROGRAM = (sys.executable, "-c", "from tangy_tui.cli import main; main()")
COLUMNS, LINES = 120, 40
PATIENCE = 60.0
"""Timeout (s) of an expected text on the screen."""


class Terminal:
    """A pseudo-terminal that runs the program; closing it ends the program."""

    def __init__(self, words: Sequence[str]) -> None:
        """Start the program with these arguments.

        Raises:
            TangyError: this system has no pseudo-terminals.
        """
        try:
            import fcntl
            import pty
            import struct
            import termios
        except ImportError:
            raise TangyError(
                "Typing needs a system with pseudo-terminals: leave it out with --no-typing."
            ) from None
        self.screen = Screen(COLUMNS, LINES)
        self._mine, theirs = pty.openpty()
        fcntl.ioctl(self._mine, termios.TIOCSWINSZ, struct.pack("HHHH", LINES, COLUMNS, 0, 0))
        # The user's environment may request colours; a plain terminal is enough.
        environment = {**os.environ, "TERM": "xterm-256color", "LANG": "C.UTF-8"}
        self._process = subprocess.Popen(  # noqa: S603 - our own program
            [*PROGRAM, *words],
            stdin=theirs,
            stdout=theirs,
            stderr=theirs,
            env=environment,
            start_new_session=True,
        )
        os.close(theirs)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        with suppress(ProcessLookupError):
            os.killpg(self._process.pid, signal.SIGTERM)
        os.close(self._mine)  # so that it does not wait for its last output to be read
        try:
            self._process.wait(10)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()

    def press(self, keys: str) -> None:
        """Press keys, all at once."""
        os.write(self._mine, keys.encode())

    def watch(self, seconds: float) -> None:
        """Read the screen for some s."""
        until = monotonic() + seconds
        while (left := until - monotonic()) > 0:
            self._read(left)

    def sees(self, seen: Callable[[Screen], bool], seconds: float) -> bool:
        """Wait up to some s until a condition on the screen holds; return whether it does."""
        deadline = monotonic() + seconds
        while not seen(self.screen):
            if monotonic() > deadline or not self._read(max(0.0, deadline - monotonic())):
                return seen(self.screen)
        return True

    def until(self, seen: Callable[[Screen], bool], what: str) -> None:
        """Wait until a condition on the screen holds.

        Raises:
            TangyError: it timed out, or the program has ended.
        """
        if not self.sees(seen, PATIENCE):
            raise TangyError(f"The program in the terminal never showed {what}.")

    def _read(self, seconds: float) -> bool:
        """Read once, with a timeout; return whether the program is still running."""
        if not select.select([self._mine], [], [], seconds)[0]:
            return self._process.poll() is None
        try:
            written = os.read(self._mine, 65536)
        except OSError:  # on Linux, when the program has closed its side
            return False
        self.screen.feed(written)
        return bool(written)
