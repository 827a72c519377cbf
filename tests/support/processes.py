"""All processes that a program has started, even after its own end."""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from uuid import uuid4

LOOK_SECONDS = 0.01


class Family:
    """A program and its descendants, known by a mark in their environment."""

    def __init__(self) -> None:
        self._mark = f"TANGY_TEST_FAMILY={uuid4().hex}"
        self.seen: dict[int, str] = {}
        """The command of each process ever seen, by its id."""

    @property
    def environment(self) -> dict[str, str]:
        """The environment for starting a program."""
        name, _, value = self._mark.partition("=")
        return {name: value}

    def there(self) -> dict[int, str]:
        """Return the command of each running process, by its id."""
        found: dict[int, str] = {}
        for folder in Path("/proc").iterdir():
            if folder.name.isdigit():
                with suppress(OSError):  # it has just ended, or belongs to another user
                    if self._mark.encode() in (folder / "environ").read_bytes():
                        command = (folder / "cmdline").read_bytes()
                        found[int(folder.name)] = command.replace(b"\0", b" ").decode().strip()
        self.seen |= found
        return {pid: command for pid, command in found.items() if runs(pid)}

    def seconds_until(
        self, holds: Callable[[dict[int, str]], bool], most: float, meanwhile: Callable[[], object]
    ) -> float:
        """Wait until a condition holds for the running processes; return how long that took, in s.

        Args:
            holds: the condition.
            most: s until it gives up.
            meanwhile: called between two checks.
        """
        began = time.monotonic()
        while not holds(self.there()):
            if time.monotonic() - began > most:
                raise AssertionError(f"after {most:g} s there run: {self.there()}")
            meanwhile()
            time.sleep(LOOK_SECONDS)
        return time.monotonic() - began


def runs(pid: int) -> bool:
    """Return whether a process runs; a process that has ended may remain as a zombie."""
    try:
        os.kill(pid, 0)
        stat = Path(f"/proc/{pid}/stat").read_text()
    except OSError:
        return False
    return stat.rpartition(")")[2].split()[0] != "Z"
