"""What staff do about faults in a game, and the faults that they can inject."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TypeAlias

from tangy_sim.worlds.injection import KINDS
from tangy_tui.app.game_commands import Accept, Acknowledge, CallExpert, Clear, Reached
from tangy_tui.app.staff_notes import StaffNote
from tangy_tui.monitoring.supervision import Event, Supervision

Result: TypeAlias = Event | StaffNote
"""The result of a command."""
FaultCommand: TypeAlias = Acknowledge | CallExpert | Reached | Clear | Accept


def attend(game: Supervision, command: FaultCommand, by: str) -> list[Result]:
    """Carry out a command about a fault, and return its results."""
    fault = game.halted
    match command:
        case Accept():
            return list(game.accept(by)) or [StaffNote("not acceptable")]
        case Acknowledge(wanted) if wanted:
            seen = next((one for one in game.faults if one.id == wanted), None)
            return list(game.acknowledge(by, seen))
        case _ if fault is None:
            return [StaffNote("not halted")]
        case Acknowledge():
            return list(game.acknowledge(by)) or [StaffNote("seen before")]
        case CallExpert():
            return list(game.call_expert(by))
        case Reached():
            return [StaffNote("reached" if game.reached(by) else "nobody named")]
        case Clear():
            return list(game.clear(by)) if fault.acknowledged else [StaffNote("not seen yet")]


def possible_kinds(codes: Iterable[str]) -> tuple[str, ...]:
    """Return the kinds of fault whose correct diagnosis is one of these codes."""
    known = set(codes)
    return tuple(name for name, kind in KINDS.items() if kind.code in known)
