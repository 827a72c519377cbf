"""One guided game shows every situation, at a pace for a human teacher."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import settings as examples
from hypothesis import strategies as st

from tangy_profiles.activity import Activity
from tangy_profiles.state import FRONT
from tangy_sim.worlds.guidance import GuidedWorld
from tangy_sim.worlds.users import load_users
from tangy_sim.worlds.world import SimulatedWorld
from tangy_tui.learning.policy import learn_policy
from tangy_tui.learning.reachable import joint_states
from tangy_tui.world import World
from tests.sim.guided import (
    BINGO,
    IDS,
    LANTERNS,
    LEAVING,
    MISTAKES,
    SEEDS,
    Mistake,
    demonstration,
    games,
    guided,
    mistaken,
    play,
    shown,
)

# ---------------------------------------------------------------------------- coverage of one game


@pytest.mark.slow
@pytest.mark.xdist_group("guide")
@pytest.mark.parametrize("users", range(1, 9))
def test_one_game_shows_every_situation_for_any_seed(users: int) -> None:
    for seed in SEEDS:
        turns = guided("bingo", seed, users)
        assert shown(turns) == set(BINGO.situations), seed
        assert all(t.outcome.completed for t in turns), seed


@pytest.mark.xdist_group("guide")
@pytest.mark.parametrize(("seed", "users"), [(n, n) for n in range(1, 9)] + [(2**40, 4), (-7, 4)])
def test_one_game_teaches_the_exact_policy(seed: int, users: int) -> None:
    policy = learn_policy(BINGO, [demonstration("bingo", seed, users)])
    assert policy.errors(BINGO) == {}
    for state in joint_states(BINGO, IDS[:4]):
        decision = policy.decide(state.situation)
        assert decision.sure
        assert decision.behaviour == BINGO.expected[state.situation]


@pytest.mark.slow
@pytest.mark.xdist_group("guide")
def test_a_made_up_activity_is_shown_completely() -> None:
    """A person asks at its end in every second game, since each game has only one end."""
    for users in (1, 2, 5, 8):
        for seed in SEEDS:
            lacking = set(LANTERNS.situations) - shown(guided("lanterns", seed, users))
            assert len(lacking) == 1 and lacking < LEAVING, (users, seed, lacking)
            also = shown(guided("lanterns", seed + 1, users)) if seed < 99 else lacking
            assert lacking <= also, (users, seed)


@pytest.mark.parametrize("users", [1, 8])
def test_two_games_teach_the_exact_policy_of_an_activity_with_two_ends(users: int) -> None:
    policy = learn_policy(LANTERNS, [demonstration("lanterns", seed, users) for seed in (6, 7)])
    assert policy.errors(LANTERNS) == {}
    for state in joint_states(LANTERNS, IDS[:3]):
        assert policy.decide(state.situation).behaviour == LANTERNS.expected[state.situation]


def varied(name: str) -> Activity:
    """Return Bingo with another deck, precedence, or number of calls before a joke."""
    states = {state.checker: state for state in BINGO.user_states}
    rules = BINGO.stage_rules
    match name:
        case "free centre":
            return replace(BINGO, deck=replace(BINGO.deck, free_centre=True))
        case "four corners":
            return replace(BINGO, deck=replace(BINGO.deck, patterns=("four corners",)))
        case "missing before wrong":
            order = ("unread", "complete line", "missing marks", "wrong marks", "otherwise")
            return replace(BINGO, user_states=tuple(states[c] for c in order))
        case "line after errors":
            order = ("unread", "wrong marks", "missing marks", "complete line", "otherwise")
            return replace(BINGO, user_states=tuple(states[c] for c in order))
        case "no joke":
            return replace(BINGO, stage_rules=tuple(r for r in rules if r.condition != "count"))
        case _:
            every = int(name.removeprefix("joke after "))
            return replace(
                BINGO,
                stage_rules=tuple(
                    replace(r, at_least=every) if r.condition == "count" else r for r in rules
                ),
            )


@pytest.mark.parametrize("users", [1, 8])
@pytest.mark.parametrize(
    "name",
    ["free centre", "four corners", "missing before wrong", "line after errors", "no joke"]
    + [f"joke after {n}" for n in (1, 40, 60)],
)
def test_other_cards_and_rules_are_shown_completely(name: str, users: int) -> None:
    activity = varied(name)
    for seed in range(6):
        turns = list(play(GuidedWorld(activity, IDS[:users], seed=seed)))
        assert shown(turns) == set(activity.situations), seed


def test_an_impossible_situation_does_not_delay_the_end() -> None:
    activity = varied("joke after 500")
    turns = list(play(GuidedWorld(activity, IDS[:4], seed=1)))
    lacking = set(activity.situations) - shown(turns)
    assert {s.stage for s in lacking} == {"socialize"}
    assert turns[-2].step.behaviour == "celebrate"


# ---------------------------------------------------------------------------------- natural games


@pytest.mark.xdist_group("guide")
def test_a_guided_game_is_short() -> None:
    """Needed: 18 calls to the joke and one to win, 4 visits, greeting, joke and goodbye."""
    lengths = [len(turns) for turns in games()]
    assert all(34 <= length <= 40 for length in lengths)
    assert 34.5 <= sum(lengths) / len(lengths) <= 35.5


@pytest.mark.xdist_group("guide")
def test_a_win_comes_soon_after_everything_else_was_shown() -> None:
    for turns in games():
        names = [t.step.behaviour for t in turns]
        states = [t.step.state.situation.user_state for t in turns]
        assert states.count("bingo") == 1
        before = turns[: states.index("bingo")]
        assert shown(before) == {
            s for s in BINGO.situations if s.stage != "end" and s.user_state != "bingo"
        }
        assert names[-2:] == ["celebrate", "valediction"]
        assert names[names.index("joke") :].count("call number") <= 4
        called = turns[-1].scene.called
        assert len(set(called)) == len(called) == names.count("call number")


@pytest.mark.xdist_group("guide")
def test_requests_come_one_at_a_time_with_two_calls_between() -> None:
    """Nobody else asks during a visit, so each visit ends at the front."""
    for turns in games():
        calls, closed_at = 0, 0
        for before, after in pairwise(turns):
            calls += after.step.behaviour == "call number"
            assert len(after.asking) <= 1
            if before.asking and not after.asking:
                closed_at = calls
            if after.asking and not before.asking:
                assert after.step.behaviour == "call number"
                assert calls - closed_at >= 2
                assert after.step.after.place == FRONT


@pytest.mark.xdist_group("guide")
def test_visits_are_spread_over_the_calls_to_the_joke() -> None:
    gaps = []
    for turns in games():
        names = [t.step.behaviour for t in turns]
        early = names[: names.index("joke")]
        assert early.count("navigate to user") == 3
        stretches = " ".join("|" if n == "navigate to user" else n[0] for n in early).split("|")
        gaps += [stretch.count("c") for stretch in stretches[:3]]
    assert 3.5 <= sum(gaps) / len(gaps) <= 5
    assert {3, 4, 5, 6} <= set(gaps) <= set(range(2, 9))


@pytest.mark.xdist_group("guide")
def test_different_people_ask_before_anybody_repeats() -> None:
    for users in range(1, 9):
        others = 0
        for seed in SEEDS:
            turns = guided("bingo", seed, users)
            visited = [t.step.target for t in turns if t.step.behaviour == "navigate to user"]
            assert len(visited) == 4
            assert len(set(visited[:3])) >= min(users - 1, 3), seed
            others += len(set(visited)) == min(users, 4)
        assert others >= 95


@pytest.mark.xdist_group("guide")
def test_games_differ_in_order_and_people() -> None:
    orders, winners, hidden = set(), set(), set()
    for seed in SEEDS:
        turns = guided("bingo", seed, 4)
        read = [t.step.state.situation.user_state for t in turns]
        orders.add(tuple(s for s in read if s != "occluded"))
        winners.add(turns[-2].step.target)
        names = [t.step.behaviour for t in turns]
        hidden.add(names[: names.index("move card closer")].count("navigate to user"))
    assert len(orders) == 6, "the three states before the win come in any order"
    assert winners == set(IDS[:4])
    assert hidden == {1, 2, 3}, "a card is out of view at any visit but the winner's"


@pytest.mark.xdist_group("guide")
def test_an_error_is_visible_before_its_correction() -> None:
    for seed in SEEDS:
        turns = guided("bingo", seed, 4)
        marked: set[tuple[str, str]] = set()
        for t in turns:
            if t.step.behaviour == "remove markers":
                for number in t.outcome.numbers:
                    label = BINGO.deck.label(number)
                    assert (str(t.step.target), f"marks {label}") in marked
                    assert number not in t.scene.called
            if t.step.behaviour == "mark numbers":
                assert set(t.outcome.numbers) <= set(t.scene.called)
            marked |= set(t.scene.doing.items())


@pytest.mark.xdist_group("guide")
def test_a_person_with_a_full_line_of_marks_asks() -> None:
    for seed in range(40):
        world = GuidedWorld(BINGO, IDS[:4], seed=seed)
        for t in play(world):
            for player in world.players.values():
                assert world.over or not BINGO.deck.wins(player.marked) or player.id in t.asking


# --------------------------------------------------------------------------- reproducible by seed


@pytest.mark.slow
@examples(max_examples=30)
@given(st.integers(), st.integers(1, 8), MISTAKES)
def test_equal_seeds_and_actions_give_equal_states(
    seed: int, users: int, mistakes: list[Mistake]
) -> None:
    one, other = (GuidedWorld(BINGO, IDS[:users], seed=seed) for _ in range(2))
    for _ in range(2):
        for action in mistaken(one, mistakes):
            for _ in range(2):
                assert one.observe() == other.observe()
                assert one.scene() == one.scene()
                assert one.plan.lacking == one.plan.lacking
            assert one.execute(action) == other.execute(action)
            assert one.scene() == other.scene()
        assert one.begin() == other.begin()


def test_a_guided_game_deals_the_cards_of_the_unguided_one() -> None:
    plain, guided_one = (made(BINGO, IDS, seed=5) for made in (SimulatedWorld, GuidedWorld))
    for person in IDS:
        assert plain.players[person].numbers == guided_one.players[person].numbers
    assert sorted(guided_one.order) == list(BINGO.deck.numbers)


def test_a_second_game_differs_and_shows_everything_again() -> None:
    world = GuidedWorld(BINGO, IDS[:4], seed=8)
    first = list(play(world))
    world.begin()
    assert world.plan.lacking == BINGO.situations
    second = list(play(world))
    assert first[-1].scene.called != second[-1].scene.called
    assert shown(first) == shown(second) == set(BINGO.situations)


def test_a_guided_world_accepts_the_options_of_a_simulated_one() -> None:
    users = replace(load_users(), away_calls=10.0)
    preferences = {p: dict.fromkeys(BINGO.strategies, 0.0) for p in IDS}
    made = GuidedWorld(BINGO, IDS[:2], seed=1, users=users, preferences=preferences)
    world: World = made
    assert world.people == IDS[:2]
    turns = list(play(made))
    assert {t.outcome.seconds for t in turns} == {31.0, 310.0}
    responses = [t.outcome.response for t in turns if t.outcome.response is not None]
    assert responses and not any(r.complied for r in responses)
