"""Defaults: the activity, and the strategies that press people."""

from __future__ import annotations

from tangy_profiles.reading import read_toml
from tangy_profiles.shipped import SHIPPED

_TOP = read_toml(SHIPPED / "defaults.toml")

DEFAULT_ACTIVITY = _TOP.text("activity")
"""The name of the activity that the command line means where none is named."""

PRESSING_STRATEGIES = _TOP.words("pressing_strategies")
"""The strategies that press people in an activity that does not name its own."""

QUESTIONS_ACTIVITY = _TOP.text("questions")
"""The name of the activity whose file is written anew for questions that are imported."""

ASK_AGAIN = _TOP.words("ask_again")
"""The texts with which a person is asked again whose answer was not clear."""

_TOP.close()

USUAL_ROBOT = "tangy"
"""The robot that the command line means where none is named."""

TO_BEGIN_WITH = 4
"""People of a house that has not said who takes part."""

REGISTERED = -1
"""As a count of people: as many as are registered, those of before and those who were added."""
