"""Busy processes beside a game on the bench: a machine that is short of time."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager

MOST = 64
BUSY = "import os\nparent = os.getppid()\nwhile os.getppid() == parent:\n    sum(range(100_000))\n"
"""Computes for as long as the program that started it is there."""


@contextmanager
def machine_load(processes: int) -> Iterator[None]:
    """Keep the machine busy with some processes; they end with it, or if this program dies."""
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
