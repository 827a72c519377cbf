"""The addressee of a behaviour is learnt with it; if selectors disagree, Tangy asks."""

from __future__ import annotations

from tangy_profiles.activity import load_activity
from tangy_profiles.declared.whom import addressee, learn_whom
from tangy_profiles.demonstration import Demonstration, Step
from tangy_profiles.state import ActivityState, Situation, UserState

BEHAVIOUR = load_activity("trivia").behaviours["repeat question"]


def state(first: str, turn: str) -> ActivityState:
    users = tuple(UserState(one, "-", "ANR") for one in ("ann", "ben"))
    whom = (("first asking", first), ("whose turn", turn))
    return ActivityState(0, Situation("repeat", "AR", "-"), "front", first, users, None, (), whom)


def shown(*steps: tuple[ActivityState, str | None]) -> Demonstration:
    made = tuple(Step(BEHAVIOUR.name, target, before, before) for before, target in steps)
    return Demonstration("one", "trivia", "test", 1, ("ann", "ben"), made, True)


def learnt(*steps: tuple[ActivityState, str | None]) -> dict[tuple[str, str], tuple[str, ...]]:
    return learn_whom([shown(*steps)], {BEHAVIOUR.name: BEHAVIOUR})


def test_one_step_leaves_the_selectors_that_named_the_person() -> None:
    whom = learnt((state("ann", "ann"), "ann"))
    assert whom == {("repeat", BEHAVIOUR.name): ("first asking", "whose turn")}


def test_disagreeing_selectors_are_uncertain() -> None:
    whom = learnt((state("ann", "ann"), "ann"))
    found = addressee(whom, BEHAVIOUR, state("ann", "ben"))
    assert not found.sure
    assert found.others == (("first asking", "ann"), ("whose turn", "ben"))
    assert addressee(whom, BEHAVIOUR, state("ben", "ben")).sure


def test_a_second_step_decides_between_them() -> None:
    whom = learnt((state("ann", "ann"), "ann"), (state("ann", "ben"), "ann"))
    found = addressee(whom, BEHAVIOUR, state("ben", "ann"))
    assert (found.person, found.selectors, found.sure) == ("ben", ("first asking",), True)


def test_the_group_can_be_the_addressee() -> None:
    whom = learnt((state("ann", "ben"), None))
    found = addressee(whom, BEHAVIOUR, state("ben", "ann"))
    assert (found.person, found.sure) == (None, True)
