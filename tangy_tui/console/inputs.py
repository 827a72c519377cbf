"""Where lines and keys come from: a script, standard input, or the terminal behind it."""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Callable, Iterable
from pathlib import Path

from tangy_profiles.errors import TangyError
from tangy_profiles.reading import plain

LARGEST_SCRIPT = 4_000_000  # bytes: a hundred thousand lines

WAIT = re.compile(
    r"wait (?:(\d{1,3}(?:\.\d{1,2})?)(?: ?s)?|until (asked|halted|called|over|paused))"
)
"""A line of a script that lets time pass, in s, or waits until something has come about."""


def any_waits(lines: Iterable[str]) -> bool:
    """Say whether one of some lines lets a script wait."""
    return any(WAIT.fullmatch(line.casefold()) for line in lines)


def line_reader(script: Path | None) -> Callable[[], str | None]:
    """Return where lines come from: the script, or standard input."""
    if script is None:
        lines_in = sys.stdin  # None where it was closed
        return lambda: lines_in.readline() or None if lines_in is not None else None
    try:
        with script.open("rb") as file:  # which may be a pipe: `--script <(...)`, /dev/stdin
            content = file.read(LARGEST_SCRIPT + 1)
        if len(content) > LARGEST_SCRIPT:
            raise TangyError(plain(f"{script}: is larger than {LARGEST_SCRIPT:,} bytes."))
        lines = iter(content.decode().splitlines())
    except FileNotFoundError:
        raise TangyError(plain(f"{script}: there is no such file.")) from None
    except (OSError, UnicodeDecodeError):
        raise TangyError(plain(f"{script}: cannot be read as text.")) from None
    return lambda: next(lines, None)


def is_typed(script: Path | None) -> bool:
    """Say whether lines are typed by a person now."""
    return script is None and sys.stdin is not None and sys.stdin.isatty()


def keys_from_terminal(script: Path | None) -> int:
    """Move the sound on standard input elsewhere, and read keys from the terminal instead.

    Returns:
        The file descriptor that now has the sound.
    """
    sound = os.dup(0)
    try:
        keys = os.open("/dev/null" if script is not None else "/dev/tty", os.O_RDWR)
    except OSError:
        raise TangyError(
            "--mic -: the sound comes on standard input, so the answers need a terminal or "
            "--script FILE."
        ) from None
    os.dup2(keys, 0)
    os.close(keys)
    return sound
