"""Bench games that somebody should read: with a missed fault, a false alarm, or an early end."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from shutil import copytree, rmtree
from typing import Any

from tangy_tui.experiments.matching import NOTHING, WRONG
from tangy_tui.text.comparison import TO_ITS_END

FAULTS = "faults.json"
"""What was induced in the games, and what Tangy diagnosed."""


def to_read(game: Mapping[str, Any]) -> bool:
    """Return whether a game has a missed fault, a wrong cause, a false alarm, or an early end."""
    return (
        any(one["missed"] for one in game["induced"])
        or any(fault["verdict"] in (WRONG, NOTHING) for fault in game["faults"])
        or game["ended"] != TO_ITS_END
    )


def keep_games(data: Path, to: Path, games: Sequence[Mapping[str, Any]]) -> None:
    """Copy the data folder in which games were played, once it is closed, and add their faults.

    The copy has the log, which `tangy log` reads, and those of the robot process and the bench. It
    has no sockets.
    """
    rmtree(to, ignore_errors=True)
    copytree(data, to, ignore=_no_files)
    (to / FAULTS).write_text(json.dumps(list(games), indent=2, ensure_ascii=False) + "\n")


def _no_files(folder: str, names: list[str]) -> list[str]:
    """Return the names in a folder that are neither files nor folders."""
    paths = {name: Path(folder, name) for name in names}
    return [name for name, path in paths.items() if not (path.is_file() or path.is_dir())]
