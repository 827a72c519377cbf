"""Scripted staff in a game: they answer questions and clear faults after the expert's visit."""

from __future__ import annotations

from collections.abc import Sequence

from tangy_profiles.declared.whom import first_addressee
from tangy_profiles.past_game import PastGame
from tangy_tui.app.fault_commands import Result
from tangy_tui.app.game_commands import CallExpert, Clear, EndGame, GoOn
from tangy_tui.app.game_controller import GameController
from tangy_tui.app.staff_notes import StaffNote
from tangy_tui.learning.scripted_teacher import SCRIPTED
from tangy_tui.monitoring.supervision import Event, Supervision

TIMES_CALLED = 3
"""After this many visits of the expert in vain, the game is given up."""


def scripted_controller(game: Supervision, past: PastGame | None = None) -> GameController:
    """Create a controller of simulated games with scripted staff.

    Args:
        game: runs the games.
        past: an interrupted game to resume first.
    """
    return GameController(game, SCRIPTED, past=past)


def go_on_by_script(control: GameController, *, expert: bool) -> list[Event]:
    """Carry out the next step; scripted staff act if someone is needed.

    Args:
        control: runs the game.
        expert: staff are there; without them, a fault that halts the robot ends the game.
    """
    told: Sequence[Result]
    game = control.supervision
    if game.halted is not None:
        told = _clear(control) if expert else control.give_up()
    elif game.question is not None:
        told = _answer(control)
    elif control.stopped:  # by an onlooker; nobody is here to release the robot
        told = control.apply(EndGame())
    else:
        if control.phase == "paused":  # as an interrupted game is
            control.apply(GoOn())
        told = control.next()
    return [one for one in told if not isinstance(one, StaffNote)]


def _answer(control: GameController) -> list[Result]:
    """Answer the open question; give the game up if the activity expects no behaviour."""
    game = control.supervision
    question, activity = game.question, game.world.activity
    if question is None:
        return []
    expected = activity.expected.get(question.state.situation)
    if expected is None:
        return list(control.give_up())
    behaviour = activity.behaviour(expected)
    selector = activity.expected_selector(question.state.situation)
    target = question.state.attended if behaviour.attends else None
    if behaviour.to:
        whom = dict(question.state.whom).get(selector or "")
        target = whom or (None if selector else first_addressee(behaviour, question.state))
    return control.answer(behaviour, target)


def _clear(control: GameController) -> list[Result]:
    """Clear the fault that halts the robot with the expert's help, or give the game up."""
    game = control.supervision
    told = list[Result](game.look())  # screens check the devices all the time
    fault = game.halted
    for _ in range(TIMES_CALLED):
        told += control.carry_out(CallExpert()) + control.carry_out(Clear())
        if game.halted is not fault:
            return told
    return [*told, *control.give_up()]
