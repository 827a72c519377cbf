"""Cache of forests' votes beside the log, so that a stored policy loads without training.

Loading scikit-learn and growing a hundred trees takes seconds; reading cached votes takes
milliseconds. The cache is never trusted: loading a policy compares the digest.
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
"""The number of forests to keep, the newest ones."""
LARGEST = 1_000_000
"""The largest file to read (bytes); a forest of Bingo has 3,000."""

_log = logging.getLogger(__name__)


class ForestCache:
    """Grows forests, and caches their votes in a folder.

    The file name is a hash of the training rows, the settings, and the versions of Python, numpy
    and scikit-learn: any change gives another file. A file that is unreadable or invalid is
    replaced.
    """

    def __init__(self, folder: Path) -> None:
        """Use a subfolder of a data folder; it need not exist yet."""
        self.folder = folder / FOLDER

    def grown(
        self,
        settings: ForestSettings,
        rows: tuple[tuple[Situation, str], ...],
        situations: tuple[Situation, ...],
    ) -> Forest:
        """Return a forest's votes from the cache, or grow it (see `grown`)."""
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
        """Write a file atomically, and delete the oldest files; ignore write errors."""
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
    """Return the versions that a forest depends on, without importing the libraries."""
    from importlib.metadata import PackageNotFoundError, version  # imports the email package

    found = [platform.python_version()]
    for library in ("numpy", "scikit-learn"):
        try:
            found.append(version(library))
        except PackageNotFoundError:  # not installed as a package
            found.append("?")
    return found


def _read(path: Path, situations: int, behaviours: set[str]) -> Forest | None:
    """Read a file; return None if it is missing or has no valid votes for these situations."""
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
