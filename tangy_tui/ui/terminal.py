"""The capabilities of the terminal, determined once before Textual is imported."""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TextIO

from tangy_tui.text.program import too_small_words

MIN_WIDTH = 60
MIN_HEIGHT = 18

SERVED = "TEXTUAL_DRIVER"
"""The environment variable that is set if a server shows the application in a browser."""

FEW_COLOURS = ("linux", "xterm", "screen", "ansi", "vt", "cons", "rxvt")
"""Terminals to which Rich writes 16 colours, unless their name or COLORTERM promises more."""


@dataclass(frozen=True, slots=True)
class TerminalKind:
    """How to show the application.

    `full_screen` is False if only plain lines make sense; `reason` tells why. `ansi` asks for the
    terminal's own 16 colours, `ascii` for characters 32 to 126 only.
    """

    full_screen: bool = True
    ansi: bool = False
    ascii: bool = False
    reason: str = ""


def terminal_kind(
    environ: Mapping[str, str] | None = None,
    *,
    stdin: TextIO | None = None,
    stdout: TextIO | None = None,
    stderr: TextIO | None = None,
    ascii: bool | None = None,
) -> TerminalKind:
    """Determine how to show the application on this terminal.

    Args:
        environ: the environment (default: the process's own).
        stdin: the stream of keys.
        stdout: the stream for plain lines.
        stderr: the stream of the screen (default: the process's own, with its stdin and stdout).
        ascii: whether `--ascii` was given; None decides by TERM and locale.
    """
    environ = os.environ if environ is None else environ
    if environ.get(SERVED):
        return TerminalKind(ascii=bool(ascii))
    term = environ.get("TERM", "")
    plain_text = ascii if ascii is not None else term == "linux" or not _speaks_utf8(environ)
    ansi = bool(environ.get("NO_COLOR")) or _few_colours(environ)
    drawn = stderr or (sys.__stderr__ if stdin is None and stdout is None else None)
    reason = ""
    if not all(_is_tty(s) for s in (stdin or sys.__stdin__, stdout or sys.__stdout__)):
        reason = "input or output is not a terminal"
    elif drawn is not None and not _is_tty(drawn):
        reason = "the screen is drawn where errors go, and they go elsewhere (2>)"
    elif term in ("dumb", "unknown"):
        reason = f"the terminal (TERM={term}) cannot place a cursor"
    return TerminalKind(not reason, ansi, plain_text, reason)


def too_small(width: int, height: int) -> str | None:
    """Return the sentence for a window that is too small, otherwise None."""
    if width >= MIN_WIDTH and height >= MIN_HEIGHT:
        return None
    return too_small_words(width, height, (MIN_WIDTH, MIN_HEIGHT))


def _is_tty(stream: TextIO | None) -> bool:
    try:
        return stream is not None and stream.isatty()
    except ValueError:  # closed
        return False


def _speaks_utf8(environ: Mapping[str, str]) -> bool:
    """Check the locale like the C library: LC_ALL, then LC_CTYPE, then LANG."""
    for key in ("LC_ALL", "LC_CTYPE", "LANG"):
        if environ.get(key):
            name = environ[key].lower().replace("-", "")
            return "utf8" in name
    return False


def _few_colours(environ: Mapping[str, str]) -> bool:
    term = environ.get("TERM", "")
    if environ.get("COLORTERM", "").lower() in ("truecolor", "24bit"):
        return term == "linux"
    if any(more in term for more in ("256color", "direct", "kitty", "truecolor")):
        return False
    return term.startswith(FEW_COLOURS)
