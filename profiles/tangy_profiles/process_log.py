"""The log of each process: a line for each decision, with the id of its command.

The program writes `program.log` in the data folder; the robot process, its cameras, the speech
worker and the device simulator write to files beside it (see `worker_log`). A command has one id
from the key press to the driver and back; messages between processes include it.
"""

from __future__ import annotations

import io
import logging
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from pathlib import Path
from typing import Any, TextIO

from tangy_profiles.worker_log import MOST, cut, open_log

PROGRAM_LOG = "program.log"
LOGS = {
    PROGRAM_LOG: "the program: commands, decisions, games",
    "robot.log": "the robot process and its drivers",
    "camera.log": "the cameras",
    "speech.log": "the speech worker",
    "bench.log": "the device simulator (--bench)",
}
"""The log files of a data folder, and their processes."""
PACKAGES = ("tangy_tui", "tangy_sim", "tangy_hw", "tangy_profiles")
"""The packages whose messages are logged."""
LEVEL = "TANGY_LOG"
"""The environment variable of the log level: debug, info (default), warning, error."""
NO_COMMAND = "-"
LONGEST_ID = 32

_command: ContextVar[str] = ContextVar("command", default=NO_COMMAND)


def command_id() -> str:
    """Return the id of the current command; "-" if there is none."""
    return _command.get()


@contextmanager
def serving(command: object = None) -> Iterator[str]:
    """Carry out a command in this context: all log lines have its id.

    Args:
        command: its id, as received from another process; an invalid one counts as none. None: the
            id of the current command, or else a new one.
    """
    if isinstance(command, str) and 0 < len(command) <= LONGEST_ID and command.isalnum():
        chosen = command
    elif command is None:
        chosen = os.urandom(4).hex() if command_id() == NO_COMMAND else command_id()
    else:
        chosen = NO_COMMAND
    token = _command.set(chosen)
    try:
        yield chosen
    finally:
        _command.reset(token)


class _Lines(logging.StreamHandler[TextIO]):
    """Writes lines to a stream, each with the id of its command; ignores errors."""

    def __init__(self, stream: TextIO) -> None:
        super().__init__(stream)
        text = "%(asctime)s %(process)d %(levelname)-7s %(name)s [%(command)s] %(message)s"
        self.setFormatter(logging.Formatter(text))

    def filter(self, record: logging.LogRecord) -> bool:
        record.command = command_id()
        return record.name.startswith("tangy_")

    def handleError(self, record: logging.LogRecord) -> None:
        """Ignore the error: a log that cannot be written must stop nothing."""


class _File(_Lines):
    """Appends lines to a file, which is opened by the first line, and shortened when too long."""

    def __init__(self, path: Path) -> None:
        super().__init__(sys.stderr)
        self.path = path
        self._opened = self._failed = False

    def emit(self, record: logging.LogRecord) -> None:
        if not self._opened and not self._failed:
            try:
                self.stream = io.TextIOWrapper(open_log(self.path), encoding="utf-8")
                self._opened = True
            except OSError:
                self._failed = True
        if self._opened:
            super().emit(record)
            with suppress(OSError, ValueError):
                if os.fstat(self.stream.fileno()).st_size > MOST:
                    cut(self.path)

    def close(self) -> None:
        if self._opened:
            self._opened = False
            with suppress(OSError):
                self.stream.close()
        super().close()


def log_to_stderr() -> None:
    """Log to standard error, in a child process."""
    _begin(_Lines(sys.stderr))


@contextmanager
def logging_to(folder: Path) -> Iterator[None]:
    """Log to a data folder within this context."""
    before = {name: logging.getLogger(name).level for name in PACKAGES}
    handler = _begin(_File(folder / PROGRAM_LOG))
    try:
        yield
    finally:
        logging.getLogger().removeHandler(handler)
        handler.close()
        for name, level in before.items():
            logging.getLogger(name).setLevel(level)


def _begin(handler: logging.Handler) -> logging.Handler:
    wanted: Any = logging.getLevelNamesMapping().get(os.environ.get(LEVEL, "").upper())
    handler.setLevel(logging.INFO if wanted is None else wanted)
    for name in PACKAGES:
        logging.getLogger(name).setLevel(handler.level)
    logging.getLogger().addHandler(handler)
    return handler
