"""Effects of behaviours on the world: a closed set from which activities choose.

Each world matches all of them, so mypy finds the places where a new one is missing.
"""

from __future__ import annotations

from typing import Literal, get_args

Effect = Literal[
    "none",  # something is said or shown
    "draw",  # the next number is called
    "clear wrong marks",  # the attended person is asked to take markers off
    "set missing marks",  # the attended person is asked to mark called numbers
    "bring card closer",  # the attended person is asked to move the card into view
    "go to user",
    "go to front",
    "finish",  # the activity is over
]
EFFECTS: tuple[Effect, ...] = get_args(Effect)

DRIVES: tuple[Effect, ...] = ("go to user", "go to front")
"""The effects that make the robot drive."""
CORRECTS: tuple[Effect, ...] = ("clear wrong marks", "set missing marks")
"""The effects by which the attended person corrects the card."""
ABOUT_CARD: tuple[Effect, ...] = ("bring card closer", *CORRECTS)
"""The effects by which the attended person does something with the card."""
