"""What lies in a data folder beside the log, and how a name is erased from it.

Reports, lists and logs of processes are text; copies of the log, and damaged ones, are overwritten
byte for byte. What is something else (sound, pictures, a PDF) is not changed.
"""

from __future__ import annotations

import os
import stat
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

from tangy_profiles.erasure import NameEraser
from tangy_profiles.errors import TangyError
from tangy_profiles.given_file import read_given
from tangy_profiles.log_file import FILE
from tangy_profiles.reading import plain

LARGEST = 64_000_000  # bytes of a file that is looked through
PAGES = (".html", ".htm", ".svg", ".xhtml", ".xml")
OURS = (FILE, f"{FILE}-wal", f"{FILE}-shm", "tangy.lock", "tangy.seal")
"""What the writer of the log sees to."""


class Erased(NamedTuple):
    """The files that were changed, and those that may still hold the name."""

    changed: tuple[Path, ...]
    left: tuple[Path, ...]


def erase_from_files(folder: Path, eraser: NameEraser) -> Erased:
    """Erase a name from every file of a data folder but the log itself.

    A file is replaced as a whole or not at all; a link is not followed to change anything.

    Raises:
        TangyError: a file that holds the name cannot be written.
    """
    changed, left = [], []
    for path in _files(folder):
        try:
            before = read_given(path, LARGEST)
        except TangyError:
            left.append(path)
            continue
        after = _without(path, before, eraser)
        holds = after != before or (_is_binary(before) and eraser.overwrite(before) != before)
        if after != before and not path.is_symlink():
            _replace(path, after)
            changed.append(path)
        elif holds or eraser.text(path.name) != path.name:
            left.append(path)
    return Erased(tuple(changed), tuple(left))


def _files(folder: Path) -> Iterator[Path]:
    for top, folders, names in os.walk(folder):
        folders.sort()
        for name in sorted(names):
            path = Path(top, name)
            with suppress(OSError):
                ours = Path(top) == folder and name in OURS
                if not ours and stat.S_ISREG(path.stat().st_mode):
                    yield path


def _without(path: Path, content: bytes, eraser: NameEraser) -> bytes:
    """Return the content of a file without the name."""
    if path.name.startswith(f"{FILE}."):  # a copy of the log, or a damaged one
        return eraser.overwrite(content)
    if _is_binary(content):
        return content
    text = content.decode()
    is_page = path.suffix.casefold() in PAGES
    return (eraser.page(text) if is_page else eraser.text(text)).encode()


def _is_binary(content: bytes) -> bool:
    try:
        return "\0" in content.decode()
    except UnicodeDecodeError:
        return True


def _replace(path: Path, content: bytes) -> None:
    """Write a file anew, as whole as it was, for those who could read it."""
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
