"""Cache of forests' answers beside the log, so that a learnt policy loads without training.

To load scikit-learn and to grow a hundred trees takes seconds; to read what they said takes
milliseconds. A cache is never trusted: loading a policy compares the digest.
"""

from __future__ import annotations

import hashlib
import json
import logging
import os
import platform
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import asdict
from math import isclose
from pathlib import Path
from typing import Any

from tangy_profiles.state import Situation
from tangy_tui.learning.policy import Forest, ForestSettings, grown

FOLDER = "forests"
MOST = 64
"""Kept at most: the forests that were asked for last."""
LARGEST = 1_000_000
"""Bytes of a file that is read at most; one of Bingo's has 3,000."""

_log = logging.getLogger(__name__)


class ForestCache:
    """Grows forests, and caches their votes in a folder.

    A file is named after what was learnt from, the settings, and the versions of Python, numpy and
    scikit-learn: where any of them is another, so is the forest. A file that cannot be read, or
    holds something else, is passed over and written anew.
    """

    def __init__(self, folder: Path) -> None:
        """Use a folder inside a data folder; it need not exist yet."""
        self.folder = folder / FOLDER

    def grown(
        self,
        settings: ForestSettings,
        rows: tuple[tuple[Situation, str], ...],
        situations: tuple[Situation, ...],
    ) -> Forest:
        """Return what a forest answers, as it was kept or else by growing it (see `grown`)."""
        path = self.folder / f"{_key(settings, rows, situations)}.json"
        forest = _read(path, len(situations), {behaviour for _, behaviour in rows})
        if forest is None:
            forest = grown(settings, rows, situations)
            self._keep(path, forest)
        return forest

    def afresh(
        self,
        settings: ForestSettings,
        rows: tuple[tuple[Situation, str], ...],
        situations: tuple[Situation, ...],
    ) -> Forest:
        """Grow a forest, and replace its cached votes."""
        forest = grown(settings, rows, situations)
        self._keep(self.folder / f"{_key(settings, rows, situations)}.json", forest)
        return forest

    def _keep(self, path: Path, forest: Forest) -> None:
        """Write a file atomically; ignore a folder that cannot be written to."""
        part = path.with_suffix(f".{os.getpid()}.part")
        try:
            self.folder.mkdir(mode=0o700, exist_ok=True)
            part.write_text(json.dumps(forest._asdict()), encoding="utf-8")
            part.replace(path)
            files = sorted(self.folder.glob("*.json"), key=lambda file: file.stat().st_mtime)
            for old in files[:-MOST]:
                old.unlink(missing_ok=True)
        except OSError as error:
            _log.info("a forest was not kept: %s", error)
            with suppress(OSError):
                part.unlink(missing_ok=True)


def _key(
    settings: ForestSettings,
    rows: Sequence[tuple[Situation, str]],
    situations: Sequence[Situation],
) -> str:
    meant = [
        asdict(settings),
        _versions(),
        [[*s, b] for s, b in rows],
        [list(s) for s in situations],
    ]
    return hashlib.sha256(json.dumps(meant, sort_keys=True).encode()).hexdigest()[:40]


def _versions() -> list[str]:
    """Return the versions that a forest depends on, without loading the libraries."""
    from importlib.metadata import PackageNotFoundError, version  # brings the e-mail package along

    found = [platform.python_version()]
    for library in ("numpy", "scikit-learn"):
        try:
            found.append(version(library))
        except PackageNotFoundError:  # it is imported from somewhere else
            found.append("?")
    return found


def _read(path: Path, situations: int, behaviours: set[str]) -> Forest | None:
    """Read a file; None if there is none, or it does not hold votes for such situations."""
    try:
        if path.stat().st_size > LARGEST:
            return None
        told: Any = json.loads(path.read_text(encoding="utf-8"))
        votes = tuple(
            tuple((str(behaviour), float(share)) for behaviour, share in one)
            for one in told["votes"]
        )
        versions = tuple((str(part), str(number)) for part, number in told["versions"])
    except (OSError, ValueError, TypeError, KeyError, RecursionError):
        return None
    whole = len(votes) == situations and all(votes)
    whole = whole and all(isclose(sum(share for _, share in one), 1, abs_tol=1e-6) for one in votes)
    whole = whole and all(0 < share <= 1 for one in votes for _, share in one)
    known = {behaviour for one in votes for behaviour, _ in one} <= behaviours
    return Forest(votes, versions) if whole and known else None
