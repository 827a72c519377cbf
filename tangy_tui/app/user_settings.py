"""What a user has set: `settings.toml` in the data folder, if there is one."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import cast

from tangy_profiles.reading import read_toml
from tangy_tui.app.keymap import Keymap, read_keys
from tangy_tui.app.terminal_session import QUESTION_KEYS, QuestionKey

FILE = "settings.toml"


@dataclass(frozen=True, slots=True)
class UserSettings:
    """How the program is to behave.

    `question`: which key says yes to a question; `keymap`: which keys do what.
    """

    question: QuestionKey = "auto"
    keymap: Keymap = field(default_factory=Keymap)


def read_settings(folder: Path) -> UserSettings:
    """Read the settings of a data folder; what is not set is as usual.

    Raises:
        ProfileError: the file has a mistake.
    """
    path = folder / FILE
    if not path.exists():
        return UserSettings()
    table = read_toml(path)
    question = table.choice("question", QUESTION_KEYS, "auto")
    keymap = read_keys(table.table("keys", optional=True))
    table.close()
    return UserSettings(cast("QuestionKey", question), keymap)
