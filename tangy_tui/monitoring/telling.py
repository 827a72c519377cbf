"""Evidence and moves in words, for console, lines and reports."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from tangy_profiles.faults import CONTEXT, SYMPTOMS, Condition, Evidence
from tangy_profiles.health import STALE, Fact
from tangy_profiles.reading import plain
from tangy_profiles.robot import Robot
from tangy_tui.learning.effects import Mismatch
from tangy_tui.monitoring.fault import MOVES, RecoveryEvent

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
        evidence: by which it was recognised.
        mismatches: what was not as expected.
        robot: its profile.
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
            measure = device.facts.get(fact)
            measured = measure.says if measure is not None else fact.replace("_", " ")
            parts.append(f"{device.label}: {measured}: {_number(value)}{limit}")
    return "; ".join([*parts, *map(mismatch_words, mismatches)])


def mismatch_words(mismatch: Mismatch) -> str:
    """Say what should have followed a behaviour and did not, as one who was there would."""
    words = _MISMATCHES.get((mismatch.variable, mismatch.seen))
    if words is None and mismatch.variable == "robot's place":
        there = _PLACES.get(mismatch.seen, mismatch.seen)
        wanted = " or ".join(_PLACES.get(place, place) for place in mismatch.expected)
        words = f"Tangy is {there}" + (f", and should be {wanted}" if wanted else "")
    if words is None:
        words = f"{mismatch.variable}: {mismatch.seen}"
    never = "" if mismatch.expected else " (no demonstration shows what to expect here)"
    return f"after {mismatch.behaviour!r}, {words}{never}"


def move_words(move: RecoveryEvent) -> str:
    """Say in a few words what was done."""
    words = _REMEDIES.get(move.remedy, move.remedy) or MOVES.get(move.kind, move.kind)
    if move.kind == "escalated":
        return f"{words if move.attempt else 'nobody was there for that'}: now {_TO[move.to]}"
    if move.attempt > 1:
        words = f"{words}, for the {_ordinal(move.attempt)} time"
    if move.by:
        words = f"{words}, by {move.by}"
    return words


_PLACES = {"front": "at the front"}
_MISMATCHES = {
    ("activity", "not begun"): "the activity has still not begun",
    ("activity", "begun"): "the activity has begun, and should not have",
    ("end", "reached"): "the end has come, and should not have",
    ("end", "not reached"): "the end has not come, and should have",
    ("stage", "not left"): "nothing moved on, and it should have",
    ("stage", "left"): "the activity moved on, and should not have",
    ("request", "open"): "the request for help is still open, and should have ended",
    ("request", "closed"): "the request for help has ended, and should not have",
    ("request", "open with nothing left"): (
        "the request for help is still open, with nothing left to do"
    ),
    ("what was asked about", "unchanged"): "what it was about has not changed",
    ("what was asked about", "settled"): "what it was about was settled, unexpectedly",
    ("card", "lost from view"): "what Tangy was looking at went out of its sight",
    ("card", "kept in view"): "Tangy still sees what should be out of its sight",
    ("others' requests", "fewer"): "somebody else who asked for help asks no more",
    ("others' requests", "kept"): "somebody else still asks for help, unexpectedly",
}
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


def whom_to_call(robot: Robot) -> str:
    """Say whom staff call about what they cannot mend, or that nobody is named."""
    expert = robot.expert
    if expert is None:
        return "No expert is named for this robot: ask your facility who looks after it."
    number = f": {expert.telephone}" if expert.telephone else ""
    return plain(f"Call the expert, {expert.name}{number}.")


def _number(value: Fact) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value:.2g}" if isinstance(value, float) else str(value)


def _ordinal(number: int) -> str:
    return {1: "first", 2: "second", 3: "third"}.get(number, f"{number}th")
