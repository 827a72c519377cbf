"""Words for staff in the console of a game: commands, and their results."""

from __future__ import annotations

ANSWER_IN_WORDS = "Say in words what Tangy should do, or type: where, why, help, end."
SAY_IN_WORDS = "When Tangy asks, type in words what it should do."
NOTHING_WRONG = "Nothing is wrong."
ACCEPTABLE = "If all is well, type: all right. To read what you can do, type: what."
NOBODY = "Nobody is here any more, so the game ends."
NOT_BEGUN = "Tangy begins no other game."
NO_MORE = "There are no more lines. The game goes on by itself."


def nothing_to(word: str) -> str:
    """Tell that a command of teaching does nothing in a game."""
    return f"You cannot {word} in a game."


def not_begun(fault: str) -> str:
    """Tell that no other game begins, since nobody cleared a fault."""
    return f"Tangy begins no other game: nobody has cleared {fault!r}."


def not_known(text: str, near: str | None) -> str:
    """Tell that a line is no command here, and suggest a similar one."""
    meant = f" You can type: {near}." if near else ""
    return f"I do not know {text!r} here.{meant} Type help for all commands."
