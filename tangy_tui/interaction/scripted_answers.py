"""A scripted teacher in a game: answers what the activity expects, where Tangy asks."""

from __future__ import annotations

from tangy_tui.interaction.facilitation import Facilitation, GameEvent
from tangy_tui.learning.scripted_teacher import SCRIPTED


def answer_by_script(facilitation: Facilitation) -> list[GameEvent]:
    """Answer the open question; give the game up where the activity expects nothing."""
    question = facilitation.question
    activity = facilitation.world.activity
    if question is None:
        return []
    expected = activity.expected.get(question.state.situation)
    if expected is None:
        return facilitation.give_up()
    behaviour = activity.behaviour(expected)
    target = question.state.attended if behaviour.attends else None
    return facilitation.answer(behaviour, target, SCRIPTED)
