"""Faults line by line: what is wrong, what is done about it, and what staff can do."""

from __future__ import annotations

from tangy_sim.worlds.faulty_world import FaultyWorld
from tangy_tui.monitoring.fault import Diagnosed, Fault, FaultEvent, RecoveryEvent
from tangy_tui.monitoring.supervision import Supervision
from tangy_tui.text.faults import move_words, whom_to_call
from tangy_tui.text.times import clock

HALTED = "Tangy stands still. Type: seen, expert, clear, what, faults, or quit."
SIMULATED = "The simulated expert has looked at it."
CALLS_NOBODY = "Tangy calls nobody itself."


def fault_lines(event: FaultEvent) -> list[str]:
    """Put a fault, or what was done about it, into lines."""
    fault = event.fault
    if fault.asks_only:
        return []  # the question that Tangy asks says all of it
    if isinstance(event, Diagnosed):
        kind = "CRITICAL" if fault.critical else "non-critical"
        return [f"!  Fault, {kind}: {fault.name}. {fault.console}", f"   Why: {fault.why}."]
    if event.move.kind == "halted" and not fault.critical:
        return [f"!  Tangy halts: {fault.name}.", *_said(event.move)]
    return [f"   {fault.name}: {move_words(event.move)}.", *_said(event.move)]


def advice_lines(game: Supervision) -> list[str]:
    """Say what staff should do about what Tangy asks, or about what halts it."""
    question = game.question
    about = "" if question is None else question.fault
    fault = game.halted or next((one for one in game.faults if one.id == about), None)
    if fault is None:
        return []
    steps = [f"  {number}. {step}" for number, step in enumerate(fault.advice, 1)]
    return [f"{fault.console} Why: {fault.why}.", *steps]


def expert_line(game: Supervision) -> str:
    """Say who is called about what halts Tangy, or whom staff are to call."""
    simulated = isinstance(game.world, FaultyWorld)
    return SIMULATED if simulated else f"{whom_to_call(game.robot)} {CALLS_NOBODY}"


def _said(move: RecoveryEvent) -> list[str]:
    return [f"   Tangy says: {move.speech}"] if move.speech else []


def list_lines(faults: list[Fault]) -> list[str]:
    """List faults with what was done about each."""
    lines: list[str] = []
    for number, fault in enumerate(faults, 1):
        lines.append(f"{number}. step {fault.step}: {fault.name} ({fault.status})")
        lines += [f"   {clock(move.seconds)}  {move_words(move)}" for move in fault.moves]
    return lines or ["No faults in this game."]
