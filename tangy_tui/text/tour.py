"""The words of the tour for a new teacher."""

from __future__ import annotations

from typing import assert_never

from tangy_tui.app.tour import TourStop

KEYS_ALSO = "Enter goes on, Esc skips the tour."
LINES_ALSO = "Enter alone goes on; type skip to skip the tour."
SEATED = "People answer, act or ask at their seats, and you say what Tangy does next."
TOUR_ON, SKIP_TOUR = "Go on with the tour", "Skip the tour"


def tour_words(
    stop: TourStop, teacher: str, title: str, phrase: str, *, visits: bool = True
) -> str:
    """Return the text of a stop on the screen, with placeholders for keys in braces.

    Args:
        stop: the stop of the tour.
        teacher: the teacher's name.
        title: the activity's title.
        phrase: the command to try.
        visits: whether the robot goes to people in this activity.
    """
    match stop:
        case TourStop.ROOM:
            welcome = f"Welcome, {teacher}. You show Tangy how to host {title}. Above is the room."
            return f"{welcome} {KEYS_ALSO}"
        case TourStop.COMMAND:
            return (
                f"You say what Tangy does next. Try it: type {phrase} and press Enter. "
                "Tab lists what else can be said now."
            )
        case TourStop.QUESTION:
            return "Tangy does nothing before you say yes. Look at the question, and answer it."
        case TourStop.STEP:
            return (
                "That is your first step; see it under Steps. {undo} takes a step back, {redo} "
                "brings it back. Enter goes on."
            )
        case TourStop.UNDONE:
            return "The step is gone from Steps. {redo} brings it back. Enter goes on."
        case TourStop.PEOPLE if not visits:
            return f"{SEATED} {{undo}} takes back more than one step. Enter goes on."
        case TourStop.PEOPLE:
            return (
                "People press a button when they need help: ?1 beside a name is first. Send Tangy "
                "to them, help, and go back. Enter goes on."
            )
        case TourStop.COACH:
            return (
                "This line says what is going on, and what a host might do. The line below lists "
                "what Tangy has not seen yet. Your turn: press Enter."
            )
        case _:
            assert_never(stop)


def tour_line(stop: TourStop, teacher: str, title: str, phrase: str, *, visits: bool = True) -> str:
    """Return the text of a stop in line mode; see `tour_words`."""
    match stop:
        case TourStop.ROOM:
            return f"Welcome, {teacher}. You show Tangy how to host {title}. {LINES_ALSO}"
        case TourStop.COMMAND:
            return f"You say what Tangy does next. Try it: type {phrase} and press Enter."
        case TourStop.QUESTION:
            return "Tangy does nothing before you say yes. Read the question, and answer it."
        case TourStop.STEP:
            return "That is your first step. The word undo takes it back, redo brings it back."
        case TourStop.UNDONE:
            return "The step is taken back. The word redo brings it back."
        case TourStop.PEOPLE if not visits:
            return f"{SEATED} The line that begins with Now tells you."
        case TourStop.PEOPLE:
            return (
                "Now and then somebody asks for help. Send Tangy there, for example: go to user 2. "
                "The line that begins with Now tells what Tangy sees there."
            )
        case TourStop.COACH:
            return (
                "That line always tells what is going on, and what a host might do. The word seen "
                "lists what Tangy has not seen yet, help lists the rest. Now you teach."
            )
        case _:
            assert_never(stop)
