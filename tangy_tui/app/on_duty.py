"""Who is on duty: whose name live games log for what staff do. It is kept in the data folder."""

from __future__ import annotations

from pathlib import Path

from tangy_profiles.person import read_name
from tangy_tui.app.choice_file import keep_choice, read_choice
from tangy_tui.app.teacher_profile import login_name, read_profile

FILE = "on_duty.toml"
KEY = "name"
STAFF = "staff"
"""Stands for who is on duty if no name is known."""


def on_duty(folder: Path) -> str:
    """Return who was on duty last, before the first session the teacher.

    Raises:
        TangyError: the file has a mistake.
    """
    return chosen_duty(folder) or read_profile(folder).name or login_name(STAFF)


def chosen_duty(folder: Path) -> str:
    """Return who was chosen to be on duty last, "" if nobody was yet.

    Raises:
        TangyError: the file has a mistake.
    """
    return read_choice(folder / FILE, KEY)


def take_duty(folder: Path, name: str) -> str:
    """Keep who is on duty from now on, and return the name in its stored form.

    Raises:
        TangyError: it is no valid name, or it cannot be written.
    """
    name = read_name(name)
    keep_choice(folder / FILE, KEY, name)
    return name
