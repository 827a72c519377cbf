"""What a new teacher is asked and shown: the name, and the captions of the tour."""

from __future__ import annotations

from typing import assert_never

from tangy_tui.app.tour import TourStop

WHO = "Who are you?"
WHO_DETAIL = "Tangy keeps with each game who has shown it, and tells teachers apart by their names."
NAME_KEYS = "enter keeps the name   esc not now"
TYPE_NAME = "Type your name and press Enter, or just Enter to be called {}."
SKIP = "Enter goes on, Esc skips the tour."


def tour_words(stop: TourStop, teacher: str, title: str, phrase: str, *, keys: bool = True) -> str:
    """Say what is to be seen or done at a stop.

    Args:
        stop: where the tour is.
        teacher: who is shown around.
        title: of the activity.
        phrase: the command that is tried.
        keys: there is a screen, with keys that go on.
    """
    match stop:
        case TourStop.ROOM:
            words = f"Welcome, {teacher}. You show Tangy how to host {title}."
            return f"{words} Above is the room. {SKIP}" if keys else words
        case TourStop.COMMAND:
            return f"You say what Tangy does next. Try it: type {phrase!r} and press Enter."
        case TourStop.QUESTION:
            return "Tangy does nothing unasked: say yes to the question, as it tells you below."
        case TourStop.STEP:
            undo = "F2 takes the last step back" if keys else "undo takes the last step back"
            return f"That is your first step. If you slip, {undo}." + (" Enter." if keys else "")
        case TourStop.COACH:
            if not keys:
                return "The line Now always says what is going on and what a host might do."
            return (
                "This line always says what is going on and what a host might do. Below it stands "
                "what Tangy has not seen yet. Press Enter, and teach."
            )
        case _:
            assert_never(stop)


def renamed_teacher(name: str) -> str:
    """Say who teaches from now on."""
    return f"You teach as {name} from now on."


def teaches_as(name: str, command: str) -> str:
    """Say who teaches, and how that is changed."""
    return f"You teach as {name}. To change it, type {command}."


NEXT_GAME = "This game stays as it began; the next one is by your new name."
"""Said where a name is changed in the middle of a game."""
