"""Scripted people in a game: a teacher who answers, and staff who clear what an expert mended."""

from __future__ import annotations

from tangy_tui.learning.scripted_teacher import SCRIPTED
from tangy_tui.monitoring.supervision import Event, Supervision

TIMES_CALLED = 3
"""An expert who comes so often and cannot mend it has the game given up."""


def answer_by_script(game: Supervision) -> list[Event]:
    """Answer the open question; give the game up where the activity expects nothing."""
    question = game.question
    activity = game.world.activity
    if question is None:
        return []
    expected = activity.expected.get(question.state.situation)
    if expected is None:
        return game.give_up()
    behaviour = activity.behaviour(expected)
    target = question.state.attended if behaviour.attends else None
    return game.answer(behaviour, target, SCRIPTED)


def clear_by_script(game: Supervision) -> list[Event]:
    """Acknowledge what halts the robot, call the expert, and clear it, or give the game up."""
    fault, told = game.halted, list[Event]()
    if fault is None:
        return []
    for _ in range(TIMES_CALLED):
        told += game.call_expert(SCRIPTED) + game.clear(SCRIPTED)
        if game.halted is not fault:
            return told
    return told + game.give_up()


def go_on_by_script(game: Supervision, *, expert: bool) -> list[Event]:
    """Do the next thing, with scripted people where somebody is needed.

    Args:
        game: what runs the game.
        expert: staff are there; without them a robot that halts ends the game.
    """
    if game.halted is not None:
        return clear_by_script(game) if expert else game.give_up()
    if game.question is not None:
        return answer_by_script(game)
    return game.step()
