"""A shipped activity with changes in its file."""

from __future__ import annotations

import shutil
from pathlib import Path

from tangy_profiles.activity import shipped_activities
from tangy_profiles.declared.activity import DeclaredActivity, read_declared


def changed_trivia(folder: Path, *changes: tuple[str, str]) -> DeclaredActivity:
    """Write the shipped quiz with changes into a folder, each from one text to another; read it."""
    shipped = shipped_activities()["trivia"]
    text = shipped.read_text(encoding="utf-8")
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    shutil.copy(shipped.with_suffix(".csv"), folder / "trivia.csv")
    path = folder / "mine.toml"
    path.write_text(text, encoding="utf-8")
    return read_declared(path)


AGAIN = 'again = ["What do you think, {name}: {a}, {b} or {c}?"]\n'
"""The shipped quiz's question to a person who did not answer."""


def patient_trivia(folder: Path) -> DeclaredActivity:
    """Return the shipped quiz without asking again."""
    return changed_trivia(folder, (AGAIN, ""))
