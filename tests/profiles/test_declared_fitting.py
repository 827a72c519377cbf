"""Suggestions in declared activities: possible behaviours that fit the situation come first."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tangy_profiles.declared.checking import expected_moves
from tangy_profiles.declared.fitting import fitting
from tangy_profiles.declared.game import DeclaredGame
from tangy_profiles.declared.model import FactCondition
from tangy_sim.worlds.declared_world import DeclaredWorld
from tests.support.declared import DECLARED, declared

FIRST = 3
MOST_FIRST = 0.6
"""At least this share of the expected behaviours is first; in the order of files .42 are."""


@pytest.mark.parametrize("name", DECLARED)
def test_the_expected_behaviour_is_among_the_first_suggestions(name: str) -> None:
    activity, taught = declared(name), expected_moves(declared(name))
    among = steps = 0
    for seed in range(4):
        world = DeclaredWorld(activity, activity.teams or ("a", "b", "c"), seed=seed)
        while not world.over:
            move = taught.move(world.game)
            assert move is not None
            steps += 1
            among += move[0] in fitting(world.game)[:FIRST]
            action = activity.action(activity.behaviours[move[0]], move[1], None)
            world.execute(action)
    assert among >= MOST_FIRST * steps


def test_only_possible_behaviours_are_suggested() -> None:
    shipped = declared("trivia").declaration
    needs = (FactCondition("", "open", "is", "yes"),)
    hint = replace(shipped.behaviours["give hint"], needs=needs)
    declaration = replace(shipped, behaviours={**shipped.behaviours, "give hint": hint})
    game = DeclaredGame(declaration, ("a", "b"))
    assert "give hint" not in fitting(game)
    game.execute("ask question", "a")
    assert "give hint" in fitting(game)
