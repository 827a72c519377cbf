"""Sentences for the steps of a game, the same in the console, in logs and on other screens."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tangy_tui.text.situations import addressed_step, reason_of

if TYPE_CHECKING:
    from tangy_profiles.activity import Activity
    from tangy_profiles.state import ActivityState
    from tangy_tui.text.situations import Name

STOPPED_BEFORE = "Tangy had begun this before the stop. It stood still and did not finish."
ENDED_BEFORE = "Tangy had begun this before the end of the game. It stood still and did not finish."
NOT_FINISHED = "Tangy could not finish this."


def step_sentence(
    activity: Activity | None,
    state: ActivityState,
    behaviour: str,
    target: str | None,
    name: Name,
    *,
    strategy: str = "",
    teacher: str = "",
) -> str:
    """Tell what Tangy did and why: "Go to Rosa, because somebody asks for help."."""
    words, why, clause = behaviour, " / ".join(state.situation), False
    if activity is not None:
        words = activity.behaviour_words(behaviour)
        why, clause = reason_of(activity, state, name)
    if teacher:
        why, clause = "", False
    step = addressed_step(words, name(target) if target else "", "" if clause else why)
    parts = (
        f"{step[:1].upper()}{step[1:]}",
        f", with {strategy}" if strategy else "",
        f", because {why}" if clause else "",
        f", as {teacher} said" if teacher else "",
    )
    return f"{''.join(parts)}."


def unfinished_words(*, stopped: bool, ended: bool) -> str:
    """Tell that Tangy did not finish a step, and whether because staff broke it off.

    Args:
        stopped: whether people had stopped the robot.
        ended: whether staff had ended the game.
    """
    return ENDED_BEFORE if ended else STOPPED_BEFORE if stopped else NOT_FINISHED
