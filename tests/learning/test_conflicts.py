"""All conflicts are found, across demonstrations and teachers, and one answer resolves each."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from itertools import count
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tangy_profiles.activity import Activity, load_activity
from tangy_profiles.codec import decode, encode
from tangy_profiles.demonstration import Demonstration, Step
from tangy_profiles.state import FRONT, ActivityState, Situation
from tangy_tui.learning.conflicts import (
    Resolution,
    find_conflicts,
    shown_steps,
    training_rows,
)
from tangy_tui.learning.effects import learn_effects
from tangy_tui.learning.policy import ForestSettings, NothingToLearnFrom, learn_policy
from tangy_tui.learning.reachable import joint_states

Demonstrate = Callable[[str, int, int], Demonstration]
BINGO = load_activity("bingo")
FEW = ForestSettings(trees=5)


def showing(
    *rows: tuple[Situation, str], teacher: str = "Ada", id: str = "made", first: int = 1
) -> Demonstration:
    """Make a demonstration of only these rows, with steps numbered from `first`."""
    steps = []
    for number, (situation, behaviour) in enumerate(rows, first):
        state = ActivityState(number, situation, FRONT, None, ())
        steps.append(Step(behaviour, None, state, state, id=number))
    return Demonstration(id, "bingo", teacher, 1, (), tuple(steps), finished=True)


def numbered(shown: list[Demonstration]) -> list[Demonstration]:
    """Give every step its own number, as the log does."""
    ids = count(1)
    return [replace(d, steps=tuple(replace(s, id=next(ids)) for s in d.steps)) for d in shown]


def spoil(
    activity: Activity, shown: list[Demonstration], where: list[int], rng: Random
) -> list[Demonstration]:
    """Let the teacher err in the steps of these numbers (counted through all demonstrations)."""
    place, spoilt = count(), []
    for demonstration in shown:
        steps = []
        for step in demonstration.steps:
            if next(place) in where:
                wrong = rng.choice([b for b in activity.behaviours if b != step.behaviour])
                step = replace(step, behaviour=wrong)
            steps.append(step)
        spoilt.append(replace(demonstration, steps=tuple(steps)))
    return spoilt


def rows_of(shown: list[Demonstration]) -> list[tuple[Situation, str]]:
    return [(s.step.state.situation, s.step.behaviour) for s in shown_steps(shown)]


@pytest.mark.parametrize("rarest", [False, True])
@pytest.mark.parametrize("seed", range(5))
def test_every_wrong_answer_of_three_percent_is_found_and_resolved(
    seed: int, rarest: bool, demonstrate: Demonstrate
) -> None:
    clean = numbered([demonstrate("bingo", 100 * seed + game, 4) for game in range(5)])
    rows = rows_of(clean)
    often = Counter(situation for situation, _ in rows)
    rng = Random(seed)
    order = sorted(range(len(rows)), key=lambda n: (often[rows[n][0]], rng.random()))
    spared: dict[
        Situation, int
    ] = {}  # each situation has a right answer: without one, answers cannot conflict
    for number in order:
        spared.setdefault(rows[number][0], number)
    free = [n for n in (order if rarest else order[::-1]) if n not in spared.values()]
    where = free[: round(0.03 * len(rows))]
    shown = spoil(BINGO, clean, where, rng)

    found = find_conflicts(shown)
    assert {c.situation for c in found} == {rows[number][0] for number in where}
    assert not any(learn_policy(BINGO, shown, settings=FEW).decide(c.situation).sure for c in found)

    resolutions = [c.resolved(BINGO.expected[c.situation]) for c in found]
    assert find_conflicts(shown, resolutions) == []
    policy = learn_policy(BINGO, shown, resolutions=resolutions, settings=FEW)
    for state in joint_states(BINGO, clean[0].people):
        decision = policy.decide(state.situation)
        assert decision.behaviour == BINGO.expected[state.situation]
        assert decision.sure


def test_a_conflict_names_the_teachers_of_each_answer(activity: Activity) -> None:
    where = Situation("help", "AR", "occluded")
    ada = showing((where, "move card closer"), (where, "move card closer"))
    bea = showing((where, "encourage"), teacher="Bea", id="other", first=3)
    (conflict,) = find_conflicts([bea, ada])
    assert list(conflict.answers) == ["move card closer", "encourage"]  # most often shown first
    told = {b: [(s.teacher, s.number) for s in steps] for b, steps in conflict.answers.items()}
    assert told == {"move card closer": [("Ada", 1), ("Ada", 2)], "encourage": [("Bea", 1)]}


def test_a_repeated_wrong_answer_reopens_the_conflict(activity: Activity) -> None:
    where = Situation("help", "AR", "occluded")
    early = showing((where, "move card closer"), (where, "encourage"))
    said = find_conflicts([early])[0].resolved("move card closer")
    assert find_conflicts([early], [said]) == []
    late = showing((where, "encourage"), id="later", first=3)
    (conflict,) = find_conflicts([early, late], [said])
    assert [s.demonstration for s in conflict.answers["encourage"]] == ["later"]
    again = conflict.resolved("encourage")
    assert find_conflicts([early, late], [said, again]) == []
    settled = learn_policy(activity, [early, late], resolutions=[said, again], settings=FEW)
    assert settled.decide(where).behaviour == "encourage"


def test_mistakes_settled_at_different_times_stay_settled(activity: Activity) -> None:
    where = Situation("help", "AR", "occluded")
    shown = [showing((where, "move card closer"), (where, "encourage"))]
    said: list[Resolution] = []
    for n, mistake in enumerate(("joke", "greeting", "encourage", "joke"), 3):
        (conflict,) = find_conflicts(shown, said)
        said.append(conflict.resolved("move card closer"))
        assert find_conflicts(shown, said) == []
        shown.append(showing((where, mistake), id=f"later {n}", first=n))
    said.append(find_conflicts(shown, said)[0].resolved("move card closer"))
    assert training_rows(shown, said) == ([(where, "move card closer")], [])
    decision = learn_policy(activity, shown, resolutions=said, settings=FEW).decide(where)
    assert (decision.behaviour, decision.sure) == ("move card closer", True)


def test_a_resolution_without_demonstrations_is_not_learnt(
    activity: Activity,
) -> None:
    where = Situation("help", "AR", "occluded")
    both = showing((where, "joke"), (where, "encourage"))
    said = find_conflicts([both])[0].resolved("move card closer")
    other = showing((Situation("start", "ANR", "occluded"), "greeting"), id="other", first=9)
    assert training_rows([other], [said]) == ([(other.steps[0].state.situation, "greeting")], [])
    with pytest.raises(NothingToLearnFrom):
        learn_policy(activity, [], resolutions=[said], settings=FEW)


def test_a_resolution_may_allow_two_answers(activity: Activity) -> None:
    where = Situation("help", "AR", "occluded")
    shown = showing((where, "move card closer"), (where, "encourage"))
    both = find_conflicts([shown])[0].resolved("move card closer", "encourage")
    decision = learn_policy(activity, [shown], resolutions=[both], settings=FEW).decide(where)
    assert decision.sure
    assert not decision.contested
    third = showing((where, "joke"), id="third", first=3)
    assert len(find_conflicts([shown, third], [both])) == 1


def test_a_resolution_may_name_an_undemonstrated_answer(activity: Activity) -> None:
    where = Situation("help", "AR", "occluded")
    shown = showing((where, "joke"), (where, "encourage"))
    said = find_conflicts([shown])[0].resolved("move card closer")
    assert training_rows([shown], [said]) == ([], [(where, "move card closer")])
    decision = learn_policy(activity, [shown], resolutions=[said], settings=FEW).decide(where)
    assert (decision.behaviour, decision.sure, decision.seen) == ("move card closer", True, 0)


def test_copies_of_a_step_count_once(activity: Activity) -> None:
    where = Situation("help", "AR", "occluded")
    one = showing((where, "encourage"))
    copy = replace(one, id="copy")
    assert training_rows([one, copy]) == ([(where, "encourage")], [])
    assert [s.demonstration for s in shown_steps([one, copy])] == ["made"]


def test_effects_of_wrong_or_failed_steps_are_not_learnt(demonstrate: Demonstrate) -> None:
    (shown,) = numbered([demonstrate("bingo", 1, 4)])
    first = shown.steps[0]
    stray = replace(first, behaviour="call number", id=10_000)
    spoilt = replace(shown, steps=(stray, *shown.steps))
    (conflict,) = find_conflicts([spoilt])
    clean = learn_effects(BINGO, [shown])
    assert learn_effects(BINGO, [spoilt]) != clean
    assert learn_effects(BINGO, [spoilt], [conflict.resolved(first.behaviour)]) == clean
    failed = replace(spoilt, steps=(replace(stray, completed=False), *shown.steps))
    assert learn_effects(BINGO, [failed]) == clean


SITUATIONS = st.sampled_from(BINGO.situations)
BEHAVIOURS = st.sampled_from(sorted(BINGO.behaviours))


@given(st.lists(st.tuples(SITUATIONS, BEHAVIOURS), min_size=1, max_size=30), st.data())
def test_resolving_every_conflict_keeps_all_other_rows(
    rows: list[tuple[Situation, str]], data: st.DataObject
) -> None:
    shown = showing(*rows)
    found = find_conflicts([shown])
    answers: dict[Situation, set[str]] = {}
    for situation, behaviour in rows:
        answers.setdefault(situation, set()).add(behaviour)
    assert {c.situation for c in found} == {s for s, b in answers.items() if len(b) > 1}
    said = [
        c.resolved(*data.draw(st.lists(BEHAVIOURS, min_size=1, max_size=3, unique=True)))
        for c in found
    ]
    assert find_conflicts([shown], said) == []
    right = {r.situation: set(r.right) for r in said}
    learnt = [row for rows in training_rows([shown], said) for row in rows]
    assert {s for s, _ in learnt} == set(answers)
    assert all(b in right.get(s, answers[s]) for s, b in learnt)
    assert [r for r in learnt if r[0] not in right] == [r for r in rows if r[0] not in right]
    for resolution in said:
        assert decode(Resolution, json.loads(json.dumps(encode(resolution)))) == resolution
