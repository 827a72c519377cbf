"""Words that explain decisions: why Tangy does this, and which demonstrated steps support it."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING

from tangy_tui.learning.policy import SURE
from tangy_tui.learning.scripted_teacher import SCRIPTED
from tangy_tui.text.numbers import counted, listed, often

if TYPE_CHECKING:
    from tangy_profiles.activity import Activity
    from tangy_tui.learning.conflicts import DemonstratedStep
    from tangy_tui.learning.explanation import DecisionReasons


def shown_here(seen: int, share: float) -> str:
    """Tell how often a behaviour was demonstrated, and its share of the votes if that is not 1."""
    if not seen:
        return f"a guess, {share:.0%} sure"
    times = often(seen)
    return f"as shown {times}" if share >= 1 else f"as shown {times}, {share:.0%} sure"


def why_words(activity: Activity, why: DecisionReasons, *, votes: bool = True) -> list[str]:
    """Explain a decision in sentences, the most important first.

    Args:
        activity: the activity played.
        why: the explanation.
        votes: add a sentence on the votes, unless they are drawn beside the sentences.
    """
    decision = why.decision
    done = activity.behaviour_words(decision.behaviour)
    sentences = [f"Situation: {activity.in_words(why.situation)}."]
    teachers = dict.fromkeys(shown.teacher for shown in why.rests_on)
    times = often(len(why.rests_on))
    if decision.contested:
        sentences.append(
            "Demonstrations disagree here, and nobody has said which is right yet. Tangy asks "
            "instead of acting."
        )
    elif decision.whatever and not why.rests_on:
        whatever = listed(decision.whatever, "or")
        sentences.append(f"A rule covers it: {done!r}, whatever {whatever}. Nobody showed it here.")
    elif not decision.seen and not decision.sure:
        sentences.append("Nobody has shown Tangy what to do here. It asks instead of acting.")
    elif not why.rests_on:
        sentences.append(f"A teacher said that {done!r} is right here.")
    else:
        sentences.append(f"{done!r} was shown here {times}, by {teachers_words(teachers)}.")
        if decision.right and why.against:
            right = listed((repr(activity.behaviour_words(b)) for b in decision.right), "or")
            sentences.append(f"A teacher said that {right} is right here.")
        if not decision.sure:
            sentences.append(f"Tangy is less than {SURE:.0%} sure, so it asks instead of acting.")
    if votes and (len(decision.votes) > 1 or not decision.seen):
        shares = ", ".join(
            f"{activity.behaviour_words(b)} {share:.0%}" for b, share in decision.votes
        )
        sentences.append(f"{HOW_SURE}: {shares}.")
    if why.near:
        guesses = dict.fromkeys(activity.in_words(s.step.state.situation) for s in why.near)
        sentences.append(f"Tangy guesses from what was shown nearby: {'; '.join(guesses)}.")
    return sentences


def teachers_words(teachers: Iterable[str]) -> str:
    """Name those who showed a step; the scripted teacher is a ready-made example."""
    return listed([EXAMPLE if one == SCRIPTED else one for one in teachers])


def reasons_words(activity: Activity, why: DecisionReasons) -> list[str]:
    """Explain a decision in sentences, without its situation."""
    return why_words(activity, why)[1:]


def shown_words(activity: Activity, shown: DemonstratedStep, name: Callable[[str], str]) -> str:
    """Name a demonstrated step: behaviour, place in the demonstration, teacher.

    Args:
        activity: the activity of the demonstration.
        shown: the step, with its demonstration.
        name: returns a demonstration's name for an id.
    """
    where = f"step {shown.number} of {name(shown.demonstration)}"
    done = activity.behaviour_words(shown.step.behaviour)
    return f"{done}: {where}, by {teachers_words([shown.teacher])}"


EXAMPLE = "a ready-made example"
"""The name of the scripted teacher."""
WHY_HEADINGS = ("Based on", "Shown here as well", "Shown nearby")
"""Headings of the supporting, contradicting and similar steps."""
HOW_SURE = "How sure Tangy is"
"""Heading of the share of the votes for each behaviour."""


def earlier_words(count: int) -> str:
    """Tell how many earlier steps are not shown yet, and how to see them."""
    return f"  {counted(count, 'earlier step')}: enter shows {'it' if count == 1 else 'them'}"


def strategy_title(name: str, strategy: str) -> str:
    """Return the heading of how a strategy was chosen for a person."""
    return f"How to say it to {name}: {strategy}"


def chosen_words(method: str) -> str:
    """Tell how a strategy is chosen from the numbers."""
    return f"Chosen by {method}: the highest number is used."


WHY_ASKED = "Why does Tangy ask?"


def why_step_title(number: int) -> str:
    """Return the title of the explanation of a step."""
    return f"Step {number}: why this?"


WHY_NOW = "What Tangy does, and why"
"""The title of the explanation of the last step and the next one."""


def last_step_heading(number: int, behaviour: str) -> str:
    """Return the heading of the explanation of the last step, below that of the next one."""
    return f"Step {number}, the last one so far: {behaviour}"


def why_row_title(policy: str) -> str:
    """Return the title of the explanation of a row of a policy."""
    return f"{policy}: why this?"


def answered_words(teacher: str, behaviour: str) -> str:
    """Tell who answered Tangy's question, and what."""
    return f"Tangy asked, and {teacher} answered: {behaviour}."
