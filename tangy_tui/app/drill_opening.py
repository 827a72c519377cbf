"""Prepares a drill in a workspace, for the screen and for the console."""

from __future__ import annotations

from collections.abc import Callable
from time import monotonic
from typing import TYPE_CHECKING

from tangy_profiles.fault_file import load_faults
from tangy_tui.monitoring.drill import ROUNDS, Drill
from tangy_tui.monitoring.drill_policy import policy_for_drill
from tangy_tui.monitoring.drill_rounds import DrillSimulator

if TYPE_CHECKING:
    from tangy_profiles.drill_sheet import Sheet
    from tangy_tui.app.workspace import Workspace


def open_drill(
    workspace: Workspace,
    who: str,
    *,
    seed: int | None = None,
    rounds: int = ROUNDS,
    clock: Callable[[], float] = monotonic,
    past: Sheet | None = None,
) -> Drill:
    """Prepare a drill from the learnt policy, or from a scripted one; takes some seconds.

    Args:
        workspace: the activity, robot, people and log.
        who: the name of the person who rehearses.
        seed: draws the rounds; None takes a random seed.
        rounds: the number of rounds.
        clock: returns the time in s.
        past: the sheet of an interrupted drill to resume.

    Raises:
        TangyError: there is no policy to rehearse with, or the fault rules have a mistake.
    """
    activity, robot, store = workspace.activity, workspace.robot, workspace.store
    activity.need_cards()
    learnt = policy_for_drill(store, activity)
    faults = load_faults(robot)
    simulator = DrillSimulator(
        learnt.policy, learnt.effects, faults, robot, activity, workspace.names
    )
    return Drill(
        simulator, store,
        who=who, seed=seed, rounds=rounds, clock=clock, note=learnt.note, past=past,
    )  # fmt: skip
