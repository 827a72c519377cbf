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

# The questions that the program asks about effects. `Behaviour` answers each of them.

CALLS: tuple[Effect, ...] = ("draw",)
"""The effects by which the next number is called."""
VISITS: tuple[Effect, ...] = ("go to user",)
"""The effects by which the robot goes to a person."""
RETURNS: tuple[Effect, ...] = ("go to front",)
"""The effects by which the robot goes back to its place before the group."""
DRIVES: tuple[Effect, ...] = (*VISITS, *RETURNS)
"""The effects that make the robot drive."""
CLEARS_MARKS: tuple[Effect, ...] = ("clear wrong marks",)
"""The effects by which the attended person takes markers off the card."""
SETS_MARKS: tuple[Effect, ...] = ("set missing marks",)
"""The effects by which the attended person marks numbers on the card."""
CORRECTS: tuple[Effect, ...] = (*CLEARS_MARKS, *SETS_MARKS)
"""The effects by which the attended person corrects the card."""
SHOWS_CARD: tuple[Effect, ...] = ("bring card closer",)
"""The effects by which the attended person moves the card into view."""
ABOUT_CARD: tuple[Effect, ...] = (*SHOWS_CARD, *CORRECTS)
"""The effects by which the attended person does something with the card."""
ENDS: tuple[Effect, ...] = ("finish",)
"""The effects that end the game."""
ONLY_TALKS: tuple[Effect, ...] = ("none",)
"""The effects by which nothing changes but what was said and shown."""
