"""CPU load beside a game on the bench, to test a machine that is short of time."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager

BUSY = "import os\nparent = os.getppid()\nwhile os.getppid() == parent:\n    sum(range(100_000))\n"
"""Runs until its parent process ends."""


@contextmanager
def machine_load(processes: int) -> Iterator[None]:
    """Keep some processes busy inside the context; they also end if this program dies."""
    busy = [
        subprocess.Popen((sys.executable, "-P", "-c", BUSY), stdin=subprocess.DEVNULL)  # noqa: S603 - own
        for _ in range(processes)
    ]
    try:
        yield
    finally:
        for one in busy:
            one.kill()
        for one in busy:
            one.wait()
