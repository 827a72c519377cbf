"""A guided game keeps offering undemonstrated situations despite mistakes of the teacher."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tangy_profiles.state import Situation
from tangy_sim.worlds.guidance import GuidedWorld
from tangy_sim.worlds.guided_plan import GuidedPlan
from tests.sim.guided import (
    BINGO,
    IDS,
    LANTERNS,
    LEAVING,
    MISTAKES,
    Mistake,
    expected,
    mistaken,
    play,
    turn,
)
from tests.support.laws import tried

NUMBERS_LEFT = 7
"""Five numbers of a card touch all its lines; with fewer than these left, every card has one."""


def check_order(world: GuidedWorld) -> None:
    """Check that no winning card is seen while another situation is missing and possible."""
    left = 75 - len(world.scene().called)
    if world.observe().situation.user_state == "bingo" and left >= NUMBERS_LEFT:
        lacking = [s for s in world.plan.lacking if s.stage != "end" and s.user_state != "bingo"]
        assert not lacking, lacking


@tried(100)
@given(st.integers(0, 999), st.integers(1, 8), MISTAKES)
def test_mistakes_hide_no_situation_before_the_win(
    seed: int, users: int, mistakes: list[Mistake]
) -> None:
    world = GuidedWorld(BINGO, IDS[:users], seed=seed)
    seen: set[Situation] = set()
    for action in mistaken(world, mistakes):
        seen.add(world.observe().situation)
        check_order(world)
        world.execute(action)
    if 75 - len(world.scene().called) >= NUMBERS_LEFT:  # endless jokes can use them up
        assert seen == set(BINGO.situations)
    assert world.observe().step < 60 + 8 * len(mistakes)


@tried(40)
@given(st.integers(0, 99), st.integers(1, 8), MISTAKES)
def test_mistakes_hide_no_situation_of_a_made_up_activity(
    seed: int, users: int, mistakes: list[Mistake]
) -> None:
    world = GuidedWorld(LANTERNS, IDS[:users], seed=seed)
    for action in mistaken(world, mistakes, "draw lantern", "breathe"):  # they are numbered
        world.execute(action)
    assert set(world.plan.lacking) < LEAVING


@pytest.mark.parametrize("users", [1, 4, 8])
def test_a_teacher_who_only_calls_numbers_sees_no_win_and_one_request(users: int) -> None:
    for seed in range(10):
        world = GuidedWorld(BINGO, IDS[:users], seed=seed)
        world.execute(expected(world))
        call = BINGO.action(BINGO.behaviours["call number"], None, None)
        called = [turn(world, call) for _ in range(80)]
        assert max(len(t.asking) for t in called) == 1
        assert [len(t.outcome.numbers) for t in called] == [1] * 75 + [0] * 5
        for before, after in pairwise(called):
            assert before.asking <= after.asking
        assert not any(BINGO.deck.wins(p.marked) for p in world.players.values())
        list(play(world))  # even now the game can be brought to an end


@pytest.mark.parametrize("users", [1, 2, 4, 8])
@pytest.mark.parametrize("early", [20, 40, 55])
def test_many_numbers_called_too_early_leave_enough_to_show(users: int, early: int) -> None:
    """Nobody asks before the greeting, and numbers called by then can no longer be missed."""
    call = BINGO.action(BINGO.behaviours["call number"], None, None)
    for seed in range(12):
        world = GuidedWorld(BINGO, IDS[:users], seed=seed)
        for _ in range(early):
            assert not turn(world, call).asking
        seen = set()
        while not world.over:
            seen.add(world.observe().situation)
            check_order(world)
            world.execute(expected(world))
        assert seen == set(BINGO.situations), seed
        assert len(world.scene().called) <= max(early + 15, 23)


@pytest.mark.parametrize("users", [1, 4])
def test_a_long_wait_keeps_the_planned_card_state(users: int) -> None:
    """While a person waits, 30 numbers are called; then the card must be in its planned state."""
    call = BINGO.action(BINGO.behaviours["call number"], None, None)
    for seed in range(30):
        world = GuidedWorld(BINGO, IDS[:users], seed=seed)
        while not world.scene().requests:
            world.execute(expected(world))
        for _ in range(30):
            world.execute(call)
        (asking,) = world.scene().requests
        assert world.cue is not None
        card = world.players[asking]
        assert card.judged(BINGO.card_states) == world.cue.shows.name
        assert not BINGO.deck.wins(card.called)


def test_failed_visits_are_postponed_and_a_full_line_comes_last() -> None:
    plan = GuidedPlan(LANTERNS, Random(1).random)
    for _ in range(4):
        order = [state.name for state in plan.visits()]
        assert len(order) == 4 and order[-1] == "corners lit"
        plan.tried[order[0]] += 1
        assert [state.name for state in plan.visits()][2] == order[0]
    assert GuidedPlan(BINGO, Random(1).random).wanted(spent=True) == BINGO.user_states[1]


def test_people_ask_in_activities_without_card_visits() -> None:
    rules = tuple(r for r in BINGO.stage_rules if r.condition != "beside requester")
    world = GuidedWorld(replace(BINGO, stage_rules=rules), IDS[:4], seed=1)
    for _ in range(10):
        world.execute(expected(world))
    assert len(world.scene().requests) == 1


def test_an_uncelebrated_winner_asks_again() -> None:
    for seed in range(20):
        world = GuidedWorld(BINGO, IDS[:4], seed=seed)
        encourage = BINGO.behaviours["encourage"]
        missed = 0
        while not world.over:
            state = world.observe()
            if state.situation.user_state == "bingo" and missed < 3:
                missed += 1
                world.execute(BINGO.action(encourage, state.attended, None))
            else:
                world.execute(expected(world))
        assert missed == 3
        assert world.observe().step < 70


def test_an_activity_without_draws_is_guided_as_far_as_possible() -> None:
    behaviours = {
        name: replace(b, effect="none") if b.calls else b for name, b in BINGO.behaviours.items()
    }
    world = GuidedWorld(replace(BINGO, behaviours=behaviours), IDS[:4], seed=2)
    for _ in range(60):
        world.execute(expected(world))
    lacking = {s.user_state for s in world.plan.lacking if s.stage != "end"}
    assert lacking == {"bingo", "missing numbers"}
    assert not world.scene().requests
