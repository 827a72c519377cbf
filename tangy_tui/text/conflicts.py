"""Words for conflicts between demonstrations, for settling them, and for accepted events."""

from __future__ import annotations

from tangy_tui.text.numbers import counted

ANSWER_HELP = (
    "The steps that gave this answer. Enter opens one in its demonstration. Press "
    "the number before the answer if it is right."
)

THIS_IS_RIGHT = "This answer is right"
ALL_ARE_RIGHT = "All of them are right"
ANOTHER_IS_RIGHT = "Something else is right"
OPEN_OR_GO_ON = "Open the step, or go on at the end"
LEAVE_OPEN = "Leave it open"
"""The actions of the keys, in help and palette."""
ASKED = (
    "Which is right? Press its number, 0 if all of them are, {another} for something else. Esc "
    "leaves it open: Tangy will not act there in a game, but ask."
)
OTHER = "What is right here?"
TAKEN_BACK = "Your last answer is taken back."
NOTHING_TAKEN_BACK = "There is no answer to take back."
NONE_LEFT = "The demonstrations agree in every situation."


def left_open_words(situation: str) -> str:
    """Tell that a conflict was not settled."""
    return f"{situation}: left open. In a game Tangy will ask you."


def situation_words(situation: str) -> str:
    """Name the situation in which demonstrations disagree."""
    return f"Different answers were shown in this situation: {situation}."


def settled_words(answered: str, aside: int) -> str:
    """Name the resolution, and how many steps no longer count."""
    return answered + (f" {counted(aside, 'step')} set aside." if aside else "")


def done_words(settled: int, left: int) -> str:
    """Tell how many conflicts were settled and left open."""
    if not settled and not left:
        return NONE_LEFT
    if not left:
        return f"Settled: {settled}. Nothing is left open."
    return f"Settled: {settled}. Left open: {left}; Tangy will ask there when it plays."


def keys_words(then: str) -> str:
    """Tell which keys continue after the last conflict."""
    return f"Press enter to {then}, esc to go back, {{undo}} to take the last answer back."


WHICH_IS_RIGHT = "Which is right? Type a number, b for all of them, or Enter to leave it open."
LEFT_OPEN = "Left open. Tangy will ask when it happens."
SETTLE_ONE = "Settle one with `tangy demonstrations resolve 1 --right BEHAVIOUR`, or --both."
UNDO_TAKES_BACK = "`tangy demonstrations undo` takes it back."
FAULT_AGAIN = "Taken back. It counts as a fault again."
NOTHING_ACCEPTED = "Staff have accepted nothing unexpected as all right."


def all_agree(title: str) -> str:
    """Tell that the demonstrations of an activity, given by title, have no conflicts."""
    return f"{title}: the demonstrations agree in every situation."


def conflicts_left(count: int) -> str:
    """Tell how many conflicts are open, and what comes next."""
    if not count:
        return "No conflict is left. Now learn again with `tangy learn`."
    left = counted(count, "conflict is", "conflicts are")
    return (
        f"{left} left: `tangy demonstrations conflicts` shows the steps. Then learn again with "
        "`tangy learn`."
    )


def how_to_settle(answers: int) -> str:
    """Tell what can be typed where demonstrations disagree."""
    return f"Type a number from 1 to {answers}, the answer itself, b, or only Enter."
