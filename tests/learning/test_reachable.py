"""The reachable joint states: their number, and every state of the games."""

from __future__ import annotations

from collections.abc import Callable
from math import comb

import pytest

from tangy_profiles.activity import Activity
from tangy_profiles.demonstration import Demonstration
from tangy_profiles.state import ActivityState
from tangy_tui.learning.reachable import joint_states

Key = tuple[object, ...]


def key(state: ActivityState) -> Key:
    """The features that distinguish joint states; the policy ignores the order of the queue."""
    asking = frozenset(user.id for user in state.users if user.request == "AR")
    return (state.situation, state.place, asking)


def people(count: int) -> list[str]:
    return [f"user{n}" for n in range(1, count + 1)]


def test_four_people_have_242_joint_states(activity: Activity) -> None:
    assert len(list(joint_states(activity, people(4)))) == 242


@pytest.mark.parametrize("n", range(1, 9))
def test_the_number_of_joint_states_matches_the_formula(n: int, activity: Activity) -> None:
    states = list(joint_states(activity, people(n)))
    quiet = 3  # start, socialize, facilitate
    beside = n * 2 ** (n - 1)  # one person who asks, and any others who ask
    asked = sum(comb(n, asking) * (1 + n - asking) for asking in range(1, n + 1))
    assert len(states) == quiet + 5 * beside + beside + asked + n
    assert len({key(state) for state in states}) == len(states)
    assert {state.situation for state in states} == set(activity.situations)


def test_every_state_is_consistent(activity: Activity, lanterns: Activity) -> None:
    for one in (activity, lanterns):
        for state in joint_states(one, people(3)):
            asking = {user.id for user in state.users if user.request == "AR"}
            assert [user.id for user in state.users] == people(3)
            assert (state.attended is None) == (not asking)
            assert state.situation.request == ("AR" if asking else "ANR")
            if state.attended is not None:
                assert state.attended in asking
                assert state.user(state.attended).activity == state.situation.user_state


@pytest.mark.slow
@pytest.mark.parametrize("name", ["bingo", "lanterns"])
@pytest.mark.parametrize("users", [1, 4, 8])
def test_every_state_of_a_game_is_reachable(
    name: str,
    users: int,
    activity: Activity,
    lanterns: Activity,
    demonstrate: Callable[[str, int, int], Demonstration],
) -> None:
    known = {"bingo": activity, "lanterns": lanterns}[name]
    reachable = {key(state) for state in joint_states(known, people(users))}
    for seed in range(30):
        for step in demonstrate(name, seed, users).steps:
            assert key(step.state) in reachable
