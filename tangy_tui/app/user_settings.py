"""The user's settings: `settings.toml` in the data folder, if there is one."""

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
"""The speed of the connection to the terminal; `auto` measures the terminal's replies."""

LINK_SPEEDS: tuple[LinkSpeed, ...] = get_args(LinkSpeed)
LINK_VARIABLE = "TANGY_LINK"
"""Set by `--link`; overrides the settings."""


@dataclass(frozen=True, slots=True)
class UserSettings:
    """The settings of the user interface.

    `question`: the key for a yes to a question; `keymap`: the keys of the actions; `link`: the
    speed of the connection to the terminal.
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
    """Return the wanted speed if it is valid, otherwise the other one."""
    return cast("LinkSpeed", wanted if wanted in LINK_SPEEDS else otherwise)
