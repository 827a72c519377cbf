"""Words for commands that Tangy refuses now, while teaching or in a game."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, assert_never

from tangy_profiles.reading import plain
from tangy_tui.text.numbers import listed

if TYPE_CHECKING:
    from tangy_tui.learning.verification import Refused

WHICH = "Please say which: its number, or N for a new command."


def refused_words(refused: Refused) -> str:
    """Tell in a sentence why a command is refused now."""
    about = refused.about
    match refused.why:
        case "no question":
            return "There is no question to answer: give a command first."
        case "no such choice":
            return f"There is no choice {refused.number}."
        case "say which":
            return WHICH
        case "nobody asks":
            return _for_nobody("nobody asks for help", about)
        case "request ended":
            return f"Nobody asks for help now: the last step ended {about}'s request."
        case "nobody to do it for":
            return _for_nobody("there is nobody to do it for", about)
        case "not with them":
            return f"Tangy is not with {about} yet: it has to go there first."
        case "no such person":
            return _no_such_person(refused)
        case "not finished":
            return "This demonstration is not finished yet."
        case "another simulator":
            return "The unfinished game was made with another simulator; a new one begins."
        case "no step to show again":
            return f"There is no step {refused.number} to show again."
        case "game over":
            return "This game is over. Begin the next demonstration, or undo a step."
        case "nothing to settle":
            return "There is nothing to settle: the last step raised no question."
        case "no step to undo":
            return "There is no step to undo."
        case "undo came out otherwise":
            return "This step cannot be undone: the simulator has changed since."
        case "no step to redo":
            return "There is no step to do again."
        case "answer first":
            return "Answer the question first."
        case "redo came out otherwise":
            return "This step cannot be done again: the simulator has changed since."
        case "not possible":
            return about
        case forgotten:
            assert_never(forgotten)


def _for_nobody(why: str, example: str) -> str:
    way = f" Say whom to go to, for example: {example}." if example else ""
    return f"That cannot be done now: {why}.{way}"


def _no_such_person(refused: Refused) -> str:
    take = "take part" if len(refused.people) > 1 else "takes part"
    there = "There is no" if " " in refused.about else "There is nobody called"
    return f"{there} {refused.about}: {listed(refused.people)} {take}."


def not_understood_words(heard: str, suggestions: Sequence[str]) -> str:
    """Tell that words were not understood, and name similar commands.

    This asks nothing: a y would answer no question.
    """
    near = f" You can say: {', '.join(suggestions)}." if suggestions else ""
    return f"I do not know what {plain(heard)!r} means.{near}"
