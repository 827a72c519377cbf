"""The person of a behaviour, learnt with it: selectors that named the demonstrated person.

For each stage and behaviour, the selectors that named that person every time are kept. If they name
different people now, Tangy asks.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from tangy_profiles.behaviour import Behaviour
from tangy_profiles.demonstration import Demonstration, Step
from tangy_profiles.state import EVERYBODY, ActivityState

Whom = Mapping[tuple[str, str], tuple[str, ...]]
"""The remaining selectors, by stage and behaviour, in the order of the activity's file."""


@dataclass(frozen=True, slots=True)
class Addressee:
    """The current person of a behaviour (None: the group), and the selectors that name them.

    `others` are the people named by the selectors if they disagree.
    """

    person: str | None
    selectors: tuple[str, ...]
    others: tuple[tuple[str, str], ...] = ()

    @property
    def sure(self) -> bool:
        """Whether all remaining selectors name the same person."""
        return not self.others


def named_by(behaviour: Behaviour, state: ActivityState, person: str | None) -> tuple[str, ...]:
    """Return the selectors of a behaviour that name a person (None: the group) in a state."""
    names = dict(state.whom)
    return tuple(
        one
        for one in behaviour.to
        if (person is None if one == EVERYBODY else names.get(one) == person is not None)
    )


def first_addressee(behaviour: Behaviour, state: ActivityState) -> str | None:
    """Return the default person of a behaviour: that of its first selector."""
    names = dict(state.whom)
    for one in behaviour.to:
        if one == EVERYBODY:
            return None
        if one in names:
            return names[one]
    return None


def learn_whom(
    demonstrations: Iterable[Demonstration], behaviours: Mapping[str, Behaviour]
) -> dict[tuple[str, str], tuple[str, ...]]:
    """Learn which selectors named the demonstrated person in every step.

    If no selector did, those of the last step count.
    """
    left: dict[tuple[str, str], tuple[str, ...]] = {}
    for demonstration in demonstrations:
        for step in demonstration.steps:
            behaviour = behaviours.get(step.behaviour)
            if behaviour is None or len(behaviour.to) < 2:
                continue
            named = named_by(behaviour, step.state, step.target)
            if named:
                key = _key(step)
                both = tuple(one for one in left.get(key, named) if one in named)
                left[key] = both or named
    return left


def addressee(whom: Whom, behaviour: Behaviour, state: ActivityState) -> Addressee:
    """Return the learnt addressee of a behaviour in a state."""
    selectors = whom.get((state.stage, behaviour.name), behaviour.to)
    names = dict(state.whom)
    named = {
        one: None if one == EVERYBODY else names[one]
        for one in selectors
        if one == EVERYBODY or one in names
    }
    if not named:
        return Addressee(None, selectors)
    person = next(iter(named.values()))
    if len(set(named.values())) == 1:
        return Addressee(person, tuple(named))
    return Addressee(
        person, tuple(named), tuple((one, who or EVERYBODY) for one, who in named.items())
    )


def target_of(whom: Whom, behaviour: Behaviour | None, state: ActivityState) -> str | None:
    """Return the default person of a behaviour in a state (None: the group)."""
    if behaviour is None or not behaviour.attends:
        return None
    return addressee(whom, behaviour, state).person if behaviour.to else state.attended


def _key(step: Step) -> tuple[str, str]:
    return step.state.stage, step.behaviour
