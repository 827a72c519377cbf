"""Both scenarios, run once by the command line on a few seeds: the documents and the pages."""

from __future__ import annotations

import fcntl
import json
import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

TANGY = [sys.executable, "-c", "from tangy_tui.cli import main; main()"]
SMALL = {
    1: ("--seeds", "1", "--users", "2", "--no-typing"),
    2: ("--people", "6", "--seed", "5"),
}


@dataclass(frozen=True)
class Ran:
    """The results of one scenario: its document, its page, and its folder."""

    document: dict[str, Any]
    page: str
    folder: Path
    words: tuple[str, ...]


def run(*words: str) -> subprocess.CompletedProcess[str]:
    """Run the program to its end, without a terminal."""
    return subprocess.run(  # noqa: S603 - our own interpreter
        [*TANGY, *words], capture_output=True, text=True, timeout=120, check=False
    )


@pytest.fixture(scope="session", params=[1, 2])
def ran(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Ran:
    """Each scenario in turn."""
    shared = tmp_path_factory.getbasetemp()
    if "PYTEST_XDIST_WORKER" in os.environ:
        shared = shared.parent  # shared by all workers of this session: the first one runs it
    folder = shared / f"scenario-{request.param}"
    folder.mkdir(exist_ok=True)
    words = ("experiment", str(request.param), *SMALL[request.param], "--jobs", "1")
    words += ("--data", str(folder / "data"))
    kept = folder / "document.json"
    with (folder / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not kept.exists():
            done = run(*words, "--json", "--report", str(folder / "report.html"))
            assert (done.returncode, done.stderr) == (0, "")
            kept.write_text(done.stdout, encoding="utf-8")
    page = (folder / "report.html").read_text(encoding="utf-8")
    return Ran(json.loads(kept.read_text(encoding="utf-8")), page, folder, words)
