"""Fault rules adapted to a robot that lacks some of their devices."""

from __future__ import annotations

from collections.abc import Container, Sequence
from dataclasses import replace

from tangy_profiles.faults import CONTEXT, SYMPTOMS, Condition, FaultRule
from tangy_profiles.health import OK


def for_devices(rules: Sequence[FaultRule], devices: Container[str]) -> tuple[FaultRule, ...]:
    """Return the rules that can match for a robot with these devices, in order.

    A condition on a missing device never holds, except that its state is not OK, which always
    holds. So a robot without a voice is mute as soon as its screen fails. A rule is left out if no
    condition is left, or if an earlier one now always matches first.

    Args:
        rules: in the order of their file; the last one is the fallback.
        devices: the names of the robot's devices.
    """
    found: list[FaultRule] = []
    for rule in rules:
        when = tuple(
            left
            for conditions in rule.when
            if (left := _left(conditions, devices))
            and not any(other.hides(left) for other in found)
        )
        if when or rule.fallback:
            found.append(_rule(rule, when, devices))
    return tuple(found)


def _rule(
    rule: FaultRule, when: tuple[tuple[Condition, ...], ...], devices: Container[str]
) -> FaultRule:
    also = tuple(key for key in rule.also if _is_there(key, devices))
    device = rule.device
    if device and device not in devices:
        heads = (condition.key.partition(".")[0] for one in when for condition in one)
        device = next((head for head in heads if head in devices), "")
    return replace(rule, when=when, also=also, device=device)


def _left(conditions: Sequence[Condition], devices: Container[str]) -> tuple[Condition, ...]:
    """Return the conditions that remain; none if they can never hold together."""
    there = tuple(one for one in conditions if _is_there(one.key, devices))
    gone = [one for one in conditions if one not in there]
    never = any(not (one.key.endswith(".state") and _is_met_by_none(one)) for one in gone)
    symptoms = [one for one in there if one.key not in CONTEXT]
    return () if never or not symptoms else there


def _is_met_by_none(condition: Condition) -> bool:
    return (condition.test, condition.value) == ("not", OK)


def _is_there(key: str, devices: Container[str]) -> bool:
    return key in CONTEXT or key in SYMPTOMS or key.partition(".")[0] in devices
