"""Which activity is taught and played at a data folder where none is named: `activity.toml`."""

from __future__ import annotations

from pathlib import Path

from tangy_profiles.activity import Activity, known_activities, load_activity
from tangy_profiles.defaults import DEFAULT_ACTIVITY
from tangy_profiles.errors import ProfileError
from tangy_tui.app.choice_file import keep_choice, read_choice

FILE = "activity.toml"


def chosen_activity(folder: Path) -> str:
    """Return the activity that was chosen: its name, or the path of its file.

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
        What is kept: a path is a whole one.

    Raises:
        TangyError: there is no such activity, it has mistakes, or that cannot be written.
    """
    load_activity(activity)
    kept = str(Path(activity).resolve()) if activity.endswith(".toml") else activity
    keep_choice(folder / FILE, "activity", kept)
    return kept


def choosable(profile: str, activity: Activity) -> list[tuple[str, Activity]]:
    """Return the activities that can be chosen, by the words that choose them.

    The present one, with its `profile`, is the first: it may be a file of one's own.
    """
    found = [(profile, activity)]
    for name in sorted(known_activities()):
        if name == profile:
            continue
        try:
            found.append((name, load_activity(name)))
        except ProfileError:
            continue  # of what other packages bring; `tangy doctor` says what is wrong with it
    return found
