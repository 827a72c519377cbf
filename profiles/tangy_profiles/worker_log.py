"""The file that takes what a worker process has to say; it does not grow without end."""

from __future__ import annotations

import os
from pathlib import Path
from typing import BinaryIO

MOST = 1 << 20  # bytes: beyond, it is cut when it is opened
KEPT = 1 << 18  # bytes of its end that are left then


def open_log(path: Path) -> BinaryIO:
    """Open a log to append to; one that has become too long keeps just its last lines.

    Raises:
        OSError: it cannot be written.
    """
    log = path.open("ab")
    try:
        if os.fstat(log.fileno()).st_size > MOST:
            _cut(path)
    except BaseException:
        log.close()
        raise
    return log


def _cut(path: Path) -> None:
    """Move the last lines to the beginning; whoever appends to the file goes on behind them."""
    with path.open("r+b") as file:
        file.seek(-KEPT, os.SEEK_END)
        end = file.read(KEPT)
        file.seek(0)
        file.write(end[end.find(b"\n") + 1 :])
        file.truncate()
