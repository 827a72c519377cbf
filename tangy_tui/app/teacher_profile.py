"""The teacher's name and theme, stored in `teacher.toml` in the data folder."""

from __future__ import annotations

import json
import os
from dataclasses import asdict, dataclass, replace
from pathlib import Path

from tangy_profiles.errors import TangyError
from tangy_profiles.person import LONGEST_NAME, read_name
from tangy_profiles.reading import plain, read_toml

FILE = "teacher.toml"
NOBODY = "teacher"
"""The teacher's name if nobody can be asked, and there is no login name."""


@dataclass(frozen=True, slots=True)
class TeacherProfile:
    """The stored teacher.

    `name` is "" if they were not asked; `theme` names the colours that they chose ("": none yet).
    """

    name: str = ""
    theme: str = ""


def read_profile(folder: Path) -> TeacherProfile:
    """Read the teacher's profile; an empty one if there is none.

    Raises:
        TangyError: the file has a mistake.
    """
    path = folder / FILE
    if not path.exists():
        return TeacherProfile()
    table = read_toml(path)
    name = table.text("name", "")
    theme = table.text("theme", "")
    table.close()
    return TeacherProfile(checked(name) if name else "", theme)


def save_profile(folder: Path, profile: TeacherProfile) -> None:
    """Store the teacher's profile.

    Raises:
        TangyError: the file cannot be written.
    """
    lines = (
        f"{key} = {json.dumps(value, ensure_ascii=False)}\n"
        for key, value in asdict(profile).items()
        if value
    )
    new = folder / f"{FILE}.new"
    try:
        new.write_text("".join(lines), encoding="utf-8")
        new.replace(folder / FILE)
    except OSError as error:
        raise TangyError(plain(f"{folder / FILE}: cannot be written: {error.strerror}.")) from None


def change_name(folder: Path, name: str) -> str:
    """Store a new name of the teacher, and return it.

    Raises:
        TangyError: it is no valid name, or it cannot be written.
    """
    name = checked(name)
    save_profile(folder, replace(read_profile(folder), name=name))
    return name


def change_theme(folder: Path, theme: str) -> None:
    """Store the theme that the teacher chose.

    Raises:
        TangyError: the file has a mistake, or cannot be written.
    """
    save_profile(folder, replace(read_profile(folder), theme=theme))


def checked(name: str) -> str:
    """Return a teacher's name in its stored form.

    Raises:
        TangyError: it is no valid name.
    """
    return read_name(name, "A teacher's name")


def login_name(nobody: str = NOBODY) -> str:
    """Return the login name, or a placeholder if there is none."""
    login = os.environ.get("USER") or os.environ.get("USERNAME") or ""
    return plain(login).strip()[:LONGEST_NAME].strip() or nobody


def teacher_name(given: str | None, folder: Path) -> str:
    """Return the teacher's name: the given one, the stored one, or the login name.

    Raises:
        TangyError: the given name is not valid (see `read_name`).
    """
    return checked(given) if given is not None else read_profile(folder).name or login_name()
