"""What a user has set: `settings.toml` in the data folder, if there is one."""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal, cast, get_args

from tangy_profiles.reading import read_toml
from tangy_tui.app.keymap import Keymap, read_keys
from tangy_tui.app.terminal_session import QUESTION_KEYS, QuestionKey

FILE = "settings.toml"

LinkSpeed = Literal["auto", "slow", "fast"]
"""How fast the way to the terminal is; where nothing is set, its answers tell."""

LINK_SPEEDS: tuple[LinkSpeed, ...] = get_args(LinkSpeed)
LINK_VARIABLE = "TANGY_LINK"
"""What `--link` sets for the program, whatever the settings say."""


@dataclass(frozen=True, slots=True)
class UserSettings:
    """How the program is to behave.

    `question`: which key says yes to a question; `keymap`: which keys do what; `link`: how fast
    the way to the terminal is.
    """

    question: QuestionKey = "auto"
    keymap: Keymap = field(default_factory=Keymap)
    link: LinkSpeed = "auto"


def read_settings(folder: Path) -> UserSettings:
    """Read the settings of a data folder; missing ones have their defaults.

    Raises:
        ProfileError: the file has a mistake.
    """
    path = folder / FILE
    wanted = os.environ.get(LINK_VARIABLE, "")
    if not path.exists():
        return UserSettings(link=_speed(wanted, "auto"))
    table = read_toml(path)
    question = table.choice("question", QUESTION_KEYS, "auto")
    keymap = read_keys(table.table("keys", optional=True))
    link = _speed(wanted, table.choice("link", LINK_SPEEDS, "auto"))
    table.close()
    return UserSettings(cast("QuestionKey", question), keymap, link)


def _speed(wanted: str, otherwise: str) -> LinkSpeed:
    """Return the speed that is wanted, if there is such a speed."""
    return cast("LinkSpeed", wanted if wanted in LINK_SPEEDS else otherwise)
