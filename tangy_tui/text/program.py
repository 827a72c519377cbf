"""Words for the application: home, colours, the window, and slow work."""

from __future__ import annotations

from pathlib import Path

TAGLINE = "Teach a robot a group activity, and let it run that activity."


def no_command_here(typed: str) -> str:
    """Tell that words typed on the home screen began nothing, and where they belong."""
    return (
        f"“{typed}” began nothing: here a letter goes to a line, and Enter chooses it. To tell "
        "Tangy what to do, choose Teach first (t, Enter)."
    )


NOTHING_MOVES = "Nothing is moving."
MOUSE_ON = "Mouse on. Press {mouse} to turn it off and select text."
MOUSE_OFF = "Mouse off: you can select text. Press {mouse} to turn it on again."
THEMES = {
    "Colours: dark theme": "Light colours on black",
    "Colours: light theme": "Dark colours on white",
    "Colours: theme of the terminal": "Its own sixteen colours",
}
"""The names and descriptions of the themes."""
COMPARE_POLICIES = ("Compare policies", "Teacher against teacher, before against after")
NOT_POSSIBLE, NOT_YET = "Not possible", "Not yet"
"""Titles of dialogs that tell why something cannot be done."""

LEARNING = "Tangy is learning ..."
PREPARING_DRILL = "Tangy is preparing the drill ..."
RECALLING_BOTH = "Tangy is recalling both ..."
RECALLING = "Tangy is recalling what it learnt ..."
THINKING = "Tangy is working out what it would do ... (esc: cancel)"


def not_saved_words(folder: Path, why: str | None) -> str:
    """Tell that a screenshot could not be saved."""
    return f"The picture could not be saved in {folder}: {why}."


def left_out_words(first: str, others: int) -> str:
    """Describe the first event left out of the log, and count the others."""
    return f"{first} And {others} more: `tangy store check` names them."


def too_small_words(width: int, height: int, least: tuple[int, int]) -> str:
    """Tell that the window is too small; sizes are in columns and lines."""
    return (
        f"Tangy needs {least[0]} x {least[1]} characters; this window has "
        f"{width} x {height}. Make it larger: nothing is lost."
    )
