"""Words for the moves of a recovery, one by one: what Tangy did about a fault, and who else did."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from tangy_tui.text.numbers import ordinal

if TYPE_CHECKING:
    from tangy_profiles.game_records import MoveKind
    from tangy_tui.monitoring.fault import RecoveryEvent

DONE_REMEDIES = {
    "spin": "Tangy turned on the spot to find its place",
    "restart": "it was started again",
    "replan": "Tangy took another way",
    "do without": "Tangy does without it",
    "other requests": "Tangy listens for requests instead",
    "set aside": "Tangy left it at that",
    "leave to staff": "Tangy left it to you",
}
"""Words for Tangy's own recovery actions when done."""

MOVES: Mapping[MoveKind, str] = {
    "kept": "kept for later: another fault comes first",
    "asked": "asked for help",
    "remedied": "Tangy did something about it by itself",
    "teacher asked": "asked the teacher",
    "halted": "halted",
    "acknowledged": "was acknowledged",
    "expert called": "staff saw whom to call",
    "still there": "it is still there: it must be mended before staff can clear it",
    "escalated": "that did not help",
    "went on": "went on",
    "recovered": "recovered",
    "taught": "the teacher said what to do",
    "accepted": "the teacher said that this is all right",
    "cleared": "was cleared",
    "ended": "ended by itself",
    "left": "Tangy left it at that",
    "given up": "the game was given up",
    "left open": "was left open at the end of the game",
}
"""Words for the recovery moves."""

BY: Mapping[MoveKind, str] = {
    "expert called": "{by} saw whom to call",
    "still there": "{by} wanted to clear it, but it is still there: it must be mended first",
    "taught": "{by} said what to do",
    "accepted": "{by} said that this is all right",
}
"""Words for the moves whose sentence names who made them otherwise than at its end."""

RECOVERY_WORDS = {
    "expert": "halt, and ask an expert",
    "user": "ask a user for help",
    "teacher": "ask a teacher",
    "continue": "go on",
}
"""Words for the kinds of recovery."""


def move_words(move: RecoveryEvent) -> str:
    """Name a recovery event in a few words."""
    words = DONE_REMEDIES.get(move.remedy, move.remedy) or MOVES.get(move.kind, move.kind)
    if move.kind == "escalated":
        tried = words if move.attempt else "nobody was there for that"
        return f"{tried}: now {RECOVERY_WORDS[move.to]}"
    if move.by and move.kind in BY:
        return BY[move.kind].format(by=move.by)
    if move.attempt > 1:
        words = f"{words}, for the {ordinal(move.attempt)} time"
    if move.by:
        words = f"{words} by {move.by}"
    return words
