"""Words of the list of messages that staff can read again."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime, timedelta

from tangy_profiles.game_records import MoveKind
from tangy_tui.monitoring.fault import Diagnosed, FaultEvent
from tangy_tui.text.faults import fault_lines

TITLE = "The last messages"
NONE_YET = "Tangy has not told you anything yet."
KEYS = "up down more   esc closes"
HELP = (
    "What Tangy told you since the program began, the newest message first, with the time of day. "
    "If you went on with a game that was interrupted, what its log has from before is below. "
    "Up and down scroll."
)

GONE: tuple[MoveKind, ...] = ("recovered", "ended")
"""The moves that end a fault because it has gone."""


def timed_message(at: datetime, words: str) -> str:
    """Write a message with the time of day at which it was shown (s matter in a game)."""
    return f"{at:%H:%M:%S} {words}"


def fault_message(event: FaultEvent) -> str:
    """Tell a fault, or what became of it, in one message."""
    if not isinstance(event, Diagnosed) and event.move.kind in GONE:
        return f"{event.fault.name}: this fault has gone."
    return one_sentence(event, fault_lines(event))


def fault_at(event: FaultEvent) -> datetime | None:
    """Return when a fault was found, or changed (local time); None if that is not known."""
    fault, found = event.fault, isinstance(event, Diagnosed)
    if not fault.at or not (found or fault.real_time):
        return None
    later = 0.0 if isinstance(event, Diagnosed) else event.move.seconds - fault.seconds
    return (datetime.fromisoformat(fault.at) + timedelta(seconds=later)).astimezone()


def one_sentence(event: object, lines: Sequence[str]) -> str:
    """Join the lines that tell an event, without their marks."""
    if isinstance(event, Diagnosed):
        lines = lines[:1]  # the list of faults has the evidence
    return " ".join(line.lstrip("!?* ") for line in lines)
