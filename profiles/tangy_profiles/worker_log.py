"""The log file of a worker process, limited in size."""

from __future__ import annotations

import errno
import os
import stat
from contextlib import suppress
from pathlib import Path
from typing import BinaryIO

MOST = 1 << 20  # bytes beyond which it is shortened when opened
KEPT = 1 << 18  # bytes of its end that are kept


def open_log(path: Path) -> BinaryIO:
    """Open a log for appending, and shorten one that is too long.

    Only its owner may read it, because errors may name people.

    Raises:
        OSError: it cannot be written.
    """
    flags = os.O_WRONLY | os.O_CREAT | os.O_APPEND | os.O_CLOEXEC | os.O_NONBLOCK
    log = os.fdopen(os.open(path, flags, 0o600), "ab")
    try:
        if not stat.S_ISREG(os.fstat(log.fileno()).st_mode):
            raise OSError(errno.EINVAL, "is no file")
        with suppress(PermissionError):  # it belongs to another user
            os.fchmod(log.fileno(), 0o600)  # despite the umask, also if another program created it
        if os.fstat(log.fileno()).st_size > MOST:
            cut(path)
    except BaseException:
        log.close()
        raise
    return log


def cut(path: Path) -> None:
    """Shorten a log: its last lines move to its beginning.

    Other processes may keep appending to it.
    """
    with path.open("r+b") as file:
        file.seek(-KEPT, os.SEEK_END)
        end = file.read(KEPT)
        file.seek(0)
        file.write(end[end.find(b"\n") + 1 :])
        file.truncate()
