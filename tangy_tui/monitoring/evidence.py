"""The evidence of a diagnosis in words: measurements, expectations and observations."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import partial
from typing import TypeAlias

from tangy_profiles.faults import CONTEXT, SYMPTOMS, Condition, Evidence
from tangy_profiles.health import ERROR, NEVER, OK, STALE, WARN, Fact
from tangy_profiles.robot import Robot
from tangy_tui.interaction.reading_error import FusedObservation
from tangy_tui.learning.effects import Mismatch

STATES = {OK: "working", STALE: "no data", ERROR: "failed", WARN: "warning"}
"""The states of a device in words, for lists, evidence, drills and banners."""

Label: TypeAlias = Callable[[str], str]
"""Returns the words for a behaviour (see `Activity.behaviour_words`)."""


def evidence_words(
    evidence: Evidence,
    mismatches: Sequence[Mismatch],
    robot: Robot,
    conditions: Iterable[Condition] = (),
    looks: FusedObservation | None = None,
    label: Label = str,
) -> str:
    """Format evidence as one line: measurements, expectations and observations.

    Args:
        evidence: the evidence of a diagnosis.
        mismatches: the unexpected effects.
        robot: its profile.
        conditions: the matching conditions, for the limits of measurements.
        looks: how many looks the mismatches rest on, and how often one is wrong.
        label: returns the words for a behaviour.
    """
    limits = {condition.key: condition.limit for condition in conditions}
    parts: list[str] = []
    for key, value in evidence.items():
        if key in CONTEXT or key.startswith("mismatch."):
            continue
        head, _, fact = key.partition(".")
        device = robot.devices.get(head)
        if device is None:
            parts.append(f"{SYMPTOMS.get(key, key)}: {written(value)}")
        elif fact == "state":
            age = evidence.get(f"{head}.age")
            late = value == STALE and isinstance(age, float)
            since = "" if not late or age is None else _for_so_long(float(age))
            parts.append(f"{device.label}: {STATES.get(str(value), str(value))}{since}")
        elif fact == "age" and f"{head}.state" in evidence:
            continue  # included with the state
        else:
            limit = f" ({words})" if (words := limits.get(key, "")) else ""
            measure = device.facts.get(fact)
            measured = measure.says if measure is not None else fact.replace("_", " ")
            parts.append(f"{device.label}: {measured}: {written(value)}{limit}")
    told = [*parts, *map(partial(mismatch_words, label=label), mismatches)]
    if looks is not None:
        often = max(2, round(1 / looks.rate))
        agree = f"{looks.agreeing} of {looks.taken} looks agree"
        told.append(f"{agree}, and one look is wrong about 1 in {often} times")
    return "; ".join(told)


def _for_so_long(age: float) -> str:
    """Say for how many s a device has sent no data."""
    return " yet" if age >= NEVER else f" for {written(age)} s"


def mismatch_words(mismatch: Mismatch, label: Label = str) -> str:
    """Describe a mismatch in words, as a witness would."""
    words = _MISMATCHES.get((mismatch.variable, mismatch.seen))
    if words is None and mismatch.variable == "robot's place":
        there = _PLACES.get(mismatch.seen, mismatch.seen)
        wanted = " or ".join(_PLACES.get(place, place) for place in mismatch.expected)
        words = f"it is {there}" + (f", and should be {wanted}" if wanted else "")
    if words is None:
        words = f"{mismatch.variable}: {mismatch.seen}"
    never = "" if mismatch.expected else " (no demonstration shows what to expect here)"
    return f"Tangy was to {label(mismatch.behaviour)}, but {words}{never}"


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
    ("what was asked about", "unchanged"): "it still sees the same as before",
    ("what was asked about", "settled"): "this was settled, and should not have been",
    ("card", "lost from view"): "what Tangy was looking at went out of its sight",
    ("card", "kept in view"): "Tangy still sees what should be out of its sight",
    ("others' requests", "fewer"): "somebody else who asked for help asks no more",
    ("others' requests", "none left"): "all who asked for help stopped asking at the same moment",
    ("others' requests", "kept"): "somebody else still asks for help, unexpectedly",
}


def written(value: Fact) -> str:
    """Format a measured value, numbers with two significant digits and without an exponent."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if not isinstance(value, float):
        return str(value)
    return f"{value:.2g}" if abs(value) < 99.5 else f"{value:.0f}"
