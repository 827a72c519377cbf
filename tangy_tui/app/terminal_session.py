"""Where the terminal is: on another machine, behind a multiplexer, or neither.

A reply of the terminal proves that earlier output has reached it. Over SSH that is the person's
own terminal; but tmux, GNU screen and mosh reply on the terminal's behalf, on the machine where
they run, and prove nothing about what the person has seen.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, get_args

QuestionKey = Literal["auto", "y", "digit"]
"""How a question takes a yes: by y, by a digit, or as the session requires."""

QUESTION_KEYS: tuple[QuestionKey, ...] = get_args(QuestionKey)

DIGITS = "456789"
"""The digits for a yes; 1 to 3 choose another behaviour."""

REMOTE_SERVERS = frozenset(
    {
        "sshd",
        "sshd-session",
        "dropbear",
        "mosh-server",
        "telnetd",
        "in.telnetd",
        "tailscaled",
        "ttyd",
        "gotty",
        "cockpit-bridge",
    }
)
"""Programs by which a person logs in from another machine."""

MULTIPLEXERS = frozenset({"tmux", "screen", "zellij", "dtach", "abduco", "mosh-server"})
"""Programs that reply on behalf of the person's terminal."""

_REMOTE_SIGNS = ("SSH_CONNECTION", "SSH_TTY", "SSH_CLIENT")
_MULTIPLEXER_SIGNS = ("TMUX", "STY", "ZELLIJ")

_PROC = Path("/proc")
_DEVICE = re.compile(r"(?:84|83);|1;10;0\Z")
"""The secondary device attributes with which tmux, screen and mosh identify themselves."""


@dataclass(frozen=True, slots=True)
class TerminalSession:
    """Where the keys come from. `multiplexer`: a program replies on the terminal's behalf."""

    remote: bool = False
    multiplexer: bool = False


def terminal_session(
    environ: Mapping[str, str] | None = None, *, pid: int | None = None, proc: Path = _PROC
) -> TerminalSession:
    """Inspect the environment and the ancestors of this process.

    A multiplexer outlives its client and may be attached from elsewhere: its session counts as
    remote if one of the clients is remote, or if one of them cannot be inspected.

    Args:
        environ: the environment (default: the process's own).
        pid: the process (default: this one).
        proc: the folder that lists processes; if it does not exist, only the environment counts.
    """
    environ = os.environ if environ is None else environ
    above = set(_names_above(os.getpid() if pid is None else pid, proc))
    term = environ.get("TERM", "")
    multiplexer = (
        bool(above & MULTIPLEXERS)
        or any(environ.get(sign) for sign in _MULTIPLEXER_SIGNS)
        or term.startswith(("tmux", "screen"))
    )
    remote = bool(above & REMOTE_SERVERS) or any(environ.get(sign) for sign in _REMOTE_SIGNS)
    return TerminalSession(remote or (multiplexer and _has_remote_client(proc)), multiplexer)


def answers_for_another(attributes: str) -> bool:
    """Return whether secondary device attributes ("84;0;0") are those of a multiplexer."""
    return _DEVICE.match(attributes) is not None


def _has_remote_client(proc: Path) -> bool:
    """Return whether a client of a multiplexer on this machine is remote."""
    return any(
        name.removesuffix(": client") in MULTIPLEXERS
        and any(above in REMOTE_SERVERS for above in _names_above(pid, proc))
        for pid, name in _processes(proc)
    )


def _processes(proc: Path) -> Iterator[tuple[int, str]]:
    for folder in proc.iterdir() if proc.is_dir() else ():
        if folder.name.isdigit() and (found := _status(int(folder.name), proc)):
            yield int(folder.name), found[0]


def _names_above(pid: int, proc: Path) -> Iterator[str]:
    """Yield the names of the ancestors of a process, the nearest first."""
    seen = {pid}
    found = _status(pid, proc)
    while found is not None and (parent := found[1]) > 0 and parent not in seen:
        seen.add(parent)
        found = _status(parent, proc)
        if found is not None:
            yield found[0].split(":")[0].lower()


def _status(pid: int, proc: Path) -> tuple[str, int] | None:
    """Return the name of a process and the id of its parent; None if they cannot be read."""
    try:
        line = (proc / str(pid) / "stat").read_text(errors="replace")
        name, rest = line.split("(", 1)[1].rsplit(")", 1)
        return name, int(rest.split()[1])
    except (OSError, IndexError, ValueError):
        return None
