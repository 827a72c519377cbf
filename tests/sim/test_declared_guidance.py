"""Guided games of declared activities show undemonstrated situations, and a search proves it."""

from __future__ import annotations

from pathlib import Path

import pytest

from tangy_profiles.activity import load_activity, read_activity
from tangy_profiles.declared.activity import DeclaredActivity, build_activity
from tangy_profiles.declared.ahead import MOST_TRIED, nearest_way
from tangy_profiles.declared.checking import expected_moves
from tangy_profiles.declared.demonstrated_moves import UNDECIDED, DemonstratedMoves
from tangy_profiles.declared.game import DeclaredGame
from tangy_profiles.declared.search import explore_demonstrated
from tangy_profiles.declared.vocabulary import Selector
from tangy_profiles.declared.whom import first_addressee
from tangy_profiles.state import ActivityState
from tangy_sim.worlds.declared_guidance import GuidedDeclaredWorld
from tangy_sim.worlds.declared_world import DeclaredWorld
from tests.support.declared import DECLARED, declared, each_of_first
from tests.support.renaming import renamed

MOST_STEPS = 400
FILES = Path(__file__).parents[1] / "support" / "activities"
"""Activities of kinds that are not shipped."""


def whom(activity: DeclaredActivity, state: ActivityState, behaviour: str) -> str | None:
    selector: Selector | None = activity.expected_selector(state.situation)
    if selector is None:
        return first_addressee(activity.behaviours[behaviour], state)
    return dict(state.whom).get(selector)


def play(world: DeclaredWorld, activity: DeclaredActivity) -> list[ActivityState]:
    states = [world.begin()]
    while not world.over:
        state = states[-1]
        name = activity.expected[state.situation]
        target = whom(activity, state, name)
        world.execute(activity.action(activity.behaviours[name], target, None))
        states.append(world.observe())
        assert len(states) < MOST_STEPS
    return states


@pytest.mark.parametrize("name", DECLARED)
@pytest.mark.parametrize("count", [1, 2, pytest.param(5, marks=pytest.mark.slow)])
def test_two_guided_games_show_every_possible_situation(name: str, count: int) -> None:
    activity = declared(name)
    players = activity.teams or tuple(f"user{number}" for number in range(1, count + 1))
    taught = DemonstratedMoves(activity.behaviours)
    for seed in (1, 2):
        world = GuidedDeclaredWorld(activity, players, seed=seed, shown=taught)
        play(world, activity)
        taught = world.taught
    found = explore_demonstrated(activity.declaration, players[:2], taught)
    assert found.whole
    assert found.open == {}
    assert found.stuck is None


@pytest.mark.parametrize("name", DECLARED)
def test_the_same_seed_and_actions_give_the_same_states(name: str) -> None:
    activity = declared(name)
    players = activity.teams or ("user1", "user2")
    one = play(DeclaredWorld(activity, players, seed=5), activity)
    assert one == play(DeclaredWorld(activity, players, seed=5), activity)
    assert one != play(DeclaredWorld(activity, players, seed=6), activity)


def test_demonstrated_situations_are_not_repeated() -> None:
    activity = declared("trivia")
    nothing = DemonstratedMoves(activity.behaviours)
    first = GuidedDeclaredWorld(activity, ("user1", "user2"), seed=1, shown=nothing)
    long = play(first, activity)
    second = GuidedDeclaredWorld(activity, ("user1", "user2"), seed=1, shown=first.taught)
    play(second, activity)
    assert second.covered
    assert len({state.situation for state in long}) == len(activity.situations)


def test_a_renamed_behaviour_is_shown_again() -> None:
    activity = declared("trivia")
    taught = expected_moves(activity)
    world = DeclaredWorld(activity, ("user1",), seed=1)
    state = world.observe()
    again = DemonstratedMoves(activity.behaviours)
    again.show(state, "a name of before", None)
    assert again.move(world.game) is None
    again.show(state, activity.expected[state.situation], None)
    assert again.move(world.game) == taught.move(world.game)


@pytest.mark.parametrize(
    "name",
    [
        *("toss", "who-am-i", "simon-says", "raffle"),
        pytest.param("twenty-questions", marks=pytest.mark.slow),
    ],
)
@pytest.mark.parametrize("count", [1, pytest.param(2, marks=pytest.mark.slow)])
def test_two_guided_games_show_situations_that_occur_once_in_a_game(name: str, count: int) -> None:
    activity = read_activity(FILES / f"{name}.toml")
    assert isinstance(activity, DeclaredActivity)
    players = tuple(f"user{number}" for number in range(1, count + 1))
    taught = DemonstratedMoves(activity.behaviours)
    for seed in (1, 2):
        world = GuidedDeclaredWorld(activity, players, seed=seed, shown=taught)
        play(world, activity)
        taught = world.taught
    found = explore_demonstrated(activity.declaration, players[:1], taught)
    assert (found.whole, found.open, found.stuck) == (True, {}, None)
    world_of_games = DeclaredWorld(activity, players, seed=9)
    for _ in range(20):
        world_of_games.begin()
        while not world_of_games.over:
            move = taught.move(world_of_games.game)
            assert move is not None and move[0] in activity.behaviours
            action = activity.action(activity.behaviours[move[0]], move[1], None)
            world_of_games.execute(action)


