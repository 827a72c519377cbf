"""Words for a fault that halts Tangy, and for the results of staff's keys."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tangy_profiles.contacts import EXPERT
from tangy_tui.text.calls import call_words, expert_words
from tangy_tui.text.fault_moves import move_words
from tangy_tui.text.faults import fault_time, kind_words, mark_of

if TYPE_CHECKING:
    from tangy_tui.monitoring.fault import Fault, RecoveryEvent
    from tangy_tui.monitoring.supervision import Supervision

SEEN_FIRST = "Press {acknowledge} first to say that you have seen this."
SEEN = "You have seen it. Press {expert} to see whom to call, or {accept} when all is well."
SEEN_REHEARSED = (
    "You have seen it. Press {accept} when all is well, or {expert}: the simulated expert puts it "
    "right."
)
REHEARSED = "This is a rehearsal: {expert} lets the simulated expert put it right."
WHEN_WELL = "Press {accept} when all is well."
REACHED_TOO = "Press {reached} when you have reached them."
SIMULATED = "The simulated expert has looked at it. Press {accept} when all is well."
RESTARTED = "The robot process was started again."
STILL_THERE = "It is still there. Tangy stands still. Press {expert} to see whom to call."
STOPPED = "STOP. After you have cleared this, {pause} lets Tangy go on."
RESTARTING = "The robot process is started again ..."
CALLING = "The simulated expert looks at it ..."
LOOKING = "Looking whether it is gone ..."
WHOM_TO_CALL = "What to do, and whom to call"
SO_FAR = "So far"

GIVE_UP_KEY = "Give this game up"
GIVE_UP = f"{GIVE_UP_KEY}?"
GIVE_UP_DETAIL = (
    "The game ends here, and the log says why. Tangy stays where it is and does not move. "
    "The fault is not mended: keep people away until someone has seen to it."
)


def title(fault: Fault) -> str:
    """Return the heading for the fault that halts the robot."""
    return f"{mark_of(fault)} Tangy stands still: {fault.name}"


def halted_words(fault: Fault) -> str:
    """Tell the kind of the fault, and after which step it halted the robot."""
    where = f"{kind_words(fault).capitalize()}, after step {fault.step}."
    return f"{where} Tangy has stopped, and nothing moves until you clear this."


def last_move_words(fault: Fault, move: RecoveryEvent) -> str:
    """Name the last recovery event of a fault."""
    return f"Last, at {fault_time(fault, move.seconds)}: {move_words(move)}."


def wait_words(doing: str) -> str:
    """Tell that a command about the fault is still running."""
    return f"Wait. {doing}"


def failed_words(error: Exception) -> str:
    """Tell why a key had no effect."""
    return f"{error} Nothing was changed: try again."


def to_be_reached(game: Supervision) -> bool:
    """Return whether staff may say that they have reached the expert."""
    if game.calls is None or game.robot.expert is None:
        return False
    state = game.calls.state(EXPERT)
    return state is None or not state.over


def called_words(game: Supervision, *, restarted: bool) -> str:
    """Tell who was called or has answered, or whom to call, and the state of the recovery."""
    begun = f"{RESTARTED} " if restarted else ""
    waits = f"{REACHED_TOO} " if to_be_reached(game) else ""
    return f"{begun}{expert_words(game)} {waits}{WHEN_WELL}"


def rehearsed_words(game: Supervision) -> str:
    """Tell what the simulated expert did, and the state of the call if people are called."""
    state = None if game.calls is None else game.calls.state(EXPERT)
    if state is None:
        return SIMULATED
    waits = f" {REACHED_TOO}" if to_be_reached(game) else ""
    return f"{call_words(state)}{waits} {SIMULATED}"


ALL_WELL = "Is all well now?"


def uncleared_words(name: str) -> str:
    """Name the fault that nobody cleared in the last game, and tell what going on does."""
    return (
        f"{name}: nobody cleared this fault of the last game. Tangy may move as soon as you go on."
    )
