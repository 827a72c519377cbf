"""Files that people name: regular ones of a size that can be, or one sentence that says why not.

A pipe would be waited for without end, and a device be read without end; neither is opened here.
What may be a pipe (a script, a microphone) is opened where that is promised.
"""

from __future__ import annotations

import os
import stat
from pathlib import Path
from typing import BinaryIO

from tangy_profiles.errors import TangyError
from tangy_profiles.plain_text import plain

FLAGS = os.O_RDONLY | os.O_CLOEXEC | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_NOCTTY", 0)


def open_given(
    path: Path, most: int, kind: type[TangyError] = TangyError, *, called: str = ""
) -> BinaryIO:
    """Open a regular file to read.

    Args:
        path: which one; a link to one is as good.
        most: the bytes that it may have.
        kind: of the error.
        called: how it is called where it is there, but too large; as it was named otherwise.

    Raises:
        TangyError: of that kind: it is missing, no regular file, too large, or cannot be opened.
    """
    name = plain(str(path))
    try:
        _check(os.stat(path), most, name, kind, called)  # noqa: PTH116 - as below, before it is opened
        file = os.open(path, FLAGS)
        try:
            _check(os.fstat(file), most, name, kind, called)  # it may have been exchanged meanwhile
        except BaseException:
            os.close(file)
            raise
    except FileNotFoundError:
        raise kind(f"{name}: there is no such file.") from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or "the name is not valid"
        raise kind(f"{name}: cannot be read ({reason}).") from None
    return os.fdopen(file, "rb")


def read_given(
    path: Path, most: int, kind: type[TangyError] = TangyError, *, called: str = ""
) -> bytes:
    """Read a regular file as a whole; its arguments are those of `open_given`.

    Raises:
        TangyError: of that kind: as for `open_given`, or it cannot be read.
    """
    name = plain(str(path))
    with open_given(path, most, kind, called=called) as file:
        try:
            content = file.read(most + 1)  # some say that they have no size, and have one
        except OSError as error:
            raise kind(f"{name}: cannot be read ({error.strerror}).") from None
    if len(content) > most:
        raise kind(_too_large(called or name, most))
    return content


def read_given_text(path: Path, most: int, kind: type[TangyError] = TangyError) -> str:
    """Read a regular file as UTF-8 text, its lines ended by a line feed each.

    Raises:
        TangyError: of that kind: as for `read_given`, or it is no such text.
    """
    try:
        return lines_of(read_given(path, most, kind))
    except UnicodeDecodeError:
        raise kind(f"{plain(str(path))}: is not UTF-8 text.") from None


def lines_of(content: bytes) -> str:
    """Return UTF-8 text whose lines are ended by a line feed each.

    Raises:
        UnicodeDecodeError: it is no such text.
    """
    return content.decode().replace("\r\n", "\n").replace("\r", "\n")


def _check(
    found: os.stat_result, most: int, name: str, kind: type[TangyError], called: str
) -> None:
    if not stat.S_ISREG(found.st_mode):
        raise kind(f"{name}: is not a file but {_kind_of(found.st_mode)}.")
    if found.st_size > most:
        raise kind(_too_large(called or name, most))


def _kind_of(mode: int) -> str:
    if stat.S_ISDIR(mode):
        return "a folder"
    if stat.S_ISFIFO(mode):
        return "a pipe"
    return "a socket" if stat.S_ISSOCK(mode) else "a device"


def _too_large(name: str, most: int) -> str:
    return f"{name}: is larger than {most:,} bytes."
