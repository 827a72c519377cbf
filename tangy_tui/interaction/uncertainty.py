"""Why Tangy is not sure what to do in a situation, and what would help, in words."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from tangy_profiles.activity import Activity
from tangy_profiles.state import ActivityState
from tangy_tui.learning.policy import Decision


def why_not(activity: Activity, state: ActivityState, decision: Decision) -> str:
    """Explain why Tangy does not act by itself in this situation."""
    situation = activity.in_words(state.situation)
    if decision.contested:
        answers = " or ".join(activity.behaviour_words(b) for b, _ in decision.votes)
        return f"Demonstrations disagree about what to do here: {situation} ({answers})."
    if not decision.seen:
        return f"Nobody has shown Tangy what to do here yet: {situation}."
    return (
        f"Tangy is not sure what to do here: {situation} ({decision.share:.0%} sure of "
        f"{activity.behaviour_words(decision.behaviour)!r})."
    )


def remedy_for(decision: Decision) -> str:
    """Say what would make Tangy sure."""
    if decision.contested:
        return "Say which is right with `tangy demonstrations resolve`, and learn again."
    if not decision.seen:
        return "Demonstrate it once."
    return "Demonstrate it again, or correct the demonstration that differs."


def which_of(behaviour: str, others: Sequence[tuple[str, str]], names: Mapping[str, str]) -> str:
    """Return the question whom a behaviour is for, as its selectors name different people."""
    ways = [f"{names.get(person, person)} ({selector})" for selector, person in others]
    return f"{behaviour}: for {' or '.join(ways)}?"
