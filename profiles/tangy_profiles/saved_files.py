"""Files in a data folder beside the log, and the erasure of a name from them.

Only files written by Tangy are changed: pages and process logs are text; copies of the log, and
damaged ones, are overwritten byte by byte. Other files are not changed, including lists redirected
by a shell, but those that hold the name are reported.
"""

from __future__ import annotations

import os
import re
import stat
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

from tangy_profiles.erasure import NameEraser
from tangy_profiles.errors import TangyError
from tangy_profiles.given_file import read_given
from tangy_profiles.log_file import FILE
from tangy_profiles.process_log import LOGS
from tangy_profiles.reading import plain
from tangy_profiles.salvage import SALVAGE

LARGEST = 64_000_000  # bytes of a file to search
OURS = (FILE, f"{FILE}-wal", f"{FILE}-shm", "tangy.lock", "tangy.seal")
"""Files that the writer of the log handles."""
PAGE_MARK = '<meta name="generator" content="Tangy"/>'
"""Marks a page that Tangy wrote."""

_MARKS = (PAGE_MARK.encode(), b"<style>\n:root { color-scheme: light dark; --font: system-ui")
"""The second marks pages up to version 0.6."""
_HEAD = 2000  # bytes of a page to search for its mark
_COPY = re.compile(rf"{re.escape(FILE)}\.(?:damaged-|version-\d|copying)")


class ErasureResult(NamedTuple):
    """The changed files, and those that may still have the name."""

    changed: tuple[Path, ...]
    left: tuple[Path, ...]


def erase_from_files(folder: Path, eraser: NameEraser) -> ErasureResult:
    """Erase a name from every file of a data folder except the log itself.

    A file is replaced atomically; files behind links are not changed.

    Raises:
        TangyError: a file with the name cannot be written.
    """
    changed, left = [], []
    for path in _files(folder):
        try:
            before = read_given(path, LARGEST)
        except TangyError:
            left.append(path)
            continue
        erased = _erasing(folder, path, before, eraser)
        after = erased(before) if erased else before
        if after != before and not path.is_symlink():
            _replace(path, after)
            changed.append(path)
        elif (
            after != before
            or (erased is None and _holds(before, eraser))
            or eraser.text(path.name) != path.name
        ):
            left.append(path)
    return ErasureResult(tuple(changed), tuple(left))


def _files(folder: Path) -> Iterator[Path]:
    for top, folders, names in os.walk(folder):
        folders.sort()
        for name in sorted(names):
            path = Path(top, name)
            with suppress(OSError):
                ours = Path(top) == folder and name in OURS
                if not ours and stat.S_ISREG(path.stat().st_mode):
                    yield path


def _erasing(
    folder: Path, path: Path, content: bytes, eraser: NameEraser
) -> Callable[[bytes], bytes] | None:
    """Return the function that erases the name from a file by Tangy; None for other files."""
    is_copy = path.parent == folder and _COPY.match(path.name)
    if is_copy or (path.parent.parent == folder and path.parent.name.startswith(SALVAGE)):
        return eraser.overwrite
    if _is_binary(content):
        return None
    if path.parent == folder and path.name in LOGS:
        return lambda text: eraser.text(text.decode()).encode()
    if any(mark in content[:_HEAD] for mark in _MARKS):
        return lambda text: eraser.page(text.decode()).encode()
    return None


def _holds(content: bytes, eraser: NameEraser) -> bool:
    """Return whether a file that is not Tangy's has the name."""
    if _is_binary(content):
        return eraser.overwrite(content) != content
    text = content.decode()
    return eraser.text(text) != text


def _is_binary(content: bytes) -> bool:
    try:
        return "\0" in content.decode()
    except UnicodeDecodeError:
        return True


def _replace(path: Path, content: bytes) -> None:
    """Rewrite a file atomically, with its permissions."""
    begun = path.with_name(f".{path.name}.erasing")
    try:
        begun.unlink(missing_ok=True)
        flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW | os.O_CLOEXEC
        with os.fdopen(os.open(begun, flags, 0o600), "wb") as file:
            os.fchmod(file.fileno(), stat.S_IMODE(path.stat().st_mode))
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        begun.replace(path)
    except OSError as error:
        with suppress(OSError):
            begun.unlink(missing_ok=True)
        raise TangyError(
            plain(f"{path}: the name cannot be erased from it ({error.strerror}).")
        ) from None
