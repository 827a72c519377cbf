"""The count beside a log: how many events were kept, to notice when its newest are gone.

SQLite takes the newest events from the log's tail (`tangy.db-wal`) as far as that is sound, and
leaves out the rest without a word. The count is written after each commit without waiting for the
disk, so that it costs microseconds. It never leads: after a program was killed it lags by one
commit at most, after a power cut by what the machine had not written yet (30 s, usually).
"""

from __future__ import annotations

import os
import zlib
from contextlib import suppress
from pathlib import Path

FILE = "tangy.seal"
_LENGTH = 67  # bytes: of a seal


class Seal:
    """The count of one log, in a file beside it; where that cannot be had there is no count."""

    def __init__(self, folder: Path) -> None:
        """Name the file; nothing is touched yet."""
        self.path = folder / FILE
        self._file: int | None = None

    def read(self) -> tuple[str, int] | None:
        """Return the robot of the log, and the seq of its newest event.

        None if nobody can tell: there is no count, or it is damaged.
        """
        try:
            robot, seq, sum = self.path.read_bytes().decode("ascii").split()
            return (robot, int(seq)) if int(sum, 16) == _sum(robot, seq) else None
        except (OSError, ValueError):
            return None

    def write(self, robot: str, seq: int) -> None:
        """Note which event is the newest that was kept; where that cannot be, the count lags."""
        text = f"{seq:020}"
        with suppress(OSError):
            if self._file is None:
                flags = os.O_WRONLY | os.O_CREAT | os.O_NOFOLLOW | os.O_CLOEXEC
                self._file = os.open(self.path, flags, 0o600)
                os.fchmod(self._file, 0o600)  # whatever the umask
                os.ftruncate(self._file, _LENGTH)
            os.pwrite(self._file, f"{robot} {text} {_sum(robot, text):08x}\n".encode(), 0)

    def close(self) -> None:
        """Let the file go; may be repeated."""
        file, self._file = self._file, None
        if file is not None:
            os.close(file)


def _sum(robot: str, seq: str) -> int:
    return zlib.crc32(f"{robot} {seq}".encode())
