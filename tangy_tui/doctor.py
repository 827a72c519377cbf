"""What of this machine works, and what to do about what does not: each part in one sentence."""

from __future__ import annotations

import locale
import os
import shutil
import sys
from collections.abc import Callable
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

from tangy_profiles.errors import TangyError
from tangy_profiles.store import Store


@dataclass(frozen=True, slots=True)
class Finding:
    """One part of the machine, whether it works, and a sentence about it."""

    part: str
    ok: bool
    text: str


def examine(folder: Path, which: Callable[[str], str | None] = shutil.which) -> list[Finding]:
    """Look at everything Tangy may use.

    Args:
        folder: the data folder.
        which: finds a program on the path.
    """
    return [
        _terminal(),
        _store(folder),
        _speech(),
        _program(
            "voice", which("espeak-ng"), "Tangy can speak.",
            "espeak-ng is not installed; what Tangy says is shown as text.",
        ),
        _program(
            "microphone", which("arecord"), "a local microphone can be used (--mic arecord).",
            "arecord is not installed; commands are typed, or come from a WAV file.",
        ),
    ]  # fmt: skip


def _program(part: str, found: str | None, present: str, absent: str) -> Finding:
    return Finding(part, found is not None, present if found else absent)


def _terminal() -> Finding:
    term = os.environ.get("TERM", "")
    if not sys.stdout.isatty():
        return Finding("terminal", True, "output goes to a pipe or file: Tangy speaks in lines.")
    if term in ("", "dumb"):
        return Finding("terminal", True, f"TERM={term or 'unset'}: Tangy speaks in lines.")
    size = shutil.get_terminal_size()
    encoding = locale.getpreferredencoding(False)
    return Finding("terminal", True, f"{term}, {size.columns} x {size.lines}, {encoding}.")


def _store(folder: Path) -> Finding:
    try:
        with Store.open(folder, write=False) as store:
            problems = store.check()
    except TangyError as error:
        return Finding("data folder", False, str(error))
    if problems:
        return Finding("data folder", False, f"{folder}: {problems[0]}")
    return Finding("data folder", True, f"{folder} is sound.")


def _speech() -> Finding:
    if find_spec("pocketsphinx") is None:
        return Finding("speech", False, "pocketsphinx is not installed; commands are typed.")
    return Finding("speech", True, "Tangy can decode spoken commands.")
