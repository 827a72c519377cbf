"""The situations of a declared activity: each stage with the values of the facts that it sees."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import product

from tangy_profiles.declared.model import Declaration, FactCondition, Stage
from tangy_profiles.declared.vocabulary import ASKING
from tangy_profiles.state import FACTS, Request, Situation

NOTHING_SEEN = "-"
"""The user state of a stage that sees no fact."""
IS = " is "


def label(sees: Sequence[str], values: Sequence[str]) -> str:
    """Format what a stage sees as the user state of a situation."""
    pairs = zip(sees, values, strict=True)
    return FACTS.join(f"{fact}{IS}{value}" for fact, value in pairs) or NOTHING_SEEN


def request_of(stage: Stage) -> Request:
    """Return the request state of a stage."""
    return "AR" if stage.about == "first asking" else "ANR"


def situation_of(declaration: Declaration, stage: str, values: Sequence[str]) -> Situation:
    """Return the situation that the policy sees: a stage, and the values of its facts."""
    found = declaration.stage(stage)
    return Situation(stage, request_of(found), label(found.sees, values))


def seen_facts(situation: Situation) -> dict[str, str]:
    """Return the facts of a situation with their values."""
    if situation.user_state == NOTHING_SEEN:
        return {}
    pairs = (one.split(IS, 1) for one in situation.user_state.split(FACTS))
    return dict(pairs)


def situations(declaration: Declaration) -> Iterator[Situation]:
    """Yield every situation that the conditions of the stages do not rule out."""
    earlier: list[Stage] = []
    for stage in declaration.stages:
        own = (*stage.when, *_of_its_person(declaration, stage))
        known = {
            one.fact: one.value for one in own if one.comparison == "is" and not one.quantifier
        }
        if stage.about == "first asking":
            known.setdefault(ASKING, "yes" if known.get(ASKING) == "yes" else "")
        for values in product(*(declaration.facts[name].values for name in stage.sees)):
            seen = dict(zip(stage.sees, values, strict=True))
            if any(told(one, seen) is False for one in own):
                continue
            facts = known | seen
            if not any(_rules_out(declaration, one, stage, facts) for one in earlier):
                yield Situation(stage.name, request_of(stage), label(stage.sees, values))
        earlier.append(stage)


def _of_its_person(declaration: Declaration, stage: Stage) -> Iterator[FactCondition]:
    """Yield the condition that selects the person of a stage, if there is always one."""
    condition = declaration.whose.get(stage.about)
    if condition is not None and replace(condition, quantifier="any") in stage.when:
        yield condition


def told(condition: FactCondition, facts: Mapping[str, str]) -> bool | None:
    """Return whether a condition holds for the known facts; None if they do not determine it."""
    if condition.quantifier or condition.comparison in (">=", "<"):
        return None
    value = facts.get(condition.fact)
    if not value:
        return None
    return (value == condition.value) is (condition.comparison == "is")


def _rules_out(
    declaration: Declaration, earlier: Stage, stage: Stage, facts: Mapping[str, str]
) -> bool:
    """Return whether the known facts select an earlier stage."""
    same = earlier.about == stage.about
    own = {
        name: value
        for name, value in facts.items()
        if same or not declaration.facts[name].per_player
    }
    return all(told(one, own) is True for one in earlier.when)
