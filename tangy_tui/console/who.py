"""Asks for the teacher's name in the console, once, and stores it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from tangy_profiles.errors import TangyError
from tangy_tui.app.teacher_profile import NOBODY, change_name, login_name, read_profile
from tangy_tui.text.who import TYPE_A_NAME, TYPE_NAME, WHO, WHO_DETAIL


def ask_who(
    folder: Path, read: Callable[[], str | None], write: Callable[[str], None]
) -> tuple[str, bool]:
    """Return the teacher's name, and whether it was given just now.

    Args:
        folder: the data folder.
        read: returns the next line, None at the end.
        write: writes a line.
    """
    profile, usual = read_profile(folder), login_name()
    if profile.name:
        return profile.name, False
    write(f"{WHO} {WHO_DETAIL}")
    while True:
        write(TYPE_A_NAME if usual == NOBODY else TYPE_NAME.format(usual))
        line = read()
        if line is None:
            return usual, False
        try:
            suggested = "" if usual == NOBODY else usual
            return change_name(folder, line.strip() or suggested), True
        except TangyError as error:
            write(str(error))
