"""Faults line by line: what is wrong, what is done about it, and staff who clear it."""

from __future__ import annotations

from collections.abc import Callable

from tangy_sim.worlds.faulty_world import FaultyWorld
from tangy_tui.monitoring.fault import Diagnosed, Fault, FaultEvent, RecoveryEvent
from tangy_tui.monitoring.supervision import Event, Supervision
from tangy_tui.monitoring.telling import move_words, whom_to_call
from tangy_tui.monitoring.times import clock

Read = Callable[[], str | None]
Write = Callable[[str], None]

HALTED = "Tangy stands still. Type: seen, expert, clear, what, faults, or quit."
SIMULATED = "The simulated expert has looked at it."
CALLS_NOBODY = "Tangy calls nobody itself."
MEANINGS = (
    ("seen", "you have seen it"),
    ("expert", "whom to call"),
    ("clear", "all is well again: Tangy goes on"),
    ("what", "what to do"),
    ("faults", "all faults of this game"),
    ("quit", "give the game up"),
)


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


def _said(move: RecoveryEvent) -> list[str]:
    return [f"   Tangy says: {move.speech}"] if move.speech else []


def list_lines(faults: list[Fault]) -> list[str]:
    """List faults with what was done about each."""
    lines: list[str] = []
    for number, fault in enumerate(faults, 1):
        lines.append(f"{number}. step {fault.step}: {fault.name} ({fault.status})")
        lines += [f"   {clock(move.seconds)}  {move_words(move)}" for move in fault.moves]
    return lines or ["No faults in this game."]


def attend(game: Supervision, write: Write, read: Read, who: str) -> list[Event]:
    """Take what staff say while the robot is halted; at the end of their lines the game ends."""
    fault = game.halted
    if fault is None:
        return []
    write(HALTED)
    while (line := read()) is not None:
        word = line.strip().lower()
        if word in ("seen", "acknowledge", "a"):
            told = game.acknowledge(who)
            if told:
                return told
            write("It was seen already: expert says whom to call, clear lets Tangy go on.")
        elif word in ("expert", "call expert", "e"):
            simulated = isinstance(game.world, FaultyWorld)
            write(SIMULATED if simulated else f"{whom_to_call(game.robot)} {CALLS_NOBODY}")
            return game.call_expert(who)
        elif word in ("clear", "cleared", "c"):
            if fault.acknowledged:
                return game.clear(who)
            write("Say first that you have seen it: seen.")
        elif word in ("what", "what to do", "why"):
            for told_line in advice_lines(game):
                write(told_line)
        elif word == "faults":
            for told_line in list_lines(game.faults):
                write(told_line)
        elif word in ("quit", "exit", "leave"):
            break
        elif game.verifier().stops(word):
            write(HALTED)
        elif word and not word.startswith("#"):
            if word not in ("help", "?"):
                write(f"I do not know {word!r} here.")
            for key, meaning in MEANINGS:
                write(f"  {key}: {meaning}")
    return game.give_up()
