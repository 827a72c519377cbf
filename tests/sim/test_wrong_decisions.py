"""A policy with one wrong decision ends, or Tangy asks: it never goes on for ever."""

from __future__ import annotations

import pytest

from tangy_profiles.declared.activity import DeclaredActivity
from tangy_profiles.declared.checking import expected_moves
from tangy_profiles.state import EVERYBODY, Situation
from tangy_sim.worlds.declared_world import DeclaredWorld
from tests.support.declared import DECLARED, declared

PEOPLE = ("user1", "user2", "user3")
FRUITLESS = 6
"""After this many behaviours in a row without effect, Tangy asks (`no-progress`)."""
MOST = 300


def goes_on(activity: DeclaredActivity, wrong: Situation, behaviour: str) -> bool:
    """Return whether a game neither ends nor makes Tangy ask within `MOST` steps."""
    moves = expected_moves(activity)
    moves.shown[wrong] = behaviour
    world = DeclaredWorld(activity, activity.teams or PEOPLE, seed=1)
    fruitless = 0
    for _ in range(MOST):
        move = moves.move(world.game)
        if move is None or move[0] not in activity.behaviours:
            return False
        done = activity.behaviours[move[0]]
        target = move[1] or (EVERYBODY if done.to else None)
        led = world.execute(activity.action(done, target, None)).progress
        fruitless = 0 if led == "on" else fruitless + (led != "waits")
        if world.over or fruitless >= FRUITLESS:
            return False
    return True


@pytest.mark.slow
@pytest.mark.parametrize("name", DECLARED)
def test_no_policy_with_one_wrong_decision_goes_on_without_asking(name: str) -> None:
    activity = declared(name)
    tried = [
        (situation, behaviour)
        for situation, right in activity.expected.items()
        for behaviour in activity.behaviours
        if behaviour != right
    ]
    assert len(tried) > 90
    assert [one for one in tried if goes_on(activity, *one)] == []
