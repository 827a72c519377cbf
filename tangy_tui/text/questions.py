"""Words for verification questions, and for words that Tangy does not understand."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tangy_tui.text.decisions import teachers_words
from tangy_tui.text.numbers import often
from tangy_tui.text.refusals import WHICH
from tangy_tui.text.situations import ALL_RIGHT

if TYPE_CHECKING:
    from tangy_profiles.activity import Activity
    from tangy_tui.learning.explanation import DecisionReasons
    from tangy_tui.learning.verification import Asked, Offered

TOO_EARLY = "Too early: please answer again."
DID_YOU_SAY = "Did you say: "
NO_QUESTION = "There is no question open: give a command."
ANSWER_HELP = "Please answer Y to do it, or N for another command."
LEAVE = "leave without executing it"
ANSWER_MEANINGS = (
    ("y", "yes, execute it"),
    ("n", "no, do nothing; give a new command"),
    ("quit", LEAVE),
)
DID_YOU_MEAN = "Did you mean"
OR_DID_YOU_MEAN = "Or did you mean"
YES_OR_NO = "yes or no"
NUMBER_OR_NONE = "the number of one, or no: none of these"

LETS_GO_ON = "let Tangy go on by itself"
"""What Esc does in the line of a question that staff asked for themselves, after the key."""
STOPPED_FIRST = "Tangy was stopped: press {pause} to go on first, then answer."
GIVE_UP = "Give this game up?"
GIVE_UP_DETAIL = "The game ends here without an answer. Tangy will ask again next time."
REJECTED = "Not done. Give a new command."


def yes_words(key: str) -> str:
    """Name the key for yes, after another was pressed."""
    return f"The yes of this question is {key}."


def asked_words(reason: str, given: str = "") -> str:
    """Tell why Tangy asks, which answers were given before, and ask what it should do."""
    return f"{reason} {given} What should Tangy do?" if given else f"{reason} What should Tangy do?"


def acceptable_words(reason: str) -> str:
    """Tell what Tangy did not expect, and ask whether it is all right."""
    return f"{reason} If all is well, type: {ALL_RIGHT[0]}. If not, what should Tangy do?"


def given_words(activity: Activity, why: DecisionReasons) -> str:
    """Tell which answers demonstrations give in a situation, how often and by whom."""
    given: dict[str, list[str]] = {}
    for shown in (*why.rests_on, *why.against):
        given.setdefault(shown.step.behaviour, []).append(shown.teacher)
    parts = [
        f"{activity.behaviour_words(behaviour)} "
        f"({often(len(teachers))}, by {teachers_words(dict.fromkeys(teachers))})"
        for behaviour, teachers in given.items()
    ]
    return f"Shown so far: {', '.join(parts)}." if parts else ""


def answer_help(question: Asked | Offered) -> list[str]:
    """List the answers to an open question, one per line."""
    from tangy_tui.learning.verification import Offered

    if isinstance(question, Offered):
        return [WHICH, "  n: none of these; give a new command", f"  quit: {LEAVE}"]
    alternatives = len(question.alternatives)
    lines = [ANSWER_HELP, *(f"  {word}: {meaning}" for word, meaning in ANSWER_MEANINGS)]
    if alternatives:
        numbers = "1" if alternatives == 1 else f"1 to {alternatives}"
        lines.insert(3, f"  {numbers}: not that, but what stands beside the number")
    return lines


def answer_line(*, own: bool, accepts: bool) -> str:
    """Tell in the empty line of a question what can be typed.

    Args:
        own: staff asked for the question themselves.
        accepts: they can also say that all is well.
    """
    if own:
        return "what should Tangy do? (or: why, pause, help)"
    well = f"{ALL_RIGHT[0]}, " if accepts else ""
    return f"what should Tangy do? (or: {well}why, help, quit)"
