"""Provenance of results: a digest of the code, and the versions of the packages."""

from __future__ import annotations

import hashlib
import json
import platform
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from importlib.resources import files
from pathlib import Path
from typing import Any

ROOMS = (
    ("tangy_profiles", ""),
    ("tangy_sim", ""),
    ("tangy_tui", "learning"),
    ("tangy_tui", "interaction"),
    ("tangy_tui", "monitoring"),
    ("tangy_tui", "experiments"),
)
"""The packages and folders whose changes may change a result."""

ONLY_SHOWN = (
    "report.py",
    "recovery_report.py",
    "figures.py",
    "comparison.py",
    "published.py",
)
"""Files in these folders that only present results."""

PACKAGES = ("tangy", "numpy", "scikit-learn", "joblib", "matplotlib", "distributed")


def digest_of(document: Any) -> str:
    """Return the SHA-256 of a JSON document."""
    canonical = json.dumps(document, sort_keys=True, separators=(",", ":"), ensure_ascii=False)
    return hashlib.sha256(canonical.encode()).hexdigest()


@cache
def code_digest() -> str:
    """Return the SHA-256 of the code and data files behind the results.

    So results that older code left in a data folder are never reused.
    """
    digest = hashlib.sha256()
    for package, room in ROOMS:
        root = Path(str(files(package))) / room
        for path in sorted((*root.rglob("*.py"), *root.rglob("*.toml"))):
            if path.name in ONLY_SHOWN:
                continue
            digest.update(f"{package}/{room}/{path.relative_to(root).as_posix()}".encode())
            digest.update(path.read_bytes())
    digest.update(json.dumps([versions()[name] for name in ("numpy", "scikit-learn")]).encode())
    return digest.hexdigest()


def versions() -> dict[str, str]:
    """Return the versions of Python and of the packages behind the results."""
    found = {"python": platform.python_version()}
    for name in PACKAGES:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            found[name] = "not installed"
    return found
