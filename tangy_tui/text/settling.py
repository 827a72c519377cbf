"""Words for settling conflicts, and for events that staff accepted as normal."""

from __future__ import annotations

WHICH_IS_RIGHT = "Which is right? Type a number, b for all of them, or Enter to leave it open: "
LEFT_OPEN = "Left open. Tangy will ask when it happens."
SETTLE_ONE = "Settle one with `tangy demonstrations resolve 1 --right BEHAVIOUR`, or --both."
ALL_AGREE = "The demonstrations agree in every situation."
UNDO_TAKES_BACK = "`tangy demonstrations undo` takes it back."
FAULT_AGAIN = "Taken back. It counts as a fault again."
NOTHING_ACCEPTED = "Staff have accepted nothing unexpected as all right."


def how_to_settle(answers: int) -> str:
    """Tell what can be typed where demonstrations disagree."""
    return f"Type a number from 1 to {answers}, the answer itself, b, or only Enter."
