"""Words for asking a new teacher's name."""

from __future__ import annotations

WHO = "Who are you?"
WHO_DETAIL = "Tangy notes who taught each game, so that it can tell teachers apart."
TOUR_FOLLOWS = "Next, a tour of two minutes shows you how to teach a game."
NAME_KEYS = "enter keeps the name   esc not now"
TYPE_NAME = "Type your name and press Enter, or just Enter to be called {}."
TYPE_A_NAME = "Type your name and press Enter."


HOW_TO_RENAME = "To change that, type: my name is Rosa."


def renamed_teacher(name: str, present: str) -> str:
    """Tell who teaches from now on; `present` is the teacher of the current game."""
    first = "" if present == name else f" This game stays {present}'s; the next one is yours."
    return f"You teach as {name} from now on.{first}"


def teaches_as(name: str) -> str:
    """Tell in a line who teaches, and how to change it."""
    return f"You teach as {name}. {HOW_TO_RENAME}"
