"""Effects: few false alarms in correct games, and every planted fault is caught."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from tangy_profiles.activity import Activity, load_activity
from tangy_profiles.demonstration import Demonstration
from tangy_profiles.state import FRONT, ActivityState, Situation
from tangy_sim.worlds.world import SimulatedWorld
from tangy_tui.learning.effects import Effects, Mismatch, learn_effects, transition
from tangy_tui.text.learnt import EFFECTS

Demonstrate = Callable[[str, int, int], Demonstration]
Seen = tuple[ActivityState, str, ActivityState]
Plant = Callable[[ActivityState, ActivityState], ActivityState | None]

GAMES = 100


def watch(activity: Activity, seed: int, users: int = 4) -> list[Seen]:
    """Return every transition of correct games."""
    world = SimulatedWorld(activity, [f"user{n + 1}" for n in range(users)], seed=seed)
    seen: list[Seen] = []
    for _ in range(GAMES):
        while not world.over:
            state = world.observe()
            behaviour = activity.behaviours[activity.expected[state.situation]]
            target = state.attended if behaviour.attends else None
            world.execute(activity.action(behaviour, target, None))
            seen.append((state, behaviour.name, world.observe()))
        world.begin()
    return seen


@pytest.fixture(scope="module")
def games() -> list[Seen]:
    return watch(load_activity("bingo"), 4242)


@pytest.fixture(scope="module")
def effects(activity: Activity, demonstrate: Demonstrate) -> Effects:
    return learn_effects(activity, [demonstrate("bingo", 9000 + n, 4) for n in range(3)])


# --------------------------------------------------------------------------- correct games


@pytest.mark.slow
def test_three_demonstrations_give_at_most_one_false_alarm_in_a_hundred_games(
    activity: Activity, demonstrate: Demonstrate, games: list[Seen]
) -> None:
    alarms = sets = 0
    for first in range(7000, 7090, 3):
        shown = [demonstrate("bingo", first + n, 4) for n in range(3)]
        if {s.state.situation for d in shown for s in d.steps} >= set(activity.situations):
            sets += 1
            learnt = learn_effects(activity, shown)
            alarms += sum(len(learnt.mismatches(b, s, a, activity)) for s, b, a in games)
    assert sets > 20
    assert alarms / (sets * GAMES) <= 0.01


def test_demonstrated_effects_are_expected(
    activity: Activity, demonstrate: Demonstrate, effects: Effects
) -> None:
    for number in range(3):
        for step in demonstrate("bingo", 9000 + number, 4).steps:
            assert not effects.mismatches(step.behaviour, step.state, step.after, activity)


def test_every_effect_has_its_own_words(activity: Activity, games: list[Seen]) -> None:
    followed = {
        value for before, _, after in games for value in transition(before, after, activity).items()
    }
    assert len(followed) > 10
    assert followed <= set(EFFECTS)
    assert len(set(EFFECTS.values())) == len(EFFECTS)


@pytest.mark.parametrize("users", [1, 2, 8])
def test_effects_learnt_with_four_people_hold_for_other_group_sizes(
    users: int, activity: Activity, effects: Effects
) -> None:
    seen = watch(activity, 11, users)
    assert sum(len(effects.mismatches(b, s, a, activity)) for s, b, a in seen) <= GAMES * 0.01


def test_effects_are_learnt_for_a_made_up_activity(
    lanterns: Activity, cover: Callable[[str, int, int], tuple[Demonstration, ...]]
) -> None:
    shown = [*cover("lanterns", 1, 4), *cover("lanterns", 2, 4)]
    learnt = learn_effects(lanterns, shown)
    assert set(learnt.values) == set(lanterns.behaviours)
    alarms = sum(len(learnt.mismatches(b, s, a, lanterns)) for s, b, a in watch(lanterns, 3))
    assert alarms <= GAMES * 0.01


# ------------------------------------------------------------------------------ planted faults


def nothing_happens(before: ActivityState, _: ActivityState) -> ActivityState:
    return before._replace(step=before.step + 1, closed=None)


def with_somebody_else(before: ActivityState, after: ActivityState) -> ActivityState:
    other = next(u.id for u in after.users if u.id not in (before.attended, before.place))
    return after._replace(place=other)


def card_out_of_view(before: ActivityState, after: ActivityState) -> ActivityState:
    users = tuple(user._replace(activity="occluded") for user in before.users)
    return after._replace(place=before.place, users=users, closed=None)


def one_request_fewer(before: ActivityState, after: ActivityState) -> ActivityState | None:
    open_ = [u.id for u in before.users if u.request == "AR" and u.id != before.attended]
    if not open_:
        return None
    users = tuple(u._replace(request="ANR") if u.id == open_[0] else u for u in after.users)
    return after._replace(users=users)


def the_end(_: ActivityState, after: ActivityState) -> ActivityState:
    return after._replace(situation=Situation("end", "AR", "occluded"))


@pytest.mark.parametrize(
    ("behaviour", "plant", "variable"),
    [
        ("greeting", nothing_happens, "activity"),
        ("joke", nothing_happens, "stage"),
        ("navigate to user", nothing_happens, "robot's place"),
        ("navigate to user", with_somebody_else, "robot's place"),
        ("navigate to front", nothing_happens, "robot's place"),
        ("call number", with_somebody_else, "robot's place"),
        ("call number", the_end, "end"),
        ("move card closer", nothing_happens, "what was asked about"),
        ("remove markers", nothing_happens, "what was asked about"),
        ("mark numbers", nothing_happens, "what was asked about"),
        ("remove markers", card_out_of_view, "card"),
        ("mark numbers", card_out_of_view, "card"),
        ("encourage", nothing_happens, "what was asked about"),
        ("encourage", card_out_of_view, "card"),
        ("celebrate", nothing_happens, "end"),
        ("navigate to user", one_request_fewer, "others' requests"),
        ("remove markers", one_request_fewer, "others' requests"),
        ("encourage", one_request_fewer, "others' requests"),
    ],
)
def test_every_planted_fault_is_caught(
    behaviour: str,
    plant: Plant,
    variable: str,
    activity: Activity,
    effects: Effects,
    games: list[Seen],
) -> None:
    planted = 0
    for before, name, after in games:
        if name != behaviour:
            continue
        faulty = plant(before, after)
        if faulty is not None:
            planted += 1
            found = effects.mismatches(behaviour, before, faulty, activity)
            assert variable in {mismatch.variable for mismatch in found}
    assert planted >= 3


def test_a_request_repeated_at_once_is_no_fault(
    activity: Activity, effects: Effects, games: list[Seen]
) -> None:
    closed = [(b, a) for b, name, a in games if name == "encourage"]
    for before, after in closed:
        again = tuple(
            u._replace(request="AR") if u.id == before.attended else u for u in after.users
        )
        assert not effects.mismatches("encourage", before, after._replace(users=again), activity)


def test_an_undemonstrated_behaviour_has_no_expected_effect(
    activity: Activity, games: list[Seen]
) -> None:
    before, name, after = games[0]
    found = Effects({}).mismatches(name, before, after, activity)
    assert {mismatch.variable for mismatch in found} == set(transition(before, after, activity))
    assert all(mismatch.expected == () for mismatch in found)
    assert "nothing known" in str(found[0])


def test_a_mismatch_is_described_in_words() -> None:
    mismatch = Mismatch("navigate to user", "robot's place", ("a", "b"), "front")
    assert str(mismatch) == "navigate to user: robot's place should be a or b, is front"


def test_effects_on_a_person_are_checked_only_if_somebody_asked(
    activity: Activity, games: list[Seen]
) -> None:
    for before, _, after in games:
        looked_at = set(transition(before, after, activity))
        if before.attended is None:
            assert not looked_at & {"request", "card", "what was asked about"}
        if before.place == FRONT == after.place:
            assert "what was asked about" not in looked_at
