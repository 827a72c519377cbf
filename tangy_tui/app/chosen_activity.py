"""The default activity of a data folder: `activity.toml`."""

from __future__ import annotations

from pathlib import Path

from tangy_profiles.activity import Activity, known_activities, load_activity
from tangy_profiles.defaults import DEFAULT_ACTIVITY
from tangy_profiles.errors import ProfileError
from tangy_tui.app.choice_file import keep_choice, read_choice

FILE = "activity.toml"


def chosen_activity(folder: Path) -> str:
    """Return the chosen activity: its name, or the path of its file.

    Raises:
        ProfileError: the file has a mistake.
    """
    return read_choice(folder / FILE, "activity") or DEFAULT_ACTIVITY


def choose_activity(folder: Path, activity: str) -> str:
    """Store the activity to teach and play from now on.

    Args:
        folder: the data folder.
        activity: its name, or the path of its file.

    Returns:
        The stored name or absolute path.

    Raises:
        TangyError: the activity does not exist or has mistakes, or it cannot be stored.
    """
    load_activity(activity)
    kept = str(Path(activity).resolve()) if activity.endswith(".toml") else activity
    keep_choice(folder / FILE, "activity", kept)
    return kept


def choosable(profile: str, activity: Activity) -> list[tuple[str, Activity]]:
    """Return the activities to choose from, each with its name or path.

    The present one, with its `profile`, comes first: it may be a file of the user's own.
    """
    found = [(profile, activity)]
    for name in sorted(known_activities()):
        if name == profile:
            continue
        try:
            found.append((name, load_activity(name)))
        except ProfileError:
            continue  # an activity of another package; `tangy doctor` tells its mistake
    return found
