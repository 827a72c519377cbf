"""Words for the log of a data folder as a whole."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from tangy_tui.text.policies import left_out_words

if TYPE_CHECKING:
    from tangy_tui.monitoring.log_check import LogProblem

from tangy_tui.text.numbers import counted


def log_checked(folder: str, events: int, problems: int) -> str:
    """Tell the number of events and of problems of a log."""
    found = counted(problems, "thing is wrong", "things are wrong")
    return f"{folder}: {counted(events, 'event')}, {found if problems else 'nothing is wrong'}."


def accepted(losses: int) -> str:
    """Tell that losses were accepted, or that there are none."""
    return "Accepted: Tangy no longer says so." if losses else "There is nothing to accept."


def problem_words(problems: Iterable[LogProblem]) -> list[str]:
    """Describe the damage in a log, a sentence each."""
    return [one if isinstance(one, str) else left_out_words(one) for one in problems]
