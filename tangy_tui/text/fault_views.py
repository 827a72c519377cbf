"""Headings and help of the views of faults."""

from __future__ import annotations

LIST_HELP = (
    "What went wrong in this game: when, after which step, whether it is critical (!!), "
    "what it is, and what was done about it. Enter opens one. / finds "
    "faults by name, code, state or person; esc shows all again."
)
NONE_FOUND = "No fault has these words."
NO_FAULTS = "No faults in this game."
ALSO_WRONG = "Also wrong"
DONE_WHEN = "What was done, and when"
HOW_KNOWN = "How Tangy knows"
WHAT_TO_DO = "What should I do?"

WAITS = "waits for the "
"""The words before the device whose late data the robot waits for."""

BEGINS = {
    "expert": "Tangy stands still until staff have cleared it",
    "user": "Tangy asks a user for help",
    "teacher": "Tangy asks a teacher",
    "continue": "Tangy goes on",
}
"""What Tangy is about to do, by the kind of recovery."""