def test_an_announced_situation_follows_the_next_command() -> None:
    activity, announced = declared("trivia"), 0
    for seed in range(3):
        world = GuidedDeclaredWorld(
            activity, ("user1", "user2"), seed=seed, shown=DemonstratedMoves(activity.behaviours)
        )
        state = world.begin()
        while not world.over:
            coming = world.coming
            name = activity.expected[state.situation]
            world.execute(
                activity.action(activity.behaviours[name], whom(activity, state, name), None)
            )
            state = world.observe()
            if coming is not None and not coming.goes_back:
                announced += 1
                assert state.situation == coming.situation
    assert announced > 3


def test_a_guided_game_gives_the_reason_for_going_back() -> None:
    activity = read_activity(FILES / "toss.toml")
    assert isinstance(activity, DeclaredActivity)
    world = GuidedDeclaredWorld(
        activity, ("user1",), seed=1, shown=DemonstratedMoves(activity.behaviours)
    )
    steps, back = [world.begin()], []
    while not world.over:
        name = activity.expected[steps[-1].situation]
        target = whom(activity, steps[-1], name)
        world.execute(activity.action(activity.behaviours[name], target, None))
        steps.append(world.observe())
        if world.coming is not None and world.coming.goes_back:
            back.append(world.coming.situation)
    assert back
    assert len({one.situation for one in steps if one.situation in back}) == len(set(back))
    assert [one.step for one in steps] == list(range(len(steps)))


def test_the_lookahead_is_bounded_in_states() -> None:
    activity = read_activity(FILES / "toss.toml")
    assert isinstance(activity, DeclaredActivity)
    taught = expected_moves(activity)  # nothing is left to find
    for count in (2, 12):
        copies = Copies(DeclaredGame(activity.declaration, [f"user{n}" for n in range(count)]))
        copies.execute("greet throwers", None)
        assert nearest_way((copies,), taught, most=100) is None
        assert Copies.made <= 100 * (2 * MOST_TRIED + 2)


class Copies(DeclaredGame):
    """A game that counts its copies, and their copies."""

    made = 0

    def __init__(self, game: DeclaredGame) -> None:
        super().__init__(game.declaration, game.players, game.order)
        Copies.made = 0

    def copy(self) -> DeclaredGame:
        """Return a copy, and count it."""
        Copies.made += 1
        other = super().copy()
        other.__class__ = Copies
        return other


@pytest.mark.slow
@pytest.mark.parametrize("name", each_of_first(DECLARED))
def test_a_guided_game_of_twelve_people_shows_every_situation(name: str) -> None:
    activity = declared(name)
    players = activity.teams or tuple(f"user{number}" for number in range(1, 13))
    taught = DemonstratedMoves(activity.behaviours)
    for seed in (1, 2):
        world = GuidedDeclaredWorld(activity, players, seed=seed, shown=taught)
        play(world, activity)
        taught = world.taught
    pair = activity.teams or ("user1", "user2")
    assert explore_demonstrated(activity.declaration, pair, taught).open == {}


def test_a_search_names_undemonstrated_situations() -> None:
    activity = load_activity("trivia")
    assert isinstance(activity, DeclaredActivity)
    taught = DemonstratedMoves(activity.behaviours)
    taught.shown = dict(activity.expected)
    left_out = next(s for s in activity.situations if s.stage == "over")
    del taught.shown[left_out]
    found = explore_demonstrated(activity.declaration, ("user1", "user2"), taught)
    assert found.open[left_out] == ""
    assert all(why == UNDECIDED for one, why in found.open.items() if one != left_out)


@pytest.mark.slow
@pytest.mark.parametrize("name", DECLARED)
@pytest.mark.parametrize("guided", [False, True])
def test_renaming_everything_changes_no_guidance(name: str, *, guided: bool) -> None:
    activity = declared(name)
    declaration, old = renamed(activity.declaration)
    other = build_activity(declaration)
    players = activity.teams or ("user1", "user2", "user3")

    def told(one: DeclaredActivity) -> list[tuple[str, str, str | None, str]]:
        shown = DemonstratedMoves(one.behaviours)
        world = (
            GuidedDeclaredWorld(one, players, seed=3, shown=shown)
            if guided
            else DeclaredWorld(one, players, seed=3)
        )
        found = []
        while not world.over:
            state = world.observe()
            behaviour = one.expected[state.situation]
            target = whom(one, state, behaviour)
            action = one.action(one.behaviours[behaviour], target, None)
            said, _ = one.words_of(action, world.execute(action), str)
            stage = old.get(state.stage, state.stage)
            found.append((stage, old.get(behaviour, behaviour), target, said))
        return found

    assert told(other) == told(activity)
