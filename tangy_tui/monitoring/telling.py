"""Evidence and moves in words, for console, lines and reports."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from tangy_profiles.faults import CONTEXT, SYMPTOMS, Condition, Evidence
from tangy_profiles.health import STALE, Fact
from tangy_profiles.robot import Robot
from tangy_tui.learning.effects import Mismatch
from tangy_tui.monitoring.fault import MOVES, Move

_STATES = {
    "OK": "all is well",
    "STALE": "nothing came from it",
    "ERROR": "it reports an error",
    "WARN": "it warns",
}


def evidence_words(
    evidence: Evidence,
    mismatches: Sequence[Mismatch],
    robot: Robot,
    conditions: Iterable[Condition] = (),
) -> str:
    """Write evidence as one line: what was measured, and what was expected and seen.

    Args:
        conditions: by which the evidence was recognised; their limits are said beside it.
    """
    limits = {condition.key: condition.limit for condition in conditions}
    parts: list[str] = []
    for key, value in evidence.items():
        if key in CONTEXT or key.startswith("mismatch."):
            continue
        head, _, fact = key.partition(".")
        device = robot.devices.get(head)
        if device is None:
            parts.append(f"{SYMPTOMS.get(key, key)}: {_number(value)}")
        elif fact == "state":
            age = evidence.get(f"{head}.age")
            since = f" for {age:.2g} s" if value == STALE and isinstance(age, float) else ""
            parts.append(f"{device.label}: {_STATES.get(str(value), str(value))}{since}")
        elif fact == "age" and f"{head}.state" in evidence:
            continue  # it was said with the state
        else:
            limit = f" ({words})" if (words := limits.get(key, "")) else ""
            measured = device.facts.get(fact, fact.replace("_", " "))
            parts.append(f"{device.label}: {measured}: {_number(value)}{limit}")
    return "; ".join([*parts, *map(str, mismatches)])


def move_words(move: Move) -> str:
    """Say in a few words what was done."""
    words = _REMEDIES.get(move.remedy, move.remedy) or MOVES.get(move.kind, move.kind)
    if move.attempt > 1:
        words = f"{words}, for the {_ordinal(move.attempt)} time"
    if move.to:
        words = f"{words}: now {_TO[move.to]}"
    if move.by:
        words = f"{words}, by {move.by}"
    return words


_REMEDIES = {
    "spin": "Tangy turned on the spot to find its place",
    "restart": "it was started again",
    "replan": "Tangy took another way",
    "do without": "Tangy does without it",
    "other requests": "Tangy listens for requests instead",
    "set aside": "Tangy left it at that",
}
RECOVERY_WORDS = {
    "expert": "halt, and ask an expert",
    "user": "ask a user for help",
    "teacher": "ask a teacher",
    "continue": "go on",
}
"""The recoveries in words."""
_TO = RECOVERY_WORDS


def _number(value: Fact) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value:.2g}" if isinstance(value, float) else str(value)


def _ordinal(number: int) -> str:
    return {1: "first", 2: "second", 3: "third"}.get(number, f"{number}th")
