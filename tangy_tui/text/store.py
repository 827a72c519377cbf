"""What is said of the log of a data folder as a whole."""

from __future__ import annotations

from tangy_tui.text.numbers import counted


def log_checked(folder: str, events: int, problems: int) -> str:
    """Say how many events a log has, and in how many ways it is wrong."""
    found = counted(problems, "thing is wrong", "things are wrong")
    return f"{folder}: {counted(events, 'event')}, {found if problems else 'nothing is wrong'}."


def accepted(losses: int) -> str:
    """Say what became of losses that staff accepted."""
    return "Accepted: Tangy no longer says so." if losses else "There is nothing to accept."
