"""Effects of behaviours on the world: a closed set, from which an activity chooses.

Each world matches every one of them, so that mypy names the places where a new one is forgotten.
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
"""Those for which the robot drives."""
CORRECTS: tuple[Effect, ...] = ("clear wrong marks", "set missing marks")
"""Those for which the attended person corrects the card."""
ABOUT_CARD: tuple[Effect, ...] = ("bring card closer", *CORRECTS)
"""Those for which the attended person does something with the card."""
