"""Games that end early: before the behaviour that was due, or before the end was shown."""

from __future__ import annotations

from tangy_profiles.activity import Activity
from tangy_profiles.demonstration import Demonstration
from tangy_profiles.state import Situation


def ending(activity: Activity) -> list[str]:
    """Return the behaviours that end the activity."""
    return [name for name, one in activity.behaviours.items() if one.ends]


def due_instead(activity: Activity, situation: Situation, behaviour: str) -> str:
    """Return the behaviour that was due in the situation in which another one ended the game.

    It is "" if the end was due, if the activity expects nothing in this situation, or if the
    behaviour did not end the game.
    """
    finishes = ending(activity)
    expected = activity.expected.get(situation, "")
    return "" if behaviour not in finishes or expected in finishes else expected


def missed_end(activity: Activity, shown: Demonstration) -> str:
    """Return the behaviour that a demonstration never got to: the end, or what was due before it.

    It is "" if the demonstration was played to its end.
    """
    ends = {r.stage: r.behaviour for r in activity.stage_rules if r.condition == "after"}
    if ends:
        reached = {step.state.stage for step in shown.steps}
        return "" if reached.intersection(ends) else next(iter(ends.values())) or ""
    finishes = ending(activity)
    done = [step for step in shown.steps if step.behaviour in finishes and step.completed]
    if not done:
        return next(iter(finishes), "")
    last = done[-1]
    return due_instead(activity, last.state.situation, last.behaviour)
