"""A choice stored in the data folder, as a TOML file with one key."""

from __future__ import annotations

import json
from pathlib import Path

from tangy_profiles.errors import TangyError
from tangy_profiles.reading import plain, read_toml


def read_choice(path: Path, key: str) -> str:
    """Return the choice stored in a file, "" if the file does not exist.

    Raises:
        ProfileError: the file has a mistake.
    """
    if not path.exists():
        return ""
    table = read_toml(path)
    choice = table.text(key)
    table.close()
    return choice


def keep_choice(path: Path, key: str, choice: str) -> None:
    """Write a choice to its file atomically.

    Raises:
        TangyError: the file cannot be written.
    """
    if not choice.isprintable():  # it could not be read again
        raise TangyError(plain(f"{path}: {choice!r} cannot be stored."))
    new = path.with_name(f"{path.name}.new")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        new.write_text(f"{key} = {json.dumps(choice, ensure_ascii=False)}\n", encoding="utf-8")
        new.replace(path)
    except OSError as error:
        raise TangyError(plain(f"{path}: cannot be written: {error.strerror}.")) from None
