"""Files named by users: opens only regular files of limited size, or raises one sentence.

A pipe would block and a device might never end; neither is opened here. Where pipes are allowed (a
script, a microphone), they are opened elsewhere.
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
    """Open a regular file for reading.

    Args:
        path: the file, or a link to one.
        most: the largest size in bytes.
        kind: the class of the error.
        called: the name in the error of a too large file; by default the path.

    Raises:
        TangyError: of that class: it is missing, not a regular file, too large, or cannot be
            opened.
    """
    name = plain(str(path))
    try:
        _check(os.stat(path), most, name, kind, called)  # noqa: PTH116 - before opening, see below
        file = os.open(path, FLAGS)
        try:
            _check(os.fstat(file), most, name, kind, called)  # it may have been replaced
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
    """Read a whole regular file; the arguments are those of `open_given`.

    Raises:
        TangyError: of that class: as for `open_given`, or it cannot be read.
    """
    name = plain(str(path))
    with open_given(path, most, kind, called=called) as file:
        try:
            content = file.read(most + 1)  # the reported size may be wrong
        except OSError as error:
            raise kind(f"{name}: cannot be read ({error.strerror}).") from None
    if len(content) > most:
        raise kind(_too_large(called or name, most))
    return content


def read_given_text(path: Path, most: int, kind: type[TangyError] = TangyError) -> str:
    """Read a regular file as UTF-8 text with normalised line ends.

    Raises:
        TangyError: of that class: as for `read_given`, or it is not UTF-8.
    """
    try:
        return lines_of(read_given(path, most, kind))
    except UnicodeDecodeError:
        raise kind(f"{plain(str(path))}: is not UTF-8 text.") from None


def lines_of(content: bytes) -> str:
    """Decode UTF-8 text without its byte order mark, and normalise its line ends.

    Raises:
        UnicodeDecodeError: it is not UTF-8.
    """
    return content.decode("utf-8-sig").replace("\r\n", "\n").replace("\r", "\n")


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
