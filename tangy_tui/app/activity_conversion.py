"""Brings the file of an activity with cards up to date, and leaves its games as they were.

Files of version 0.6.0 and before open as they are. They lack keys that came later, for which
defaults count. A conversion writes these defaults out, for the author to change.
"""

from __future__ import annotations

import json
import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from tangy_profiles.activity import read_activity
from tangy_profiles.activity_parts import GAME, VISIT
from tangy_profiles.declared.vocabulary import declares
from tangy_profiles.errors import ProfileError
from tangy_profiles.given_file import lines_of, read_given
from tangy_profiles.reading import LARGEST_PROFILE
from tangy_profiles.toml_lines import line_of

PRESSING = "pressing_strategies"
BEFORE = "plain_strategy"
"""The key that new keys follow: every such file has it, above its first table."""
OPTIONAL = ("summary", "patterns", "strengths", "rules", "now", "wordings")
"""Keys without a default: they need words of the author, or choices."""


class Conversion(NamedTuple):
    """A converted file: its text, the keys that it has now, and those that an author can add."""

    text: str
    added: tuple[str, ...]
    lacks: tuple[str, ...]


def converted(file: Path, comments: Mapping[str, str]) -> Conversion:
    """Return the text of an activity's file with all keys that have a default.

    Args:
        file: the activity's file.
        comments: a comment for each new key.

    Raises:
        ProfileError: the file has a mistake, which it names with its line.
    """
    activity = read_activity(file)
    text = lines_of(read_given(file, LARGEST_PROFILE, ProfileError))
    top = tomllib.loads(text)
    if declares(top):
        return Conversion(text, (), ())
    values = {
        PRESSING: json.dumps(activity.pressing, ensure_ascii=False),
        VISIT: str(activity.asking.visit),
        GAME: str(activity.asking.game),
    }
    new = [key for key in values if key not in top]
    written = [f"{key} = {values[key]}  # {comments[key]}" for key in new]
    lines = text.split("\n")
    place = line_of(text, (BEFORE,)) or 0
    lines[place:place] = written
    if not _holds("\n".join(lines), new):  # the key before them takes several lines
        lines = [*written, *text.split("\n")]
    lacks = tuple(key for key in OPTIONAL if _lacks(top, key))
    return Conversion("\n".join(lines), tuple(new), lacks)


def _holds(text: str, keys: Sequence[str]) -> bool:
    """Return whether a text is TOML with these keys at its top."""
    try:
        return tomllib.loads(text).keys() >= set(keys)
    except tomllib.TOMLDecodeError:
        return False


def _lacks(top: Mapping[str, Any], key: str) -> bool:
    """Return whether a key is nowhere in a file, neither at its top nor in a list of tables."""
    return key not in top and not any(
        key in one for lists in ("stages", "user_states", "behaviours") for one in top[lists]
    )
