"""Defaults: the folder of shipped files, the activity, and the strategies that press people."""

from __future__ import annotations

from pathlib import Path

from tangy_profiles.reading import read_toml

SHIPPED = Path(__file__).parent
"""Without `importlib.resources`, whose import takes 2% of the start-up time."""


_TOP = read_toml(SHIPPED / "defaults.toml")

DEFAULT_ACTIVITY = _TOP.text("activity")
"""The default activity of the command line."""

PRESSING_STRATEGIES = _TOP.words("pressing_strategies")
"""The strategies that press people in an activity that does not list its own."""

QUESTIONS_ACTIVITY = _TOP.text("questions")
"""The activity that is the template for imported questions."""

NEW_ACTIVITIES = {
    kind: _TOP.text(f"new_{kind}") for kind in ("quiz", "songs", "exercises", "memory", "cards")
}
"""The activities from which new ones of each kind are made."""

ASK_AGAIN = _TOP.words("ask_again")
"""The texts that repeat a question after an unclear answer."""

_TOP.close()

USUAL_ROBOT = "tangy"
"""The default robot of the command line."""

TO_BEGIN_WITH = 4
"""The number of people if a facility has not registered any."""

REGISTERED = -1
"""As a count of people: all registered people."""
