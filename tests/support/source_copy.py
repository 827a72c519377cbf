"""A copy of the sources that a test may change, and the program that runs on it."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

HOUSE = Path(__file__).parents[2]
FLOORS = ("tangy_tui", "sim", "hw", "profiles")


def copy_sources(to: Path) -> Path:
    """Copy the sources, their neighbours, and the contracts; return the folder."""
    shutil.copy(HOUSE / "pyproject.toml", to)
    left_out = shutil.ignore_patterns("__pycache__", "*.egg-info")
    for floor in FLOORS:
        shutil.copytree(HOUSE / floor, to / floor, ignore=left_out)
    return to


def run_on(
    copy: Path, *arguments: object, stdin: str | None = None
) -> subprocess.CompletedProcess[str]:
    """Run Python on a copy of the sources."""
    way = os.pathsep.join(str(copy / floor) for floor in ("", *FLOORS[1:]))
    return subprocess.run(  # noqa: S603 - our own Python
        [sys.executable, *map(str, arguments)],
        cwd=copy,
        env={**os.environ, "PYTHONPATH": way, "COLUMNS": "200", "XDG_DATA_HOME": str(copy)},
        capture_output=True,
        text=True,
        input=stdin,
    )


def tangy_on(copy: Path, *arguments: object) -> subprocess.CompletedProcess[str]:
    """Run the command line on a copy of the sources."""
    return run_on(copy, "-c", "from tangy_tui.cli import main; main()", *arguments)


def edit(path: Path, before: str, after: str) -> None:
    """Replace a text that occurs once."""
    text = path.read_text(encoding="utf-8")
    assert text.count(before) == 1, f"{path.name}: {before!r} stands {text.count(before)} times"
    path.write_text(text.replace(before, after), encoding="utf-8")
