"""The count beside a log: how many events were stored, to detect the loss of the newest.

SQLite replays the write-ahead log (`tangy.db-wal`) as far as it is valid, and drops the rest
silently. The count is written after each commit without an fsync, which takes microseconds. It is
never ahead: after a killed process it lags by at most one commit, after a power cut by the data not
written yet (usually 30 s).
"""

from __future__ import annotations

import os
import zlib
from contextlib import suppress
from pathlib import Path

FILE = "tangy.seal"
_LENGTH = 67  # bytes


class Seal:
    """The count of one log, in a file beside it; write errors are ignored."""

    def __init__(self, folder: Path) -> None:
        """Set the path; nothing is opened yet."""
        self.path = folder / FILE
        self._file: int | None = None

    def read(self) -> tuple[str, int] | None:
        """Return the robot id of the log, and the seq of its newest event.

        None if the count is missing or damaged.
        """
        try:
            robot, seq, sum = self.path.read_bytes().decode("ascii").split()
            return (robot, int(seq)) if int(sum, 16) == _sum(robot, seq) else None
        except (OSError, ValueError):
            return None

    def write(self, robot: str, seq: int) -> None:
        """Write the seq of the newest event; on an error the count lags."""
        text = f"{seq:020}"
        with suppress(OSError):
            if self._file is None:
                flags = os.O_WRONLY | os.O_CREAT | os.O_NOFOLLOW | os.O_CLOEXEC
                self._file = os.open(self.path, flags, 0o600)
                os.fchmod(self._file, 0o600)  # independent of the umask
                os.ftruncate(self._file, _LENGTH)
            os.pwrite(self._file, f"{robot} {text} {_sum(robot, text):08x}\n".encode(), 0)

    def close(self) -> None:
        """Close the file; idempotent."""
        file, self._file = self._file, None
        if file is not None:
            os.close(file)


def _sum(robot: str, seq: str) -> int:
    return zlib.crc32(f"{robot} {seq}".encode())
